"""Every benchmark still runs; what it measures is read by people, and asserted by nobody."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = sorted(Path(__file__).parent.glob("bench_*.py"))


@pytest.mark.parametrize("benchmark_file", BENCHMARKS, ids=lambda path: path.stem)
def test_small_run_ends_well(benchmark_file: Path) -> None:
    command = [sys.executable, str(benchmark_file), "--small"]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert ran.stdout.strip()
