"""What users may write, tried out: tubes to every free slot, objects to the spots and to the table.

Run by hand: `python tests/bench/bench_matrix.py --jobs 2` (every case); `--small` (a seeded dozen) only shows
that it still runs. Each case is a protocol of its own, compiled by the pipeline's functions over one loaded
profile; what comes out is put before the verifier, tilt included. A refusal counts by its code. Times are CPU
times of checking, lowering and planning. Exit code 1 where a plan does not hold; refusals are listed.
"""

from __future__ import annotations

import argparse
import multiprocessing
import random
import statistics
import sys
import time
from collections import Counter
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.motion.sequence.bench import DESCRIPTION, SRDF, URDF, bench  # noqa: E402
from xei_lang.check import CheckOptions, check_module  # noqa: E402
from xei_lang.diagnostics import Diagnostics, Source  # noqa: E402
from xei_lang.lower import lower  # noqa: E402
from xei_lang.motion.either_arm import plan_with_either_arm  # noqa: E402
from xei_lang.motion.verify import RobotDescription, VerifyOptions, verify_timed  # noqa: E402
from xei_lang.profiles.sources import profile_sources  # noqa: E402
from xei_lang.syntax.parser import parse_module  # noqa: E402

SMALL, SEED = 12, 5
RACKS = ("rack_1", "rack_2")
RANDOM_PROTOCOLS, MOVES = 16, 4
STANDING = {
    "tube_1": "A1", "tube_2": "A2", "tube_3": "A3", "tube_4": "A4", "tube_5": "B1", "tube_6": "B3",
}  # fmt: skip
OTHERS = ("beaker_1", "bottle_1", "pipette_1", "wipe_1")
SURFACES = ('table.spot("beaker")', "table")


@dataclass(frozen=True)
class Case:
    """A protocol's steps, and the group that it is counted in."""

    group: str
    steps: str


@dataclass(frozen=True)
class Ended:
    """How a case ended: `verified`, a code, or `not verified`; CPU seconds; the message of a refusal."""

    case: Case
    result: str
    seconds: float
    said: str = ""


def cases() -> list[Case]:
    slots = [f'rack.slot("{row}{column}")' for row in "ABC" for column in range(1, 5)]
    taken = {f'rack_1.slot("{slot}")' for slot in STANDING.values()}
    free = [place for name in RACKS for slot in slots if (place := slot.replace("rack", name)) not in taken]
    moves = [("tube to slot", tube, place) for tube in STANDING for place in free]
    moves += [("tube to table", tube, place) for tube in STANDING for place in SURFACES]
    moves += [("other to table", name, place) for name in OTHERS for place in SURFACES]
    found = [Case(f"{group}, one skill", f"move_object(object={name}, to={to})") for group, name, to in moves]
    found += [
        Case(f"{group}, two skills", f"pick(object={name})\n  place(object={name}, on={to})")
        for group, name, to in moves
        if group != "tube to slot"
    ]
    return [*found, *in_a_row(free)]


def in_a_row(free: list[str]) -> list[Case]:
    """Protocols of several moves, drawn at random: slots fill up beside each other."""
    draw, found = random.Random(SEED), list[Case]()
    for _ in range(RANDOM_PROTOCOLS):
        pairs = zip(draw.sample(list(STANDING), MOVES), draw.sample(free, MOVES), strict=True)
        lines = [f"pick(object={tube})\n  insert(object={tube}, into={slot})" for tube, slot in pairs]
        found.append(Case(f"{MOVES} tubes in a row", "\n  ".join(lines)))
    return found


@lru_cache
def options() -> CheckOptions:
    return CheckOptions(sources=profile_sources(bench()[0]))


def tried(task: tuple[Case, int]) -> Ended:
    case, seed = task
    begin = time.process_time()
    profile, world = bench()
    text = f'xei 1\nprotocol matrix {{\n  profile "openarm_bench"\n  {case.steps}\n}}\n'
    source = Source("matrix.xei", text)
    module, said = parse_module(source)
    if module is None:
        return ended(case, said, begin)
    plan, said = check_module(module, source, profile, options())
    if plan is None:
        return ended(case, said, begin)
    graph, said = lower(plan, profile, world)
    if graph is None:
        return ended(case, said, begin)
    graph, timed, said = plan_with_either_arm(plan, graph, world, profile, DESCRIPTION, seed)
    if timed is None:
        return ended(case, said, begin)
    seconds = time.process_time() - begin
    calibration = profile.calibration
    report = verify_timed(
        timed, graph, world, RobotDescription(URDF, SRDF), calibration.limits,
        options=VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad),
    )  # fmt: skip
    found = "; ".join(str(finding) for finding in report.findings)
    return Ended(case, "not verified" if found else "verified", seconds, found)


def ended(case: Case, said: Diagnostics, begin: float) -> Ended:
    fault = next(item for item in said if item.severity == "error")
    words = "\n      ".join((fault.message, *fault.notes, *(f"help: {text}" for text in fault.help)))
    return Ended(case, fault.code, time.process_time() - begin, words)


def report(results: list[Ended]) -> None:
    for item in results:
        if item.result != "verified":
            print(f"{item.case.steps!r}: {item.result}\n      {item.said}")
    for group in dict.fromkeys(item.case.group for item in results):
        rows = [item for item in results if item.case.group == group]
        counted = Counter(item.result for item in rows)
        counts = ", ".join(
            f"{counted[name]} {name}" for name in sorted(counted, key=lambda n: (n != "verified", n))
        )
        times = [item.seconds for item in rows]
        print(
            f"{group:<28} {len(rows):>3} cases: {counts};"
            f" median {statistics.median(times):.2f} s, longest {max(times):.2f} s"
        )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help=f"{SMALL} cases, drawn by the seed")
    parser.add_argument("--seed", type=int, default=0, help="of the planner, and of the choice of --small")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    given = parser.parse_args()
    chosen = cases()
    if given.small:
        chosen = random.Random(given.seed).sample(chosen, SMALL)
    tasks = [(case, given.seed) for case in chosen]
    with multiprocessing.get_context("spawn").Pool(given.jobs) as pool:
        results = pool.map(tried, tasks, chunksize=1)
    report(results)
    return 1 if any(item.result == "not verified" for item in results) else 0


if __name__ == "__main__":
    sys.exit(main())
