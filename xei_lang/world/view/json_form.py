"""The world as JSON with what a profile adds to it: the form of `xei world show --format json`."""

from __future__ import annotations

from xei_lang.ir.forms import world_json
from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.reach import stations_that_reach


def to_json(world: World, profile: Profile) -> dict[str, Json]:
    """The world's own form, the profile's name, and for each object the arms that may reach it by station."""
    reach: dict[str, Json] = {
        item.name: {one.station: list(one.arms) for one in stations_that_reach(profile, world, item.name)}
        for item in world.objects
    }
    return {**world_json.to_json(world), "profile": profile.name, "reach": reach}
