"""The bench profile, loaded once for all tests of the world."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from xei_lang.ir.world import World
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground

BENCH = Path(__file__).parents[2] / "profiles" / "openarm_bench"


@cache
def bench() -> Profile:
    profile, found = load_profile(BENCH, None)
    assert profile is not None, found
    assert found == ()
    return profile


@cache
def world() -> World:
    grounded, found = ground(bench())
    assert found == ()
    assert grounded is not None
    return grounded
