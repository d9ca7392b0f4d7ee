"""What operation parameters cost: every operation on objects of the bench, and every kind of grasp.

Run by hand: `python tests/bench/bench_operations.py` (50 rounds); `--small` (1 round) only shows that it
still runs. CPU time of one thread from a step and a scene to all settings, points and members. Each round
stands the base a little elsewhere, so that nothing can be remembered from the one before. The baseline, in
the same run, is what no planner can do without: for each member of the family, or for each point where it
makes no family, one product of poses, which says where the tool is.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.lower.plans import bench, obj, slot, spot, surface  # noqa: E402
from tests.lower.works import Args, holding, step_of, work_of  # noqa: E402
from xei_lang.ir.geometry import Pose  # noqa: E402
from xei_lang.ir.skill_plan import Fact, ObjectRef, PlaceRef, Step  # noqa: E402
from xei_lang.lower.look import look_height  # noqa: E402
from xei_lang.lower.operations import OPERATIONS, Planned  # noqa: E402
from xei_lang.lower.task import Task  # noqa: E402
from xei_lang.lower.walk import Scene  # noqa: E402
from xei_lang.quantity import quantity  # noqa: E402

Job = Callable[[], object]


@dataclass(frozen=True, slots=True)
class Case:
    """An operation of a step of a skill. `about` names what the step is about, which the left hand, or the
    `giver`, holds already where it is `held`.
    """

    operation: str
    skill: str
    args: Args
    subject: ObjectRef | PlaceRef
    about: str
    held: bool = True
    giver: str = ""
    known: tuple[Fact, ...] = ()

    def title(self, made: Planned) -> str:
        """What the row is called."""
        if self.operation == "grasp" and made.family is not None:
            return f"grasp {self.about} ({len(made.family.members)} grasps)"
        place = f", {self.subject.object} {self.subject.kind}" if isinstance(self.subject, PlaceRef) else ""
        return f"{self.operation} {self.about}{place}"

    def job(self, scene: Scene) -> Callable[[], Planned]:
        """The planner's run on this scene, with the layers of its parameters."""
        plan = next(item.plan for item in OPERATIONS if item.name == self.operation)
        args = self.args if "hold" in self.args else {**self.args, "arm": "left"}
        step = step_of(self.skill, args, *self.known)
        if self.held:
            scene = holding(self.about, scene, "right" if self.giver else "left")
        return lambda: plan(work_of(step, self.subject, self.about, scene))


GRASPED = ("tube_1", "tube_7", "beaker_1", "bottle_1", "wipe_1", "vial_1", "weight_100g", "pipette_1")
"""One for each kind of object that hands take; those that stand alike cost alike."""


def cases() -> list[Case]:
    """Each operation on all kinds of objects and places that cost differently."""
    tube, beaker, pipette, wipe = (obj(name) for name in ("tube_1", "beaker_1", "pipette_1", "wipe_1"))
    screen, source = obj("incubator_screen"), obj("beaker_3")
    hole, front, table = slot("rack_2", "A1"), spot("table", "front"), surface("table")
    sample, draw = quantity(Fraction(1, 5), "mL"), {"pipette": pipette, "volume": quantity(200, "uL")}
    element: Args = {"screen": screen, "element": "start"}
    swipe: Args = {**element, "direction": "right", "distance": quantity(20, "mm")}
    area: Args = {"object": wipe, "on": front, "length": quantity(100, "mm"), "width": quantity(180, "mm")}
    poured: Args = {"source": source, "target": beaker, "volume": quantity(60, "mL")}
    fill = (Fact("volume", "beaker_3", quantity(180, "mL")), Fact("volume", "beaker_1", sample))
    low = (Fact("volume", "beaker_3", quantity(80, "mL")),)
    bottle, lid = obj("bottle_2"), obj("bottle_2_cap")
    twist: Args = {"object": bottle, "hold": "left", "twist": "right"}
    turn, swing = {"angle": quantity(180, "deg")}, {"amplitude": quantity(20, "deg")}
    return [
        *(
            Case("grasp", "pick", {"object": obj(name)}, obj(name), name, held=False)
            for name in GRASPED
        ),
        Case("lift", "pick", {"object": tube}, tube, "tube_1"),
        Case("place", "insert", {"object": tube, "into": hole}, hole, "tube_1"),
        Case("place", "place", {"object": beaker, "on": front}, front, "beaker_1"),
        Case("place", "place", {"object": beaker, "on": table}, table, "beaker_1"),
        Case("pour", "pour", poured, beaker, "beaker_3", known=fill),
        Case("pour", "pour", poured, beaker, "beaker_3", known=low),
        Case("aspirate", "aspirate", {**draw, "source": source}, source, "pipette_1", known=fill),
        Case("dispense", "dispense", {**draw, "target": beaker}, beaker, "pipette_1", known=fill),
        Case("tip", "attach_tip", {"pipette": pipette, "tip": slot("tip_box_1", "B2")},
             slot("tip_box_1", "B2"), "pipette_1"),
        Case("eject", "eject_tip", {"pipette": pipette, "waste": obj("waste_bin")}, obj("waste_bin"),
             "pipette_1"),
        Case("tap", "tap", element, screen, "incubator_screen", held=False),
        Case("swipe", "swipe", swipe, screen, "incubator_screen", held=False),
        Case("wipe", "wipe", area, front, "wipe_1"),
        Case("give", "handover", {"object": pipette, "to": "right"}, pipette, "pipette_1"),
        Case("take", "handover", {"object": pipette, "to": "left"}, pipette, "pipette_1", giver="right"),
        Case("invert", "invert", {"object": tube, **turn}, tube, "tube_1"),
        Case("shake", "shake", {"object": tube, **swing}, tube, "tube_1"),
        Case("steady", "twist_open", twist, bottle, "bottle_2", held=False),
        Case("cap", "twist_open", twist, lid, "bottle_2_cap", held=False),
        Case("thread", "twist_open", twist, lid, "bottle_2_cap", held=False),
    ]  # fmt: skip


def scenes(rounds: int) -> list[Scene]:
    """The bench before anything moves, from a little further on in each round."""
    profile, world = bench()
    start = Scene.of(world, profile)
    found: list[Scene] = []
    for k in range(rounds):
        T_world_base = start.epoch.T_world_base @ Pose.from_rpy((1e-4 * k, 0.0, 0.0), (0.0, 0.0, 1e-4 * k))
        found.append(replace(start, epoch=replace(start.epoch, T_world_base=T_world_base)))
    return found


def look(scene: Scene) -> Job:
    """The height of the slide for looking at a tube."""
    profile, _ = bench()
    step: Step = step_of("look_at", {"target": obj("tube_5")})
    spec = profile.bank.skill("look_at")
    assert spec is not None
    return lambda: look_height(Task(profile, step, spec, scene, {}, "", ()), "target", spec.template[0])


def time_ms(job: Job) -> float:
    start = time.thread_time()
    job()
    return 1e3 * (time.thread_time() - start)


def baseline(made: Planned | None) -> tuple[str, Job]:
    """A product of poses for each member of a new family, or for each point."""
    poses = [Pose() for _ in made.aims] if made else [Pose()]
    if made and made.family and made.family.id == "family":
        poses = [member.T_reference_tool for member in made.family.members]
    reference = Pose.from_rpy((0.5, 0.1, 0.75), (0.0, 0.0, 0.3))
    name = f"  baseline: {len(poses)} product{'s' if len(poses) > 1 else ''} of poses"
    return name, lambda: [reference @ pose for pose in poses]


def row(name: str, found: list[float]) -> str:
    ordered = sorted(found)
    p95 = ordered[min(len(ordered) - 1, int(0.95 * len(ordered)))]
    middle = statistics.median(found)
    return f"{name:<36} least {ordered[0]:6.3f} ms   median {middle:6.3f} ms   p95 {p95:6.3f} ms"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="1 round instead of 50")
    stands = scenes(1 if parser.parse_args().small else 50)
    for case in cases():
        jobs = [case.job(scene) for scene in stands]
        made = jobs[0]()
        print(row(case.title(made), [time_ms(job) for job in jobs]))
        name, products = baseline(made)
        print(row(name, [time_ms(products) for _ in stands]))
    print(row("look tube_5", [time_ms(look(scene)) for scene in stands]))
    name, product = baseline(None)
    print(row(name, [time_ms(product) for _ in stands]))


if __name__ == "__main__":
    main()
