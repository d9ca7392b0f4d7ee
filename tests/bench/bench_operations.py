"""What operation parameters cost: grasps and a tap on objects of the bench, each planned anew.

Run by hand: `python tests/bench/bench_operations.py` (50 rounds); `--small` (1 round) only shows that it
still runs. CPU time of one thread. The baseline, in the same run, is what no planner can do without: for each
grasp of the family one product of poses, which says where the tool is.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.lower.plans import bench, obj, plan  # noqa: E402
from xei_lang.diagnostics import Span  # noqa: E402
from xei_lang.ir.skill_plan import ObjectRef, Value  # noqa: E402
from xei_lang.lower.operations import Planned, Work  # noqa: E402
from xei_lang.lower.operations.grasp import GRASP  # noqa: E402
from xei_lang.lower.operations.tap import TAP  # noqa: E402
from xei_lang.lower.parameters import layers_of  # noqa: E402
from xei_lang.lower.walk import Scene  # noqa: E402


def work_on(skill: str, args: dict[str, Value], subject: str) -> Work:
    """The work of an operation before anything has moved."""
    profile, world = bench()
    spec = profile.bank.skill(skill)
    assert spec is not None
    step = plan((skill, args)).steps[0]
    layers = layers_of(step, spec, profile.object(subject))
    scene, span = Scene.of(world, profile), Span("bench.xei", 0, 1)
    return Work(profile, scene, step, layers, ObjectRef(subject), span, "left", subject, (), "family")


def grasps() -> list[Work]:
    """One for each kind of object that hands take; those that stand alike cost alike."""
    names = ("tube_1", "tube_7", "beaker_1", "bottle_1", "wipe_1", "vial_1", "weight_100g")
    return [work_on("pick", {"object": obj(name), "arm": "left"}, name) for name in names]


def times_ms(job: Callable[[], object], rounds: int) -> list[float]:
    found: list[float] = []
    for _ in range(rounds):
        start = time.thread_time()
        job()
        found.append(1e3 * (time.thread_time() - start))
    return found


def row(name: str, found: list[float]) -> str:
    ordered = sorted(found)
    p95 = ordered[min(len(ordered) - 1, int(0.95 * len(ordered)))]
    return f"{name:<34} median {statistics.median(found):7.3f} ms   p95 {p95:7.3f} ms"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="1 round instead of 50")
    rounds = 1 if parser.parse_args().small else 50
    works = grasps()
    made: list[Planned] = [GRASP.plan(work) for work in works]
    for work, planned in zip(works, made, strict=True):
        family = planned.family
        assert family is not None
        T_base_object = work.scene.T_base_object(work.object)

        def baseline(members=family.members, pose=T_base_object) -> object:
            return [pose @ member.T_reference_tool for member in members]

        name = f"{work.object} ({len(family.members)} grasps)"
        print(row(f"grasp {name}", times_ms(lambda work=work: GRASP.plan(work), rounds)))
        print(row(f"  baseline: {len(family.members)} products of poses", times_ms(baseline, rounds)))
    screen = {"screen": obj("incubator_screen"), "element": "start", "arm": "left"}
    tap = work_on("tap", screen, "incubator_screen")
    print(row("tap incubator_screen", times_ms(lambda: TAP.plan(tap), rounds)))


if __name__ == "__main__":
    main()
