"""Checking a long protocol, beside parsing it: checking must grow with its length and no faster.

Run by hand: `python tests/bench/bench_check.py` (10,000 steps); `--small` (400 steps) only shows that it
still runs. Times are CPU times of one run each; the profile is loaded before.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from xei_lang.check import CheckOptions, check_module  # noqa: E402
from xei_lang.diagnostics import Source  # noqa: E402
from xei_lang.ir.verify_plan import verify_plan  # noqa: E402
from xei_lang.profiles.load import load_profile  # noqa: E402
from xei_lang.syntax import Parser  # noqa: E402

T = TypeVar("T")


def written_out(steps: int) -> str:
    return "".join(
        f"s{i}: pick(object=tube_{i % 6 + 1}, arm=left)\n"
        f'place(object=tube_{i % 6 + 1}, on=rack_{i % 2 + 1}.slot("C{i % 4 + 1}"), arm=left) within 30 s\n'
        for i in range(steps // 2)
    )


def looped(steps: int) -> str:
    turn = 'pick(object=tube_1, arm=left)\nplace(object=tube_1, on=rack_2.slot("C1"), arm=left)'
    return f"for i in 1 .. {steps // 2} {{ {turn} }}"


def timed(work: Callable[[], T]) -> tuple[T, float]:
    start = time.process_time()
    made = work()
    return made, time.process_time() - start


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--small", action="store_true")
    most = 400 if arguments.parse_args().small else 10_000
    profile, _ = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None
    parser = Parser()
    for name, make in (("written out", written_out), ("in a loop", looped)):
        for steps in (most // 4, most):
            source = Source("bench.xei", f'protocol p {{\n profile "openarm_bench"\n{make(steps)}\n}}')
            (module, _), parse_s = timed(lambda text=source: parser.module(text))
            assert module is not None
            (plan, found), check_s = timed(
                lambda tree=module, text=source: check_module(tree, text, profile, CheckOptions())
            )
            assert plan is not None, found
            assert verify_plan(plan) == ()
            print(f"{name:12} {steps:6} steps: parse {parse_s:.3f} s, check {check_s:.3f} s")


if __name__ == "__main__":
    main()
