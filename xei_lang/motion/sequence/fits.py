"""What an object meets where it is set down, whichever way a hand holds it: told before any grasp is tried.

Where a chain brings a held object to follows from the goals alone, for every grasp alike. So one look at the
object among what stands there does for thousands of candidates, each of which would fall by itself.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose, Primitive
from xei_lang.ir.goals import MoveTo
from xei_lang.motion.collision.bodies import coal_shape
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.poses import matrix
from xei_lang.motion.sequence.rehearse import Moment, Rehearsal
from xei_lang.motion.sequence.space import Pair

coal: Any = importlib.import_module("coal")  # ships no type information

_Shapes = tuple[tuple[Any, Any], ...]
"""A body's shapes for coal, each with its place in the base frame."""

_STEP_M = 0.01
_SLACK_M = 0.001
"""What a move may be off its line, and more: who falls here would fall there too."""
_STRAIGHT = 1e-9


def object_touch(context: Context, rehearsal: Rehearsal) -> Pair | None:
    """The held object and what it would touch on the straight moves of a chain, with every grasp; None where
    some grasp may do. What the robot itself would touch is not looked at.
    """
    for first, second in pairwise(rehearsal.moments):
        start, end = _where(rehearsal, first), _where(rehearsal, second)
        if start is None or end is None or not isinstance(second.goal.action, MoveTo):
            continue
        straight = second.goal.action.path == "linear" and _is_shift(start, end)
        around = _around(context, second)
        for pose in _between(start, end) if straight else (start, end):
            touched = _touched(context, rehearsal, second, pose, around)
            if touched is not None:
                return touched
    return None


def _where(rehearsal: Rehearsal, moment: Moment) -> Pose | None:
    """Where the object is in the base frame at a moment, the same for all grasps; None where it is not."""
    held = moment.snapshot.held.get(rehearsal.chain.arm)
    action = moment.goal.action
    target = action.target if isinstance(action, MoveTo) else None
    if held is None or not isinstance(target, ToolTarget) or target.family != held.family.id:
        return None
    if any(target.offset_tool_m):
        return None
    return Pose(target.offset_base_m) @ target.T_base_reference @ held.T_reference_object


def _is_shift(start: Pose, end: Pose) -> bool:
    return bool(np.abs(matrix(start)[:3, :3] - matrix(end)[:3, :3]).max() < _STRAIGHT)


def _between(start: Pose, end: Pose) -> Iterator[Pose]:
    a, b = np.array(start.position_m), np.array(end.position_m)
    for share in np.linspace(0.0, 1.0, int(np.linalg.norm(b - a) / _STEP_M) + 2).tolist():
        x, y, z = (a + share * (b - a)).tolist()
        yield Pose((x, y, z), start.quaternion)


def _around(context: Context, moment: Moment) -> tuple[tuple[str, _Shapes], ...]:
    """What stands at a moment, by name, in the base frame."""
    found = ((name, context.world.find(name)) for name in moment.snapshot.standing)
    return tuple(
        (name, _shapes(item.geometry, moment.snapshot.T_base_object(name)))
        for name, item in found
        if item is not None
    )


def _touched(
    context: Context,
    rehearsal: Rehearsal,
    moment: Moment,
    T_base_object: Pose,
    around: tuple[tuple[str, _Shapes], ...],
) -> Pair | None:
    snapshot = moment.snapshot
    held = snapshot.held[rehearsal.chain.arm].object
    near_m = context.profile.calibration.clearance_m - _SLACK_M
    for name, T_object_own in ((held, Pose()), *snapshot.riders(held)):
        own = context.world.find(name)
        if own is None:
            continue
        may = {other for pair in moment.goal.allowed_contacts if name in pair for other in pair}
        shapes = _shapes(own.geometry, T_base_object @ T_object_own)
        for other, standing in around:
            if other not in may and _meet(shapes, standing, near_m):
                return name, other
    return None


def _meet(a: _Shapes, b: _Shapes, near_m: float) -> bool:
    """Whether two bodies come nearer to each other than that."""
    request = coal.DistanceRequest()
    return any(
        coal.distance(*one, *other, request, coal.DistanceResult()) < near_m for one in a for other in b
    )


def _shapes(geometry: tuple[Primitive, ...], T_base_body: Pose) -> _Shapes:
    return tuple((coal_shape(one.shape), _placed(T_base_body @ one.T_object_shape)) for one in geometry)


def _placed(pose: Pose) -> Any:
    T = matrix(pose)
    return coal.Transform3s(T[:3, :3], T[:3, 3])
