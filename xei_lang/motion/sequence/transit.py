"""The free move that brings an arm to the first target of a chain."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MoveTo
from xei_lang.motion.paths.free import FreePath, PathBlocked, plan_free_path
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import choice_name
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.onward import goes_on, straight_on
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.sections import Chain
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import motion_contact, space_for
from xei_lang.motion.sequence.upright import plan_upright, tilt
from xei_lang.motion.sequence.upright_joints import plan_upright_joints

Array = NDArray[np.float64]

_TILT_SAMPLES = 24
_MAX_CHECKS = 2_000


def keeps_upright(rehearsal: Rehearsal) -> bool:
    """Whether the free move of a chain begins with something in the hand that must stay upright."""
    move = rehearsal.chain.head.action
    return isinstance(move, MoveTo) and move.keep_upright and rehearsal.chain.arm in rehearsal.before.held


def plan_transit(
    context: Context, layer: Layer, index: int, before: Snapshot, upright: bool = True
) -> Motion | PathBlocked:
    """The free move to a candidate's first target; the slide takes part where its height changes.

    Without `upright`, what the goal asks to keep upright may tilt as it likes: only messages ask for that.
    """
    chain, goal = layer.chain, layer.chain.head
    assert isinstance(goal.action, MoveTo)
    q_goal = layer.q[index, 0]
    if goes_on(chain) and _shows(context, layer, index, before):
        return _onward(context, layer, index, before)
    keep = upright and goal.action.keep_upright and chain.arm in before.held
    found = _upright(context, chain, before, q_goal) if keep else _free(context, chain, before, q_goal)
    if isinstance(found, PathBlocked):
        return found
    after = before.moved(context.lift(before.q, chain.arm, q_goal))
    return Motion(
        goal, before, after, found.path, found.planner, speed_fraction=goal.action.speed_fraction,
        arm=chain.arm, choice=choice_name(layer, index, before),
    )  # fmt: skip


def _shows(context: Context, layer: Layer, index: int, before: Snapshot) -> bool:
    """Whether the arm holds the slide, swivel and branch of a candidate already."""
    q = before.q[context.arm_indices(layer.chain.arm)]
    swivel, branch = context.solvers[layer.chain.arm].describe(q[1:])
    same = abs(q[0] - layer.q[index, 0, 0]) < 1e-9 and abs(swivel - layer.swivel_angle[index, 0]) < 1e-9
    return same and branch == layer.branch[index]


def _onward(context: Context, layer: Layer, index: int, before: Snapshot) -> Motion | PathBlocked:
    """The straight move that a chain begins with, where nothing is in its way."""
    chain, goal = layer.chain, layer.chain.head
    assert isinstance(goal.action, MoveTo)
    found = straight_on(context, layer, index, before)
    if isinstance(found, PathBlocked):
        return found
    after = before.moved(context.lift(before.q, chain.arm, layer.q[index, 0]))
    motion = Motion(
        goal, before, after, found.path, found.planner, speed_fraction=goal.action.speed_fraction,
        arm=chain.arm, choice=choice_name(layer, index, before),
    )  # fmt: skip
    bodies = motion_contact(context, motion)
    return motion if bodies is None else PathBlocked("between", bodies)


def worst_tilt(context: Context, motion: Motion) -> float:
    """The largest tilt along a transit of what its arm holds, rad."""
    assert motion.path is not None
    assert motion.arm is not None
    path = motion.path
    q = path.evaluate(np.linspace(0.0, path.length, _TILT_SAMPLES), 0)
    return tilt(context, motion.before, motion.arm, path.joints, q)


def _free(context: Context, chain: Chain, before: Snapshot, q_goal: Array) -> FreePath | PathBlocked:
    joints, indices = context.arm_joints(chain.arm), context.arm_indices(chain.arm)
    if abs(q_goal[0] - before.q[indices[0]]) < 1e-9:
        joints, indices, q_goal = joints[1:], indices[1:], q_goal[1:]
    space = space_for(context, before, joints, chain.head.allowed_contacts)
    return plan_free_path(space, before.q[indices], q_goal, context.goal_seed(chain.head.id), _MAX_CHECKS)


def _upright(context: Context, chain: Chain, before: Snapshot, q_goal: Array) -> FreePath | PathBlocked:
    """A free move that keeps the held object within the tilt bound: over tool poses, or else over joints."""
    goal, seed = chain.head, context.goal_seed(chain.head.id)
    found = plan_upright(context, chain.arm, before, q_goal, goal.allowed_contacts, seed)
    if isinstance(found, FreePath) or (found is not None and found.where != "between"):
        return found
    way = plan_upright_joints(context, chain.arm, before, q_goal, goal.allowed_contacts, seed)
    return way or found or PathBlocked("between", None)
