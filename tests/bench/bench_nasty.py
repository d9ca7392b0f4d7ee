"""How long texts of 100 kB take that are made to cost much: each checked, shown and formatted on its own.

    python tests/bench/bench_nasty.py [--most 10] [--small]

prints the slowest, in CPU seconds of one run each, and the sum. The profile is loaded once before; the
collector's threshold is that which `xei` itself sets.
"""

from __future__ import annotations

import argparse
import gc
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from tests.bench.nasty import SIZE, nasty_texts
from xei_lang.check import CheckOptions, check_module
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile
from xei_lang.syntax import Parser
from xei_lang.syntax.format import Formatter

ROOT = Path(__file__).resolve().parents[2]
BOUND_S = 2.0


def checked(parser: Parser, profile: Profile, text: str) -> tuple[float, Diagnostics]:
    """CPU seconds of parsing, checking and showing what was found, and that."""
    source = Source("nasty.xei", text)
    begin = time.process_time()
    module, said = parser.module(source)
    if module is not None:
        said += check_module(module, source, profile, CheckOptions(open_bindings=True))[1]
    render_full(said, {source.file: source})
    return time.process_time() - begin, said


def formatted(formatter: Formatter, text: str) -> float:
    """CPU seconds of the formatter, which leaves a text with mistakes as it is."""
    begin = time.process_time()
    formatter.format(Source("nasty.xei", text))
    return time.process_time() - begin


def main() -> None:
    """Print the slowest."""
    options = argparse.ArgumentParser(description="Texts that are made to cost much.")
    options.add_argument("--most", type=int, default=10, help="how many to print")
    options.add_argument("--small", action="store_true", help="texts of 2 kB: it still runs")
    given = options.parse_args()
    gc.set_threshold(200_000)
    profile, _ = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None
    parser, formatter = Parser(), Formatter()
    rows: list[tuple[float, float, int, str]] = []
    for name, text in nasty_texts(2_000 if given.small else SIZE):
        check_s, said = checked(parser, profile, text)
        rows.append((check_s, formatted(formatter, text), len(said), name))
    for check_s, format_s, count, name in sorted(rows, key=lambda row: -max(row[:2]))[: given.most]:
        print(f"check {check_s:.3f} s  format {format_s:.3f} s CPU  {count:5} findings  {name}")
    total = sum(row[0] + row[1] for row in rows)
    slow = sum(max(row[:2]) > BOUND_S for row in rows)
    print(f"{len(rows)} texts, {total:.1f} s CPU together; {slow} took more than {BOUND_S:.0f} s")


if __name__ == "__main__":
    main()
