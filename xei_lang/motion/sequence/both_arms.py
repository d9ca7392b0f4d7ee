"""A move of both arms to a named configuration: together on the straight line, else found one arm after the
other.

Searching seven joints twice takes a fraction of searching fourteen. The two finds make one polyline, whose
shortcuts let the arms move together again wherever that is free.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.paths.free import FreePath, PathBlocked, plan_free_path, round_corners, shortcut
from xei_lang.motion.paths.joint_path import line_path
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import Pair, SceneSpace, space_for

Array = NDArray[np.float64]

_CHECKS_PER_ARM = 2_000
_CHECKS = 4_000


def plan_joints(
    context: Context,
    before: Snapshot,
    joints: tuple[str, ...],
    q_goal: Array,
    allowed: tuple[Pair, ...],
    seed: int,
) -> FreePath | PathBlocked:
    """A free path of any joints to `q_goal` (n,); where several arms move and the straight line is blocked,
    arm by arm first.
    """
    space = space_for(context, before, joints, allowed)
    columns = [context.robot.joint_names.index(joint) for joint in joints]
    q_start = before.q[columns]
    arms = [
        [joints.index(name) for name in arm.joint_names if name in joints]
        for arm in context.robot.arms.values()
    ]
    arms = [arm for arm in arms if arm]
    if len(arms) > 1 and space.contact(q_start) is None and space.contact(q_goal) is None:
        if space.edge_is_free(q_start, q_goal):
            return FreePath(line_path(joints, q_start, q_goal), "line")
        for order in (arms, arms[::-1]):
            found = _one_by_one(space, q_start, q_goal, order, seed)
            if found is not None:
                return found
    return plan_free_path(space, q_start, q_goal, seed, _CHECKS)


def _one_by_one(
    space: SceneSpace, q_start: Array, q_goal: Array, order: list[list[int]], seed: int
) -> FreePath | None:
    """The arms' paths in this order as one polyline, shortened and rounded; joints of no arm move with the
    last.
    """
    from xei_lang.motion.paths.rrt_connect import rrt_connect

    now, waypoints = q_start, [q_start[None]]
    for number, arm in enumerate(order):
        moving = arm if number + 1 < len(order) else _rest(order[:-1], len(q_start))
        goal = now.copy()
        goal[moving] = q_goal[moving]
        part = space.narrowed(now, moving)
        found: Array | None = np.stack([now[moving], goal[moving]])
        if not part.edge_is_free(now[moving], goal[moving]):
            found = (
                rrt_connect(part, now[moving], goal[moving], seed, _CHECKS_PER_ARM)
                if part.is_free(goal[moving])
                else None
            )
        if found is None:
            return None
        steps = np.tile(now, (len(found), 1))
        steps[:, moving] = found
        waypoints.append(steps[1:])
        now = goal
    return FreePath(round_corners(space, shortcut(space, np.concatenate(waypoints), seed)), "rrt-connect")


def _rest(done: list[list[int]], count: int) -> list[int]:
    moved = [index for arm in done for index in arm]
    return [index for index in range(count) if index not in moved]
