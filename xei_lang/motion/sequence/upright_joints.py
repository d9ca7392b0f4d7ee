"""Free moves that keep what is held upright, searched over joints: slower than over tool poses
(`upright.py`), and not bound to one branch of the arm or to the neighbourhood of the way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.motion.paths.constrained import constrained_connect
from xei_lang.motion.paths.free import FreePath, round_corners
from xei_lang.motion.paths.joint_path import JointPath, spline_path
from xei_lang.motion.robot import Robot
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.poses import matrix
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import Pair, SceneSpace, space_for
from xei_lang.motion.sequence.upright import tilt, work_room

Array = NDArray[np.float64]

SLACK = 0.5
"""Share of the bound that projected configurations keep: what lies between two of them may tilt further."""
_MAX_CHECKS = 1_000
_ITERATIONS = 8
_SLIDE_ROOM_M = 0.1
_SAMPLE_RAD = 0.05


@dataclass(frozen=True, slots=True)
class Upright:
    """The constraint that an axis of the tool (3,) stands within `within_rad` of the vertical, and the tool
    between the corners of `room` in the base frame, m.
    """

    robot: Robot
    frame: str
    axis: Array
    rest: Array
    columns: list[int]
    within_rad: float
    room: tuple[Array, Array]

    def project(self, q: Array) -> Array | None:
        """The configuration (n,) turned upright by Gauss-Newton steps of least norm; None where they do not
        end, or end outside the room.
        """
        whole = self.rest.copy()
        for _ in range(_ITERATIONS):
            whole[self.columns] = q
            T_base_tool = self.robot.T_base_frame(whole, self.frame)
            up = T_base_tool[:3, :3] @ self.axis
            if up[2] >= math.cos(self.within_rad):
                return q if self._is_in_room(T_base_tool[:3, 3]) else None
            turning = self.robot.jacobian(whole, self.frame)[3:, self.columns]
            q = q - np.linalg.pinv(np.cross(turning.T, up).T[:2], rcond=1e-3) @ up[:2]
        return None

    def _is_in_room(self, point: Array) -> bool:
        return bool(np.all(point >= self.room[0]) and np.all(point <= self.room[1]))


def plan_upright_joints(
    context: Context, side: Side, before: Snapshot, q_goal: Array, allowed: tuple[Pair, ...], seed: int
) -> FreePath | None:
    """A free move of slide and arm to `q_goal` (8,) on which the held object keeps within the bound."""
    joints, columns = context.arm_joints(side), context.arm_indices(side)
    q_start = before.q[columns]
    space = _near_slide(space_for(context, before, joints, allowed), q_start, q_goal)
    bound = context.profile.calibration.spill_tilt_rad
    frame = context.robot.arm(side).tool_frame
    axis = matrix(before.held[side].T_tool_object)[:3, 2]
    tools = [context.robot.T_base_frame(context.lift(before.q, side, q), frame) for q in (q_start, q_goal)]
    room = work_room(context, np.stack([T[:3, 3] for T in tools]))
    upright = Upright(context.robot, frame, axis, before.q, columns, SLACK * bound, room)
    way = constrained_connect(space, upright.project, q_start, q_goal, seed, _MAX_CHECKS)
    if way is None:
        return None
    for path in (spline_path(joints, way), round_corners(space, way)):
        if _holds(context, side, before, space, path, bound):
            return FreePath(_without_resting_slide(path), "upright-cbirrt")
    return None


def _near_slide(space: SceneSpace, q_start: Array, q_goal: Array) -> SceneSpace:
    """The space with the slide, which is slow, kept near to where it begins and ends."""
    lower, upper = space.lower.copy(), space.upper.copy()
    lower[0] = max(lower[0], min(q_start[0], q_goal[0]) - _SLIDE_ROOM_M)
    upper[0] = min(upper[0], max(q_start[0], q_goal[0]) + _SLIDE_ROOM_M)
    return replace(space, lower=lower, upper=upper)


def _holds(
    context: Context, side: Side, before: Snapshot, space: SceneSpace, path: JointPath, bound: float
) -> bool:
    q = path.sampled(_SAMPLE_RAD)
    inside = bool(np.all(q >= space.lower - 1e-9) and np.all(q <= space.upper + 1e-9))
    upright = inside and tilt(context, before, side, path.joints, q) <= bound
    return upright and all(space.edge_is_free(a, b) for a, b in pairwise(q))


def _without_resting_slide(path: JointPath) -> JointPath:
    if float(np.abs(path.coefficients[:, 1:, 0]).max()) > 1e-9:
        return path
    return replace(path, joints=path.joints[1:], coefficients=path.coefficients[:, :, 1:])
