"""The front end's figures: parse and check by length, from a cold start, and with loops written out.

    python tests/bench/bench_front_end.py [--rounds 3] [--small]

The text is varied: steps with clauses, loops, choices, lists, conditions, comments, names of its own. CPU
times are of one process with the collector's threshold that `xei` itself sets; the profile is loaded before.
The line of best fit of log time over log length gives the exponent (1 is linear), and how far the worst
length lies off it. lark's own LALR parser stands beside, on the same grammar and text, without our tree. The
cold figures are those of a process of its own, as the kernel counts them, without the cache of results.
"""

from __future__ import annotations

import argparse
import gc
import math
import random
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from lark import Lark

from tests.bench.measure import ROOT, XEI, environment, measure
from xei_lang.check import CheckOptions, check_module
from xei_lang.diagnostics import Source, has_errors
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile
from xei_lang.syntax import Parser
from xei_lang.syntax.tables import STARTS

LENGTHS = (1_000, 2_000, 5_000, 10_000, 20_000)
_PARTS = (
    """  # {w} {i}: to the second rack
  take_{i}: pick(object=tube_{t}, arm={arm})
  put_{i}: place(object=tube_{t}, on=rack_2.slot("C{c}"), arm={arm}) within {s} s
""",
    """  let {w}_{i} = {s} s + {t} * 500 ms
  wait {w}_{i}
  pause_{i}: wait {s} s
  wait {t} min after pause_{i} by 0 s .. 2 h
""",
    """  let list_{i} = [n * {t} for n in 1 .. {c} if n != {s}]
  for value in list_{i} {{
    wait value * 1 s
  }}
  require len(list_{i}) >= 0 and {s} > 1
""",
    """  {w}_{i}: do {{
    move_object(object=tube_{t}, to=rack_1.slot("B{c}"), arm={arm})
    confirm "the {w} of tube {t} is {s} mm"
  }}
""",
    """  if {s} > {c} and not false {{
    note "{w} {i}"   # kept in the plan
    slide_to(height={s} mm + {t} cm)
  }} else {{
    wait {s} min
  }}
""",
    """  repeat {c} times {{
    set_do(output="{w}", value=true)
  }}
  unmapped "the {w} of {i}" because "no skill does it"
""",
)
_WORDS = ("shake", "rinse", "cool", "settle", "label", "turn", "lid", "warm")


def varied(lines: int) -> str:
    """A right protocol of about so many lines."""
    rng = random.Random(lines)
    parts: list[str] = []
    count = 3
    while count < lines:
        chosen = rng.choice(_PARTS).format(
            i=len(parts),
            w=rng.choice(_WORDS),
            t=rng.randint(1, 6),
            c=rng.randint(1, 4),
            s=rng.randint(5, 50),
            arm=rng.choice(("left", "right")),
        )
        parts.append(chosen)
        count += chosen.count("\n")
    return 'protocol long {\n  profile "openarm_bench"\n' + "".join(parts) + "}\n"


def times(parser: Parser, profile: Profile, text: str, rounds: int) -> tuple[float, float]:
    """CPU seconds (median) of parsing and of checking a text."""
    source = Source("bench.xei", text)
    parsed: list[float] = []
    checked: list[float] = []
    for _ in range(rounds):
        gc.collect()
        begin = time.process_time()
        module, said = parser.module(source)
        middle = time.process_time()
        assert module is not None, said
        _, found = check_module(module, source, profile, CheckOptions(open_bindings=True))
        checked.append(time.process_time() - middle)
        parsed.append(middle - begin)
        assert not has_errors(found), found[:2]
    return statistics.median(parsed), statistics.median(checked)


def fit(lengths: list[int], seconds: list[float]) -> tuple[float, float]:
    """The exponent of the line of best fit over logarithms, and the worst distance from it (ratio)."""
    x, y = [math.log(n) for n in lengths], [math.log(s) for s in seconds]
    slope, offset = statistics.linear_regression(x, y)
    worst = max(abs(b - (offset + slope * a)) for a, b in zip(x, y, strict=True))
    return slope, math.exp(worst) - 1


def lengths(most: int, rounds: int) -> None:
    """Parse and check by length, with lark beside."""
    profile, _ = load_profile(ROOT / "profiles" / "openarm_bench", None)
    assert profile is not None
    parser = Parser()
    grammar = (ROOT / "grammar" / "xei.lark").read_text(encoding="utf-8")
    lark: Any = Lark(grammar, parser="lalr", lexer="contextual", start=list(STARTS))
    tried = [n for n in LENGTHS if n <= most] if most >= LENGTHS[1] else [most // 2, most]
    sums: list[float] = []
    whole: list[int] = []
    for n in tried:
        text = varied(n)
        parse_s, check_s = times(parser, profile, text, rounds)
        begin = time.process_time()
        lark.parse(text, start="module")
        lark_s = time.process_time() - begin
        whole.append(text.count("\n"))
        sums.append(parse_s + check_s)
        print(
            f"{whole[-1]:6} lines: parse {parse_s:.3f} s, check {check_s:.3f} s, both {sums[-1]:.3f} s CPU "
            f"({sums[-1] / whole[-1] * 1e6:.0f} us a line); lark's parser {lark_s:.3f} s"
        )
    exponent, off = fit(whole, sums)
    print(f"parse and check grow as lines ** {exponent:.3f}; the worst length lies {off:.1%} off the fit")


def cold(rounds: int, steps: int) -> None:
    """`xei check` as a process of its own: 100 lines, a late mistake, steps out of loops."""
    turn = 'pick(object=tube_1, arm=left)\nplace(object=tube_1, on=rack_2.slot("C1"), arm=left)'
    looped = f'protocol p {{\n profile "openarm_bench"\n for i in 1 .. {steps // 2} {{ {turn} }}\n}}\n'
    least = 'protocol p {\n  profile "openarm_bench"\n  wait 1 s\n}\n'
    with tempfile.TemporaryDirectory() as folder:
        known = environment(Path(folder) / "bytecode", Path(folder) / "cache")
        for name, text in (
            ("3 lines", least),
            ("100 lines", varied(100)),
            (f"{steps} lines", varied(steps)),
            (f"{steps} lines, the last but one wrong", varied(steps)[:-2] + "  wait 1 s after\n}\n"),
            (f"{steps} steps out of a loop", looped),
        ):
            file = Path(folder) / "bench.xei"
            file.write_text(text, encoding="utf-8")
            command = (
                *XEI,
                "check",
                "--no-cache",
                str(file),
                "--profile",
                str(ROOT / "profiles" / "openarm_bench"),
            )
            fails = "wrong" in name
            measure(command, known, fails=fails)
            runs = [measure(command, known, fails=fails) for _ in range(rounds)]
            cpu_s = statistics.median(run.cpu_s for run in runs)
            print(f"xei check, {name:38} {cpu_s:.3f} s CPU, {max(run.peak_mb for run in runs):.0f} MB")


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description="The figures of parsing and checking.")
    options.add_argument("--rounds", type=int, default=3)
    options.add_argument("--small", action="store_true", help="400 lines, once: it still runs")
    given = options.parse_args()
    gc.set_threshold(200_000)
    lengths(400 if given.small else LENGTHS[-1], 1 if given.small else given.rounds)
    cold(1 if given.small else 2 * given.rounds + 1, 400 if given.small else 10_000)


if __name__ == "__main__":
    main()
