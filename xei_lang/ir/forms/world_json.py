"""World as JSON: robot, frames, objects (each with where its fields are from) and the sources asked."""

from __future__ import annotations

from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.forms.geometry_json import pose, primitive
from xei_lang.ir.world import Drive, Frame, Opening, World, WorldObject


def to_json(world: World) -> dict[str, Json]:
    """The whole world; objects keep their order (sorted by name)."""
    return {
        "version": 1,
        "robot": {
            "station": world.robot.station,
            "T_world_base": pose(world.robot.T_world_base),
            "joints": dict(world.robot.joints),
        },
        "frames": [_frame(frame) for frame in world.frames],
        "objects": [_object(item) for item in world.objects],
        "sources": list(world.sources),
        **({"drives": [_drive(one) for one in world.drives]} if world.drives else {}),
    }


def _frame(frame: Frame) -> dict[str, Json]:
    return {
        "name": frame.name,
        "parent": frame.parent,
        "T_parent_frame": pose(frame.T_parent_frame),
        "status": frame.status,
        "position_tolerance_m": frame.position_tolerance_m,
        "rotation_tolerance_rad": frame.rotation_tolerance_rad,
        "tolerance_as": frame.tolerance_as,
    }


def _drive(drive: Drive) -> dict[str, Json]:
    return {
        "start": drive.start,
        "goal": drive.goal,
        "poses": [list(pose) for pose in drive.poses],
        "length_m": drive.length_m,
        "turn_rad": drive.turn_rad,
    }


def _object(item: WorldObject) -> dict[str, Json]:
    return {
        "name": item.name,
        "frame_id": item.frame_id,
        "T_frame_object": pose(item.T_frame_object),
        "place": item.place,
        "confidence": item.confidence,
        "movable": item.movable,
        "roles": list(item.roles),
        "skills": list(item.skills),
        "size_m": list(item.size_m),
        "mass_kg": item.mass_kg,
        "geometry": [primitive(part) for part in item.geometry],
        "states": dict(item.states),
        "metadata": dict(item.metadata),
        "provenance": dict(item.provenance),
        **({"fastened_to": item.fastened_to} if item.fastened_to else {}),
        **({"openings": [_opening(one) for one in item.openings]} if item.openings else {}),
    }


def _opening(item: Opening) -> dict[str, Json]:
    grid: dict[str, Json] = {"counts": list(item.counts), "pitch_m": list(item.pitch_m)}
    return {
        "T_object_mouth": pose(item.T_object_mouth),
        "radius_m": item.radius_m,
        "depth_m": item.depth_m,
        **(grid if item.counts != (1, 1) else {}),
    }
