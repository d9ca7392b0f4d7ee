"""What a process costs from its start: for benchmarks of the whole program."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
XEI = (sys.executable, "-c", "from xei_lang.cli.main import run; run()")


@dataclass(frozen=True, slots=True)
class Usage:
    """What the kernel counted for one process (getrusage), and what it wrote."""

    wall_s: float
    cpu_s: float
    peak_mb: float
    output: str


def measure(command: tuple[str, ...], environment: dict[str, str], *, fails: bool = False) -> Usage:
    """Run a command in the project's folder. Ends the benchmark where it fails against expectation."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as written:
        started = time.perf_counter()
        process = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=written, stderr=written)
        _, status, usage = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - started
        process.returncode = os.waitstatus_to_exitcode(status)
        written.seek(0)
        output = written.read()
    if (process.returncode != 0) is not fails:
        raise SystemExit(f"{' '.join(command)}\n{output}exit code {process.returncode}")
    # ru_maxrss counts bytes on macOS, and kB elsewhere.
    peak_mb = usage.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)
    return Usage(wall_s, usage.ru_utime + usage.ru_stime, peak_mb, output)


def environment(bytecode: Path, cache: Path) -> dict[str, str]:
    """An environment in which Python keeps its bytecode in one folder, as an installation has it, and xei its
    cache in another.
    """
    own = {
        "PYTHONPATH": str(ROOT),
        "PYTHONPYCACHEPREFIX": str(bytecode),
        "XDG_CACHE_HOME": str(cache),
    }
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, **own}
