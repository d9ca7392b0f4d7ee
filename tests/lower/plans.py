"""Plans for the lowering tests, built by hand: chains of calls with made-up spans, and the bench that they
run on.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import Argument, ObjectRef, PlaceRef, SkillPlan, StationRef, Step, StepKind, Value
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import LabObject, Profile, SkillSpec
from xei_lang.world.ground import ground

FOLDER = Path(__file__).parents[2] / "profiles" / "openarm_bench"
STATEMENTS: tuple[StepKind, ...] = ("wait", "confirm", "measure")


@lru_cache(maxsize=1)
def bench() -> tuple[Profile, World]:
    """The bench's profile and the world that its priors describe."""
    profile, problems = load_profile(FOLDER, None)
    assert profile is not None, problems
    world, problems = ground(profile)
    assert world is not None, problems
    return profile, world


def slot(rack: str, key: str) -> PlaceRef:
    return PlaceRef(rack, "slot", key)


def spot(surface: str, key: str) -> PlaceRef:
    return PlaceRef(surface, "spot", key)


def surface(name: str) -> PlaceRef:
    return PlaceRef(name, "surface", "")


def obj(name: str) -> ObjectRef:
    return ObjectRef(name)


def station(name: str) -> StationRef:
    return StationRef(name)


def plan(*calls: tuple[str, dict[str, Value]]) -> SkillPlan:
    """A chain of skill calls and statements; argument k of call i stands at characters 100 i + 10 k + 10 ..
    +8.
    """
    steps: list[Step] = []
    counts: dict[str, int] = {}
    for index, (name, args) in enumerate(calls):
        counts[name] = counts.get(name, 0) + 1
        start = 100 * index
        arguments = tuple(
            Argument(key, value, "", "call", Span("test.xei", start + 10 * k + 10, start + 10 * k + 18))
            for k, (key, value) in enumerate(args.items())
        )
        kind: StepKind = next((item for item in STATEMENTS if item == name), "skill")
        after = (steps[-1].step_id,) if steps else ()
        span = Span("test.xei", start, start + 90)
        skill = name if kind == "skill" else ""
        steps.append(Step(f"{name}#{counts[name]}", kind, span, skill, "", arguments, after=after))
    return SkillPlan("test", "openarm_bench", tuple(steps))


def put_on_rack() -> SkillPlan:
    """Pick a tube and insert it in the other rack, with whichever arm."""
    return plan(
        ("pick", {"object": obj("tube_1"), "arm": "either"}),
        ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "either"}),
    )


def with_object(profile: Profile, name: str, changed: LabObject) -> Profile:
    """The profile with one object changed."""
    objects = tuple(changed if item.name == name else item for item in profile.objects)
    return replace(profile, objects=objects)


def with_skill(profile: Profile, changed: SkillSpec) -> Profile:
    """The profile with one skill changed."""
    skills = tuple(changed if item.name == changed.name else item for item in profile.bank.skills)
    return replace(profile, bank=replace(profile.bank, skills=skills))


def moved(world: World, name: str, T_world_object: Pose) -> World:
    """The world with an object somewhere else, in no place."""

    def change(item: WorldObject) -> WorldObject:
        if item.name != name:
            return item
        return replace(item, frame_id="world", T_frame_object=T_world_object, place="")

    return replace(world, objects=tuple(change(item) for item in world.objects))
