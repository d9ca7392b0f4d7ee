"""`scene.json`: every body with its primitives and its pose before anything moves, and each stand."""

from __future__ import annotations

from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.forms.geometry_json import pose, primitive
from xei_lang.ir.goals import Epoch, MotionGoalGraph
from xei_lang.ir.world import World, WorldObject


def to_json(world: World, graph: MotionGoalGraph) -> dict[str, Json]:
    """Bodies in the root frame `world`, sorted by name, and the pose of the base there for each epoch.

    `timed.json` says what a hand carries and where it leaves it, in the base frame of the goal's epoch:
    `T_world_object = T_world_base(epoch) @ T_base_object`.
    """
    return {
        "version": 1,
        "frame": "world",
        "epochs": [_epoch(epoch) for epoch in graph.epochs],
        "bodies": [_body(world, item) for item in sorted(world.objects, key=lambda item: item.name)],
    }


def _epoch(epoch: Epoch) -> dict[str, Json]:
    return {"index": epoch.index, "station": epoch.station, "T_world_base": pose(epoch.T_world_base)}


def _body(world: World, item: WorldObject) -> dict[str, Json]:
    return {
        "name": item.name,
        "movable": item.movable,
        "place": item.place,
        "roles": list(item.roles),
        "mass_kg": item.mass_kg,
        "size_m": list(item.size_m),
        "T_world_object": pose(world.T_world_object(item.name)),
        "primitives": [primitive(part) for part in item.geometry],
    }
