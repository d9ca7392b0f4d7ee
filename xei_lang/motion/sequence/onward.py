"""A chain that begins with a straight move from where the arm stands, instead of a free one: a hand that
backs off from what the other hand has taken.

Nothing is left to choose: the member of the family is the one that the tool shows already, slide, swivel and
branch are those of the arm.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MoveTo
from xei_lang.motion.paths.free import FreePath, PathBlocked
from xei_lang.motion.paths.joint_path import spline_path
from xei_lang.motion.paths.tool_path import StraightPath
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import JUMP_RAD, STEP_M, STEP_RAD
from xei_lang.motion.sequence.layers import Layer, layer_of
from xei_lang.motion.sequence.poses import tool_poses
from xei_lang.motion.sequence.postures import Rows, carried, none_of
from xei_lang.motion.sequence.sections import Chain
from xei_lang.motion.sequence.snapshot import Snapshot

Array = NDArray[np.float64]

_SAME_TURN = 1e-3


def goes_on(chain: Chain) -> bool:
    """Whether a chain begins where its arm stands."""
    head = chain.head.action
    return isinstance(head, MoveTo) and head.path == "linear"


def onward_layer(context: Context, chain: Chain, before: Snapshot) -> Layer:
    """The candidates of such a chain: the members that the tool shows, none where it shows none."""
    solver, q = context.solvers[chain.arm], before.q[context.arm_indices(chain.arm)]
    T_now = context.robot.T_base_frame(before.q, context.robot.arm(chain.arm).tool_frame)
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    turned = np.linalg.norm(poses[0, :, :3, :3] - T_now[:3, :3], axis=(1, 2))
    members = np.flatnonzero(turned < _SAME_TURN)
    if len(members) == 0:
        return layer_of(context, chain, poses, none_of(len(poses)))
    away = np.linalg.norm(poses[0, members, :3, 3] - T_now[:3, 3], axis=1)
    member = members[[int(np.argmin(away))]].astype(np.int64)
    swivel, branch = solver.describe(q[1:])
    angles, code = np.full((1, len(poses)), swivel), np.array([branch], dtype=np.int64)
    rows, valid = carried(solver, poses[:, member].swapaxes(0, 1), q[:1], angles, code)
    kept = np.flatnonzero(valid.all(axis=1))
    return layer_of(context, chain, poses, Rows(rows, member, angles, code).kept(kept))


def straight_on(context: Context, layer: Layer, index: int, before: Snapshot) -> FreePath | PathBlocked:
    """The straight way of the tool from where it is to the chain's first target, contacts left aside."""
    chain = layer.chain
    arm = context.robot.arm(chain.arm)
    way = StraightPath(
        context.robot.T_base_frame(before.q, arm.tool_frame), layer.poses[0, int(layer.member[index])]
    )
    share = way.shares(STEP_M / 2, STEP_RAD / 2)
    swivel = np.full((1, len(share)), layer.swivel_angle[index, 0])
    q, valid = carried(
        context.solvers[chain.arm], way.poses(share)[None], layer.q[index, :1, 0], swivel,
        layer.branch[index : index + 1],
    )  # fmt: skip
    rows = q[0, :, 1:]
    rows[0] = before.q[list(arm.q_indices)]
    if not valid.all() or np.abs(np.diff(rows, axis=0)).max() > JUMP_RAD:
        return PathBlocked("between", None)
    return FreePath(spline_path(arm.joint_names, rows), "spline")
