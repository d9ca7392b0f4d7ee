"""The drives of a plan by the map, where the profile has one; without a map drives are taken as straight."""

from __future__ import annotations

from dataclasses import replace

from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.skill_plan import SkillPlan, StationRef
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile


def with_drives(world: World, profile: Profile, plan: SkillPlan) -> tuple[World, Diagnostics]:
    """The world with the ways between the stations that the plan drives to, and what the map speaks against.

    The map is read only for a plan that drives.
    """
    named = profile.calibration.map
    stations = _stations(world, plan)
    if named is None or not named.is_named or len(stations) < 2:
        return world, ()
    from xei_lang.world.map.deployed import look_at_map

    found = look_at_map(profile, world, stations)
    return replace(world, drives=found.drives), found.diagnostics


def _stations(world: World, plan: SkillPlan) -> tuple[str, ...]:
    """The start station and those that steps name, each once."""
    named = [arg.value.name for step in plan.steps for arg in step.args if isinstance(arg.value, StationRef)]
    return tuple(dict.fromkeys((world.robot.station, *named)))
