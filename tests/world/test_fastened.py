"""A cap on its bottle's thread rides on the bottle, wherever that is and however the cap was seen."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.capped import BOTTLE, CAP, cap, capped, capped_profile, grounded
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground
from xei_lang.world.sources.believed import as_believed
from xei_lang.world.sources.observation import Observation, Observations


def fastened(world: World) -> dict[str, str]:
    return {item.name: item.fastened_to for item in world.objects if item.fastened_to}


def seen(profile: Profile, name: str, T_world_object: Pose) -> World:
    one = Observation(name, T_frame_object=T_world_object, frame_id="world", confidence=0.9)
    world, problems = ground(profile, (Observations("eyes", (one,), "0" * 64),))
    assert world is not None, problems
    return world


def test_a_cap_whose_prior_is_the_mouth_rides() -> None:
    assert fastened(capped()[1]) == {CAP: BOTTLE}


def test_what_has_no_thread_just_stands_there() -> None:
    bottle = capped()[0].object(BOTTLE)
    assert bottle is not None
    loose = replace(cap(bottle), thread=None)
    assert fastened(grounded(capped_profile(others=(loose,)))) == {}


def test_a_cap_elsewhere_rides_on_nothing() -> None:
    profile, world = capped()
    x, y, z = world.T_world_object(BOTTLE).position_m
    apart = seen(profile, CAP, Pose((x - 0.1, y - 0.05, z)))
    assert fastened(apart) == {}


@pytest.mark.parametrize("off_m", [0.0, 0.004])
def test_a_cap_seen_on_its_bottle_sits_in_the_middle_of_the_thread(off_m: float) -> None:
    profile, world = capped()
    x, y, z = world.T_world_object(CAP).position_m
    now = seen(profile, CAP, Pose((x + off_m, y - off_m, z + off_m)))
    assert fastened(now) == {CAP: BOTTLE}
    assert now.T_world_object(CAP).position_m == pytest.approx((x, y, z), abs=1e-9)


def test_a_bottle_that_was_seen_elsewhere_has_its_cap_on() -> None:
    profile, world = capped()
    x, y, z = world.T_world_object(BOTTLE).position_m
    now = seen(profile, BOTTLE, Pose((x - 0.02, y + 0.01, z)))
    assert fastened(now) == {CAP: BOTTLE}
    T_before = world.T_world_object(BOTTLE).inverse() @ world.T_world_object(CAP)
    T_after = now.T_world_object(BOTTLE).inverse() @ now.T_world_object(CAP)
    assert T_after.position_m == pytest.approx(T_before.position_m, abs=1e-9)


def test_a_profile_made_of_a_world_says_the_same() -> None:
    profile, world = capped()
    assert fastened(grounded(as_believed(profile, world))) == {CAP: BOTTLE}
