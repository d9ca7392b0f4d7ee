"""Room in the air: where hands can turn or meet over a bench without anything near."""

from __future__ import annotations

import math
from operator import itemgetter

from xei_lang.ir.geometry import Vec3
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.operations.base import Work
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.walk import Standing
from xei_lang.profiles.model import LabObject

_AHEAD_M = 0.32
_INWARDS = 2 / 3
"""Where a single arm works, from the robot's middle to its shoulder."""
_HAND_M = 0.12
"""How far hand and wrist reach about what they hold while they turn."""
_ALIKE_M = 1e-9


def room_in_air(work: Work, sides: tuple[Side, ...], radius_m: float) -> tuple[Vec3, Setting, Setting]:
    """The middle of a free ball of this radius, in the base frame, and the settings that put it there.

    It lies `air_ahead` ahead of the shoulders, between those of two arms or a little inside that of one, and
    `air_clearance` over the highest thing below it. What hands hold is not looked at: where they will be is
    not chosen yet.
    """
    ahead = work.layers.merge("air_ahead", None)
    if ahead is None:
        ahead = computed_length("air_ahead", _AHEAD_M, "where an arm reaches from all sides")
    clearance = work.layers.merge("air_clearance", None)
    if clearance is None:
        clearance = computed_length("air_clearance", _HAND_M, "of the hand that turns")
    shoulders = [shoulder_xy(work.profile, side) for side in sides]
    x = shoulders[0][0] + ahead.si("Length")
    y = _INWARDS * sum(shoulder[1] for shoulder in shoulders) / len(shoulders)
    z = _highest(work, x, y, radius_m + clearance.si("Length")) + radius_m + clearance.si("Length")
    return (x, y, z), ahead, clearance


def _highest(work: Work, x: float, y: float, radius_m: float) -> float:
    """The top of the highest object that reaches under a level circle about `(x, y)`, in the base frame; 0
    where there is none.
    """
    T_world_base = work.scene.epoch.T_world_base
    T_base_world = T_world_base.inverse()
    up_x, up_y, up_z = T_world_base.rotate((0.0, 0.0, 1.0))
    foot_x, foot_y, foot_z = T_world_base.apply((x, y, 0.0))
    find = work.profile.object
    near: list[tuple[float, float, Standing, LabObject]] = []
    for name, standing in work.scene.standing.items():
        known = find(name)
        if known is None:
            continue
        px, py, pz = standing.T_world_object.position_m
        dx, dy, dz = foot_x - px, foot_y - py, foot_z - pz
        # How far the circle's foot is over the object's origin, and how high the object is if it is upright.
        over = dx * up_x + dy * up_y + dz * up_z
        length, width, height = known.size_m
        reach = radius_m + length + width + height
        if dx * dx + dy * dy + dz * dz - over * over <= reach * reach:
            near.append((height - over, over, standing, known))
    top = 0.0
    for upright, over, standing, known in sorted(near, key=itemgetter(0), reverse=True):
        # None is higher than it is upright, nor are those after it.
        if upright < top - _ALIKE_M:
            break
        # The circle's middle at the height of the object's origin.
        point = (foot_x - over * up_x, foot_y - over * up_y, foot_z - over * up_z)
        beside_x, beside_y, _ = standing.T_world_object.locate(point)
        length, width, height = known.size_m
        away = math.hypot(max(0.0, abs(beside_x) - length / 2), max(0.0, abs(beside_y) - width / 2))
        if away < radius_m:
            top = max(top, (T_base_world @ standing.T_world_object).apply((0.0, 0.0, height))[2])
    return top
