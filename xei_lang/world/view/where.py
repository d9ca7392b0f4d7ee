"""All that is known of where one object is: its pose, who said so, and how well that is known."""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.reach import stations_that_reach
from xei_lang.world.transforms import lookup
from xei_lang.world.view.frame_text import history_lines
from xei_lang.world.view.table import reach_text
from xei_lang.world.view.way_text import way_lines

BASE = "robot_base"


def object_called(profile: Profile, name: str) -> LabObject | None:
    """The object of this name, or with this alias, whatever the case of its letters."""
    by_alias = (item for item in profile.objects if name.lower() in (alias.lower() for alias in item.aliases))
    return profile.object(name) or next(by_alias, None)


def to_text(world: World, profile: Profile, item: LabObject, *, history: bool = False) -> str:
    """Some lines about an object of the profile, which need not be in the world; with `history` also what the
    transforms on the way to it were before.
    """
    aliases = ", ".join(f'"{alias}"' for alias in item.aliases)
    head = f"{item.name} ({aliases})" if aliases else item.name
    found = world.find(item.name)
    if found is None:
        asked = ", ".join(world.sources)
        return f"{head}\n  no source says where it is; asked, in this order: {asked}\n"
    lines = [*_lines(world, profile, found), *(_histories(world, profile, found) if history else ())]
    return "\n".join([head, *(f"  {line}" for line in lines)]) + "\n"


def _lines(world: World, profile: Profile, item: WorldObject) -> Iterator[str]:
    yield f"stands in {item.place}" if item.place else "stands free"
    yield f"in {item.frame_id}: {pose_text(item.T_frame_object)}"
    table = _nearest_table(world, profile, item)
    if table and table != item.frame_id:
        T_table_object = world.T_world_frame(table).inverse() @ world.T_world_object(item.name)
        yield f"in {table}: {pose_text(T_table_object)}"
    way = lookup(world, BASE, item.frame_id, item.T_frame_object.position_m)
    yield f"in {BASE} at {world.robot.station}: {pose_text(way.T_target_source @ item.T_frame_object)}"
    yield from (f"  {line}" for line in way_lines(way))
    yield f"confidence {item.confidence:g}"
    yield from (f"{name} is {value}" for name, value in item.states)
    yield f"within reach: {reach_text(stations_that_reach(profile, world, item.name))}"
    yield "said by"
    width = max(len(name) for name, _ in item.provenance)
    yield from (f"  {name.ljust(width)}  {source}" for name, source in item.provenance)
    seen = [(name, value) for name, value in item.metadata if not name.startswith("asset.")]
    yield from (f"{name} = {value}" for name, value in seen)


def _histories(world: World, profile: Profile, item: WorldObject) -> Iterator[str]:
    stated = {frame.name: frame for frame in profile.calibration.frames}
    for link in lookup(world, BASE, item.frame_id).links:
        if link.name in stated:
            yield f"frame {link.name}"
            yield from (f"  {line}" for line in history_lines(stated[link.name]))


def _nearest_table(world: World, profile: Profile, item: WorldObject) -> str:
    """The frame of a bench that is nearest to the object, or an empty name."""
    here = world.T_world_object(item.name).position_m
    tables = sorted({station.ground_frame for station in profile.calibration.stations})
    known = [name for name in tables if world.frame(name) is not None]
    return min(known, key=lambda name: math.dist(world.T_world_frame(name).position_m, here), default="")
