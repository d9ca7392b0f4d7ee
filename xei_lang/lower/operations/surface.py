"""Free room on a surface: where to set an object down when only the surface is named."""

from __future__ import annotations

import math

from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import LabObject, Profile

_GRID_M = 0.05
_EDGE_M = 0.02
_BESIDE_M = 0.05
_AHEAD_M = 0.30


def free_room(profile: Profile, scene: Scene, arm: Side, surface: str, known: LabObject) -> Pose | None:
    """The free point of a surface's top that is easiest for the arm, in the surface's frame; None where
    there is none.

    Points lie on a grid of 50 mm about the middle, the object's outline 20 mm inside the edge and 50 mm (a
    finger and its room) from everything else; the easiest is nearest to 0.30 m ahead of the shoulder.
    """
    host = profile.object(surface)
    if host is None:
        return None
    radius = math.hypot(known.size_m[0], known.size_m[1]) / 2
    T_base_host = scene.T_base_object(surface)
    shoulder = shoulder_xy(profile, arm)
    best: tuple[float, Pose] | None = None
    for x in _steps(host.size_m[0] / 2 - radius):
        for y in _steps(host.size_m[1] / 2 - radius):
            point = Pose((x, y, host.size_m[2]))
            bx, by, _ = T_base_host.apply(point.position_m)
            away = round(math.hypot(bx - shoulder[0] - _AHEAD_M, by - shoulder[1]), 6)
            if (best is None or away < best[0]) and _is_free(profile, scene, surface, point, known):
                best = (away, point)
    return best[1] if best else None


def _steps(room_m: float) -> tuple[float, ...]:
    """Grid values from the middle to `room_m` on both sides, without the edge; the middle alone where it is
    tight.
    """
    if room_m < 0.0:
        return ()
    count = int(max(0.0, room_m - _EDGE_M) / _GRID_M + 1e-9)
    return tuple(k * _GRID_M for k in range(-count, count + 1))


def _is_free(profile: Profile, scene: Scene, surface: str, point: Pose, known: LabObject) -> bool:
    radius = math.hypot(known.size_m[0], known.size_m[1]) / 2
    T_world_point = scene.standing[surface].T_world_object @ point
    for name, other in scene.standing.items():
        thing = profile.object(name)
        if thing is None or name in (surface, known.name):
            continue
        x, y, z = other.T_world_object.inverse().apply(T_world_point.position_m)
        if not -known.size_m[2] < z < thing.size_m[2] - 1e-3:
            continue
        beside = math.hypot(max(0.0, abs(x) - thing.size_m[0] / 2), max(0.0, abs(y) - thing.size_m[1] / 2))
        if beside < radius + _BESIDE_M:
            return False
    return True
