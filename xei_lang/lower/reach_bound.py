"""Parameters that put a hand farther away than any arm reaches: certain before any motion is planned.

What an arm reaches is bounded by its length, with all its joints on one line, from its shoulder at any height
of the slide. Within that bound it is for motion planning to find out.
"""

from __future__ import annotations

import math

from xei_lang.ir.geometry import Vec3
from xei_lang.lower.hand import SIDES
from xei_lang.lower.operations import Aim, Planned
from xei_lang.lower.parameters import Setting
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import arm_length_m, shoulder_height_m, shoulder_xy
from xei_lang.lower.task import Task
from xei_lang.profiles.model import Profile
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import LENGTH
from xei_lang.quantity.lengths import mm
from xei_lang.world.frames import slide_joint


def refuse_too_far(task: Task, aim: Aim, planned: Planned) -> None:
    """Give up a step whose parameter takes the hand beyond every arm's length from its shoulder (XEI0702)."""
    target, length_m = aim.target, max(arm_length_m(task.profile, side) for side in SIDES)
    away_m = math.hypot(*target.offset_base_m) + math.hypot(*target.offset_tool_m)
    blamed = _longest(aim, planned)
    if away_m <= length_m or blamed is None:
        return
    x, y, z = target.T_base_reference.position_m
    dx, dy, dz = target.offset_base_m
    beyond_m = _from_shoulders_m(task.profile, (x + dx, y + dy, z + dz)) - _object_m(task, planned)
    # Both ends of a way back are within reach of the shoulder, wherever the slide then is.
    longest_m = 2 * length_m + _slide_m(task.profile)
    if beyond_m <= length_m and math.hypot(*target.offset_tool_m) <= longest_m:
        return
    refuse(
        "XEI0702",
        f"`{blamed.name}` of {blamed.text} is farther than an arm reaches",
        blamed.span or task.step.span,
        f"expected less: an arm is {mm(length_m)} long from its shoulder to its grasp",
        notes=(f"{blamed.rule}",) if blamed.span is None else (),
    )


def _longest(aim: Aim, planned: Planned) -> Setting | None:
    """The longest of the lengths that made the aim."""
    used = [planned.settings[name] for name in aim.uses if name in planned.settings]
    lengths = [item for item in used if isinstance(item.value, Quantity) and item.value.dimension == LENGTH]
    return max(lengths, key=lambda item: item.si("Length"), default=None)


def _object_m(task: Task, planned: Planned) -> float:
    """How far from the object's origin a hand may hold it: no farther than its size."""
    known = task.profile.object(planned.family.reference if planned.family else task.object)
    return math.hypot(*known.size_m) if known else math.inf


def _from_shoulders_m(profile: Profile, point: Vec3) -> float:
    """From a point in the base frame to the nearer shoulder, at the best height of the slide."""
    slide = profile.robot.joint(slide_joint(profile))
    found: list[float] = []
    for side in SIDES:
        (x, y), z = shoulder_xy(profile, side), shoulder_height_m(profile, side)
        low, high = (z + slide.lower, z + slide.upper) if slide else (z, z)
        nearest = min(max(point[2], low), high)
        found.append(math.dist(point, (x, y, nearest)))
    return min(found)


def _slide_m(profile: Profile) -> float:
    slide = profile.robot.joint(slide_joint(profile))
    return slide.upper - slide.lower if slide else 0.0
