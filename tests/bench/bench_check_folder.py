"""`xei check` of 300 small protocols in one folder: one process, `--jobs 2`, and two processes that were
given half of the files each by hand; then unchanged files, whose results are kept, beside the same checked
anew.

Run by hand: `python tests/bench/bench_check_folder.py` (11 rounds); `--small` (12 files, 1 round) only shows
that it still runs. Wall and CPU time of whole processes, in turns; bytecode, grammar and profile are warm.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2]))

from tests.bench.measure import ROOT, XEI, environment, measure

TARGET = 1.15


def written(folder: Path, files: int) -> list[str]:
    """So many small protocols in one folder, each with a name of its own."""
    text = (ROOT / "protocols" / "put_on_rack.xei").read_text(encoding="utf-8")
    (folder / "profiles").symlink_to(ROOT / "profiles")
    (folder / "many").mkdir()
    paths = [folder / "many" / f"p{number:03}.xei" for number in range(files)]
    for path in paths:
        path.write_text(text.replace("put_on_rack", path.stem), encoding="utf-8")
    return [str(path) for path in paths]


def by_hand(halves: tuple[list[str], list[str]], warm: dict[str, str]) -> float:
    """Wall time of two processes side by side."""
    started = time.perf_counter()
    running = [
        subprocess.Popen([*XEI, "check", "--no-cache", "--quiet", *half], cwd=ROOT, env=warm)
        for half in halves
    ]
    if any(process.wait() for process in running):
        raise SystemExit("a check by hand failed")
    return time.perf_counter() - started


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="12 files and 1 round instead of 300 and 11")
    small = parser.parse_args().small
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = written(folder, 12 if small else 300)
        many = str(folder / "many")
        warm = environment(folder / "bytecode", folder / "cache")
        halves = (files[: len(files) // 2], files[len(files) // 2 :])

        def check(*options: str) -> Callable[[], float]:
            return lambda: measure((*XEI, "check", *options), warm).wall_s

        ways: dict[str, Callable[[], float]] = {
            "two processes by hand": lambda: by_hand(halves, warm),
            "--jobs 2": check("--no-cache", "--jobs", "2", many),
            "--jobs 1": check("--no-cache", many),
            "all unchanged": check(many),
            "one file": check("--no-cache", files[0]),
            "one file, unchanged": check(files[0]),
        }
        walls: dict[str, list[float]] = {way: [] for way in ways}
        for way in ways.values():
            way()
        for _ in range(1 if small else 11):
            for way, run in ways.items():
                walls[way].append(run())
    for way, times in walls.items():
        print(f"{way:24} median {statistics.median(times):.3f} s wall, least {min(times):.3f} s")
    ratios = [
        mine / theirs for mine, theirs in zip(walls["--jobs 2"], walls["two processes by hand"], strict=True)
    ]
    print(f"--jobs 2 / by hand: median {statistics.median(ratios):.2f}, target at most {TARGET}")


if __name__ == "__main__":
    main()
