"""The bench with a bottle that is closed by a cap of its own, whatever the bench's files say of either."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from tests.lower.plans import bench
from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.world import World
from xei_lang.profiles.model import LabObject, Prior, Profile, Spot, Thread
from xei_lang.world.ground import ground

BOTTLE, CAP = "bottle_1", "bottle_1_cap"
HEIGHT_M, NECK_M = 0.105, 0.014
CAP_RADIUS_M, CAP_HEIGHT_M = 0.016, 0.034
HERE = Span("usage_profile.yaml", 0, 8)


def standing(radius_m: float, height_m: float, bottom_m: float = 0.0) -> Primitive:
    """An upright cylinder whose bottom is this high over the object's frame."""
    return Primitive(Cylinder(radius_m, height_m), Pose((0.0, 0.0, bottom_m + height_m / 2)))


def cap(bottle: LabObject, name: str = CAP, on: str = BOTTLE, radius_m: float = CAP_RADIUS_M) -> LabObject:
    """A cap on the mouth of a bottle."""
    shape = Cylinder(radius_m, CAP_HEIGHT_M)
    return replace(
        bottle,
        name=name,
        aliases=(),
        roles=("movable", "cap"),
        shape=shape,
        geometry=(standing(radius_m, CAP_HEIGHT_M),),
        size_m=(2 * radius_m, 2 * radius_m, CAP_HEIGHT_M),
        mass_kg=0.012,
        states=(),
        liquid=None,
        grasp=(),
        spots=(),
        prior=Prior(on, "mouth", "", Pose(), 0.6, HERE, "spot"),
        thread=Thread(on, "mouth", 0.004, 1.5, "table", "bottle", HERE),
    )


def capped_profile(
    radius_m: float = CAP_RADIUS_M, others: tuple[LabObject, ...] = (), base: Profile | None = None
) -> Profile:
    """The bench with the cap on `bottle_1`: the body ends where its neck, 14 mm high, begins; the cap is over
    the neck. `others` join, or replace objects of their names. The bench's own caps, and where they rest, are
    left out.
    """
    profile = base or bench()[0]
    bottle = profile.object(BOTTLE)
    assert bottle is not None
    body_m = HEIGHT_M - NECK_M
    bottle = replace(
        bottle,
        shape=Cylinder(0.028, HEIGHT_M),
        geometry=(standing(0.028, body_m), standing(0.012, NECK_M, body_m)),
        size_m=(0.056, 0.056, HEIGHT_M),
        spots=(Spot("mouth", Pose((0.0, 0.0, body_m + 0.001)), HERE),),
        thread=None,
    )
    changed = {item.name: item for item in (bottle, cap(bottle, radius_m=radius_m), *others)}
    kept = tuple(item for item in profile.objects if item.name not in changed and "cap" not in item.name)
    return replace(profile, objects=tuple(sorted((*kept, *changed.values()), key=lambda item: item.name)))


def grounded(profile: Profile) -> World:
    """The world that its priors describe."""
    world, problems = ground(profile)
    assert world is not None, problems
    return world


@lru_cache(maxsize=1)
def capped() -> tuple[Profile, World]:
    """The bench with a closed bottle, and its world."""
    profile = capped_profile()
    return profile, grounded(profile)
