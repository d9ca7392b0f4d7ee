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
        for pose in _between(start, end) if straight else (start, end):
            touched = _touched(context, rehearsal, second, pose)
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


def _touched(context: Context, rehearsal: Rehearsal, moment: Moment, T_base_object: Pose) -> Pair | None:
    snapshot = moment.snapshot
    held = snapshot.held[rehearsal.chain.arm].object
    for name, T_object_own in ((held, Pose()), *snapshot.riders(held)):
        may = {other for pair in moment.goal.allowed_contacts if name in pair for other in pair}
        own, T_base_own = context.world.find(name), T_base_object @ T_object_own
        for other in snapshot.standing:
            item = context.world.find(other)
            if own is None or item is None or other in may:
                continue
            if _meet(context, own.geometry, T_base_own, item.geometry, snapshot.T_base_object(other)):
                return name, other
    return None


def _meet(
    context: Context, a: tuple[Primitive, ...], T_base_a: Pose, b: tuple[Primitive, ...], T_base_b: Pose
) -> bool:
    """Whether two bodies come nearer than planning lets them, by more than `_SLACK_M`."""
    near_m = context.profile.calibration.clearance_m - _SLACK_M
    request = coal.DistanceRequest()
    for one in a:
        for other in b:
            places = (_placed(T_base_a @ one.T_object_shape), _placed(T_base_b @ other.T_object_shape))
            shapes = (coal_shape(one.shape), coal_shape(other.shape))
            result = coal.DistanceResult()
            distance = coal.distance(shapes[0], places[0], shapes[1], places[1], request, result)
            if distance < near_m:
                return True
    return False


def _placed(pose: Pose) -> Any:
    T = matrix(pose)
    return coal.Transform3s(T[:3, :3], T[:3, 3])
