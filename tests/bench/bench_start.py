"""`xei check protocols/put_on_rack.xei` from process start, checked anew and answered from the kept result,
beside a Python that does nothing and one that only imports click.

Run by hand: `python tests/bench/bench_start.py` (15 rounds); `--small` (2 rounds) only shows that it still
runs. CPU time, user and system, of whole processes, in turns; caches (bytecode, grammar, profile) are warm.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.bench.measure import XEI, environment, measure

TARGET_S = 0.15
COMMANDS = {
    "python -c pass": (sys.executable, "-c", "pass"),
    "python -c 'import click'": (sys.executable, "-c", "import click"),
    "xei check --no-cache": (*XEI, "check", "--no-cache", "protocols/put_on_rack.xei"),
    "xei check, unchanged": (*XEI, "check", "protocols/put_on_rack.xei"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="2 rounds instead of 15")
    rounds = 2 if parser.parse_args().small else 15
    cpu_s: dict[str, list[float]] = {name: [] for name in COMMANDS}
    with tempfile.TemporaryDirectory() as folder:
        warm = environment(Path(folder, "bytecode"), Path(folder, "cache"))
        for command in COMMANDS.values():
            measure(command, warm)
        for _ in range(rounds):
            for name, command in COMMANDS.items():
                cpu_s[name].append(measure(command, warm).cpu_s)
    for name, times in cpu_s.items():
        print(f"{name:24}  median {statistics.median(times):.3f} s CPU, least {min(times):.3f} s")
    print(f"target: xei check at most {TARGET_S:.2f} s CPU")


if __name__ == "__main__":
    main()
