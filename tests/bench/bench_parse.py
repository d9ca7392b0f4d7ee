"""How long parsing takes, beside CPython's parser on as many lines of Python.

python tests/bench/bench_parse.py [--lines 10000] [--rounds 5] [--small]
"""

from __future__ import annotations

import argparse
import ast
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from xei_lang.diagnostics import Source
from xei_lang.syntax import Parser

XEI = """\
  fill_{i}: pour(source=bottle, target=rack.slot("A{i}"), volume=2.5 mL + 10 uL * {i}) within 30 s
  for tube in rack.row("A")[1 .. 4] {{
    aspirate(source=tube, volume=volume(tube) / 2, speed=100 uL/s)   # a comment
    dispense(target=waste, for=10 min, on=table.spot("w{i}"))
  }}
  incubate_{i}: wait 10 min after fill_{i} by 0 s .. 5 min
  if od_{i} > 0.6 and not done {{ confirm "number {i}" }} else {{ note "skipped" }}
  require volume(bottle) >= 10 mL
"""
PYTHON = """\
  fill_{i} = pour(source=bottle, target=rack.slot("A{i}"), volume=mL(2.5) + uL(10) * {i}, within=s(30))
  for tube in rack.row("A")[1:4]:
    aspirate(source=tube, volume=volume(tube) / 2, speed=uL_per_s(100))   # a comment
    dispense(target=waste, duration=min(10), on=table.spot("w{i}"))
  pass
  incubate_{i} = wait(min(10), after=fill_{i}, by=(s(0), min(5)))
  confirm("number {i}") if od_{i} > 0.6 and not done else note("skipped")
  assert volume(bottle) >= mL(10)
"""


def cpu_s(work: Callable[[], object], rounds: int) -> float:
    times: list[float] = []
    for _ in range(rounds):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return statistics.median(times)


def main() -> int:
    options = argparse.ArgumentParser(description="Times the parser beside CPython's own.")
    options.add_argument("--lines", type=int, default=10_000)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--small", action="store_true", help="200 lines, once: it still runs")
    given = options.parse_args()
    if given.small:
        given.lines, given.rounds = 200, 1
    blocks = range(max(1, given.lines // XEI.count("\n")))
    protocol = "protocol p {\n" + "".join(XEI.format(i=i) for i in blocks) + "}\n"
    python = "def p():\n" + "".join(PYTHON.format(i=i) for i in blocks)
    source = Source("bench.xei", protocol)
    start = time.process_time()
    parser = Parser()
    made = time.process_time() - start
    module, diagnostics = parser.module(source)
    if module is None or diagnostics:
        print(diagnostics[:1])
        return 1
    ours = cpu_s(lambda: parser.module(source), given.rounds)
    theirs = cpu_s(lambda: ast.parse(python), given.rounds)
    print(f"making the parser   {made * 1e3:8.1f} ms")
    print(f"xei, {source.line_count} lines    {ours:8.3f} s CPU, median of {given.rounds}")
    print(f"Python's ast.parse  {theirs:8.3f} s CPU on {python.count(chr(10)) + 1} lines")
    print(f"ratio               {ours / theirs:8.2f}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
