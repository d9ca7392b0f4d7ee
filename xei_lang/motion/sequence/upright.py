"""Free moves that keep what is held upright: planned over where the tool is instead of over joints.

A state is (x, y, z, turn, slide, swivel): the tool's place and its turn about the vertical from where the
move begins, in m and rad, the slide's height and the arm's swivel angle. Inverse kinematics in one branch
makes it a configuration, so that every state is upright. The same planner as for joints searches this space;
the path is then a spline through close configurations.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.motion.kinematics import Solver
from xei_lang.motion.paths.free import FreePath, PathBlocked, plan_free_path
from xei_lang.motion.paths.joint_path import JointPath, spline_path
from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.poses import matrix
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import Pair, SceneSpace, space_for

Array = NDArray[np.float64]

STEP = np.array([0.01, 0.01, 0.01, 0.07, 0.02, 0.07])
_SPEED = np.array([0.4, 0.4, 0.4, 1.5, 0.1, 1.5])
_ROOM_M = 0.35
_MARGIN_M = 0.01
_JUMP_RAD = 0.4
_ALIGNED = 1e-3
_MAX_CHECKS = 500


def tilt(context: Context, before: Snapshot, side: Side, joints: tuple[str, ...], q: Array) -> float:
    """The largest angle to the vertical of what `side` holds over joint positions (m, joints), rad; 0 with an
    empty hand.
    """
    held = before.held.get(side)
    if held is None:
        return 0.0
    columns = [context.robot.joint_names.index(joint) for joint in joints]
    axis = matrix(held.T_tool_object)[:3, 2]
    frame = context.robot.arm(side).tool_frame
    worst = 0.0
    for row in q:
        whole = before.q.copy()
        whole[columns] = row
        up = float((context.robot.T_base_frame(whole, frame)[:3, :3] @ axis)[2])
        worst = max(worst, math.acos(min(1.0, max(-1.0, up))))
    return worst


@dataclass(frozen=True, slots=True)
class UprightSpace:
    """Free upright states of one arm; see this module for what a state is."""

    joints: tuple[str, ...]
    lower: Array
    upper: Array
    speed: Array
    arm: SceneSpace
    solver: Solver
    branch: int
    R_start: Array

    def is_free(self, q: Array) -> bool:
        """See `FreeSpace`."""
        found, valid = self.configurations(q[None])
        return bool(valid[0]) and self.arm.is_free(found[0])

    def edge_is_free(self, q_start: Array, q_end: Array) -> bool:
        """See `FreeSpace`."""
        states = between(q_start, q_end)
        found, valid = self.configurations(states)
        if not valid.all() or np.abs(np.diff(found[:, 1:], axis=0)).max(initial=0.0) > _JUMP_RAD:
            return False
        return not self.arm.any_contact(found)

    def contact(self, q: Array) -> Pair | None:
        """See `FreeSpace`. A state that no configuration reaches touches nothing."""
        found, valid = self.configurations(q[None])
        return self.arm.contact(found[0]) if valid[0] else None

    def configurations(self, states: Array) -> tuple[Array, Bools]:
        """Slide and arm (m, 8) of states (m, 6), and which of them exist."""
        poses = np.tile(np.eye(4), (len(states), 1, 1))
        c, s = np.cos(states[:, 3]), np.sin(states[:, 3])
        turn = np.zeros((len(states), 3, 3))
        turn[:, 0, 0], turn[:, 0, 1], turn[:, 1, 0], turn[:, 1, 1], turn[:, 2, 2] = c, -s, s, c, 1.0
        poses[:, :3, :3] = turn @ self.R_start
        poses[:, :3, 3] = states[:, :3]
        q, valid = self.solver.at_many(poses, states[:, 4], states[:, 5], self.branch)
        return np.concatenate([states[:, 4:5], q], axis=1), valid


def between(start: Array, end: Array) -> Array:
    """States (m, 6) on the straight line, at most `STEP` apart, both ends included."""
    count = max(2, math.ceil(float(np.max(np.abs(end - start) / STEP))) + 1)
    return start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)


def plan_upright(
    context: Context, side: Side, before: Snapshot, q_goal: Array, allowed: tuple[Pair, ...], seed: int
) -> FreePath | PathBlocked | None:
    """A free move of slide and arm to `q_goal` (8,) that keeps the tool's tilt; None where the two ends do
    not allow one.

    They must be of one branch and differ in a turn about the vertical only.
    """
    solver, joints = context.solvers[side], context.arm_joints(side)
    q_start = before.q[context.arm_indices(side)]
    (swivel_a, branch), (swivel_b, other) = solver.describe(q_start[1:]), solver.describe(q_goal[1:])
    T_start, T_goal = (_tool(context, side, before.q, q) for q in (q_start, q_goal))
    turn = T_goal[:3, :3] @ T_start[:3, :3].T
    if branch != other or abs(turn[2, 2] - 1.0) > _ALIGNED:
        return None
    yaw = math.atan2(turn[1, 0], turn[0, 0])
    start = np.array([*T_start[:3, 3], 0.0, q_start[0], swivel_a])
    goal = np.array([*T_goal[:3, 3], yaw, q_goal[0], swivel_a + _wrapped(swivel_b - swivel_a)])
    space = _space(
        context, solver, branch, T_start[:3, :3], start, goal, space_for(context, before, joints, allowed)
    )
    found = plan_free_path(space, start, goal, seed, max_checks=_MAX_CHECKS)
    if isinstance(found, PathBlocked):
        return found
    path = _joint_path(space, found.path, joints, q_start, q_goal)
    return None if path is None else FreePath(path, f"upright-{found.planner}")


def _tool(context: Context, side: Side, q: Array, q_arm: Array) -> Array:
    return context.robot.T_base_frame(context.lift(q, side, q_arm), context.robot.arm(side).tool_frame)


def work_room(context: Context, ends: Array) -> tuple[Array, Array]:
    """The corners (3,) of where a tool that works may be, in the base frame: within the workspace by a margin
    that rounded corners may use up, and around both ends (2, 3) of its way.
    """
    least, most = (np.array(corner) for corner in context.profile.calibration.workspace_bounds_m)
    return np.minimum(least + _MARGIN_M, ends.min(axis=0)), np.maximum(most - _MARGIN_M, ends.max(axis=0))


def _wrapped(angle: float) -> float:
    return math.remainder(angle, 2.0 * math.pi)


def _space(
    context: Context, solver: Solver, branch: int, R_start: Array, start: Array, goal: Array, arm: SceneSpace
) -> UprightSpace:
    low, high = np.minimum(start, goal), np.maximum(start, goal)
    slide = context.slide_limits
    room = np.array([_ROOM_M, _ROOM_M, _ROOM_M, math.pi, 0.0, math.pi])
    lower, upper = low - room, high + room
    lower[4], upper[4] = slide.lower, slide.upper
    least, most = work_room(context, np.stack([start[:3], goal[:3]]))
    lower[:3], upper[:3] = np.maximum(lower[:3], least), np.minimum(upper[:3], most)
    names = ("x", "y", "z", "turn", "slide", "swivel")
    return UprightSpace(names, lower, upper, _SPEED, arm, solver, branch, R_start)


def _joint_path(
    space: UprightSpace, path: JointPath, joints: tuple[str, ...], q_start: Array, q_goal: Array
) -> JointPath | None:
    """The spline of slide and arm along a path of states; the slide left out where it rests."""
    count = 2
    for a, b in zip(path.breaks, path.breaks[1:], strict=False):
        ends = path.evaluate(np.array([a, b]), 0)
        count += math.ceil(float(np.max(np.abs(ends[1] - ends[0]) / STEP)))
    q, valid = space.configurations(path.evaluate(np.linspace(0.0, path.length, count), 0))
    if not valid.all():
        return None
    q[0], q[-1] = q_start, q_goal
    if not all(space.arm.edge_is_free(a, b) for a, b in pairwise(q)):
        return None
    rests = abs(float(np.ptp(q[:, 0]))) < 1e-9
    return spline_path(joints[1:], q[:, 1:]) if rests else spline_path(joints, q)
