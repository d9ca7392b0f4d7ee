"""`xei compile protocols/rack_six_tubes.xei` as a whole process with an empty cache, beside the bare import
of the libraries that it stands on.

Run by hand: `python tests/bench/bench_compile.py`; `--small` compiles put_on_rack instead. Bytecode is warm,
as an installation has it; the grammar's table and the compiled profile are made anew.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.bench.measure import XEI, Usage, environment, measure

TARGET = "under 8 s CPU, under 500 MB"
LIBRARIES = (
    "lark, pydantic, numpy, networkx, pinocchio, coal, toppra, ompl.base, ompl.geometric, rosbags.rosbag2"
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="put_on_rack instead of rack_six_tubes")
    name = "put_on_rack" if parser.parse_args().small else "rack_six_tubes"
    imports = (sys.executable, "-c", f"import {LIBRARIES}")
    with tempfile.TemporaryDirectory() as folder:
        output = str(Path(folder, "bundle"))
        bytecode = Path(folder, "bytecode")
        command = (*XEI, "compile", f"protocols/{name}.xei", "-o", output, "--time-passes")
        first = (*XEI, "compile", "protocols/put_on_rack.xei", "-o", output)
        measure(first, environment(bytecode, Path(folder, "first")))
        cold = environment(bytecode, Path(folder, "empty"))
        measure(imports, cold)
        bare, whole = measure(imports, cold), measure(command, cold)
    print(_row("import of the libraries", bare))
    print(_row(f"xei compile {name}", whole))
    for line in whole.output.splitlines():
        if " took " in line or line.startswith("bundle"):
            print(f"  {line}")
    print(f"target: {TARGET} for rack_six_tubes, cold, whole process")


def _row(title: str, usage: Usage) -> str:
    return f"{title:28} {usage.wall_s:6.2f} s wall, {usage.cpu_s:6.2f} s CPU, peak {usage.peak_mb:4.0f} MB"


if __name__ == "__main__":
    main()
