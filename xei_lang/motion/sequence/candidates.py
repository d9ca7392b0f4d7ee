"""Candidates of one chain looked for: which grasps, at which slide heights, and how many of each are enough.

Grasps are tried best first, a round of them at all slide heights at once, until each height has enough: a
plain scene costs little, a crowded one is searched to the end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.layers import Layer, layer_of
from xei_lang.motion.sequence.poses import tool_poses
from xei_lang.motion.sequence.postures import Rows, feasible, joined, key_target, none_of, on_line
from xei_lang.motion.sequence.sections import Chain

Array = NDArray[np.float64]
CheckTarget = Callable[[int, Array], Bools]
"""For the index of a target and configurations (n, 8) of slide and arm: which of them touch something (n,).
"""

MEMBERS_PER_ROUND = 16

_FACING_COST = 1.0


@dataclass(frozen=True, slots=True)
class Effort:
    """How widely to look: slide heights, grasps wanted at each, configurations of each grasp, and how many
    blocked transits are put up with. `exhaustive` leaves out at once what could only fall later.
    """

    heights: int
    poses_per_height: int
    configurations_per_pose: int
    blocked_transits: int
    exhaustive: bool = False


LEAN = Effort(5, 8, 5, 3)
THOROUGH = Effort(13, 10_000, 20, 1, exhaustive=True)


def slide_heights(context: Context, slide_m: float, effort: Effort) -> Array:
    """Heights to try in metres: the present one first, then the others of a grid over the stroke, nearest
    first.
    """
    limits = context.slide_limits
    grid = np.linspace(limits.lower, limits.upper, effort.heights)
    others = grid[np.abs(grid - slide_m) > 0.25 * (grid[1] - grid[0])]
    return np.concatenate([[slide_m], others[np.argsort(np.abs(others - slide_m), kind="stable")]])


def enumerate_layer(
    context: Context, chain: Chain, heights: Array, allowed: Bools, touches: CheckTarget, effort: Effort
) -> Layer:
    """Candidates of a chain over slide heights (h,), for the members (m,) that `allowed` leaves."""
    solver = context.solvers[chain.arm]
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    ranked = _ranked(context, chain, poses, allowed)
    found = np.zeros(len(heights), dtype=np.int64)
    kept: list[Rows] = [none_of(len(poses))]
    for first in range(0, len(ranked), MEMBERS_PER_ROUND):
        hungry = np.flatnonzero(found < effort.poses_per_height)
        if len(hungry) == 0:
            break
        members = ranked[first : first + MEMBERS_PER_ROUND]
        rows = feasible(solver, poses, members, heights[hungry], effort.configurations_per_pose, chain.legs)
        if effort.exhaustive:
            rows = on_line(solver, poses, rows, chain.legs)
        rows = _without_contact(rows, touches)
        kept.append(rows)
        for index in hungry:
            found[index] += len(np.unique(rows.member[rows.q[:, 0, 0] == heights[index]]))
    return layer_of(context, chain, poses, joined(kept))


def _ranked(context: Context, chain: Chain, poses: Array, allowed: Bools) -> NDArray[np.intp]:
    """Members in the order in which they are worth trying: cheap ones first, and those whose hand comes from
    the robot's side.
    """
    shoulder = context.robot.T_base_frame(
        np.zeros(context.robot.nq), context.robot.arm(chain.arm).shoulder_frame
    )
    key = poses[key_target(chain.legs, len(poses))]
    away = key[:, :2, 3] - shoulder[:2, 3]
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
    facing = np.einsum("mi,mi->m", key[:, :2, 2], away)
    costs = np.array([member.cost for member in chain.family.members]) + _FACING_COST * (1.0 - facing)
    members = np.flatnonzero(allowed)
    return members[np.argsort(costs[members], kind="stable")]


def _without_contact(rows: Rows, touches: CheckTarget) -> Rows:
    """The rows that touch nothing at any target; the grasp, where most fall, is looked at first."""
    targets = rows.q.shape[1]
    for target in sorted(range(targets), key=lambda index: (index != 1, index)):
        if len(rows.member) == 0:
            break
        rows = rows.kept(np.flatnonzero(~touches(target, rows.q[:, target])))
    return rows
