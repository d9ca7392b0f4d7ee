"""A chain gone through before its grasp is chosen: where every object is when the arm is at each target."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, MoveTo
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import left, seat, take
from xei_lang.motion.sequence.sections import Chain, Group
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Ride, Snapshot


@dataclass(frozen=True, slots=True)
class Moment:
    """The arm arrives at a target while `goal` runs, everything else being as in `snapshot`."""

    goal: MotionGoal
    snapshot: Snapshot


@dataclass(frozen=True, slots=True)
class Rehearsal:
    """A chain between two snapshots that hold whatever is chosen; joints of the moving arm and grasps are not
    yet known.
    """

    chain: Chain
    before: Snapshot
    moments: tuple[Moment, ...]
    after: Snapshot


def rehearse(context: Context, chain: Chain, before: Snapshot) -> Rehearsal:
    """Follow the hand actions of a chain from `before`; a grasp in it is not yet chosen."""
    now = before
    moments: list[Moment] = []
    for goal in chain.goals:
        action = goal.action
        if isinstance(action, MoveTo):
            moments.append(Moment(goal, now))
        elif isinstance(action, Grip):
            now = now.moved(context.robot.with_opening(now.q, action.arm, action.opening_m))
        elif isinstance(action, Attach):
            now = now.attached(action.arm, take(context, chain, action, len(moments) - 1, UNCHOSEN, now))
        elif isinstance(action, Detach) and action.arm in now.held:
            now = _left(context, action, now)
    return Rehearsal(chain, before, tuple(moments), now)


def _left(context: Context, action: Detach, now: Snapshot) -> Snapshot:
    """What is let go of; on a carrier in a hand it sits where it will: where that hand is is not known."""
    if action.fastened_to and now.holders(action.fastened_to):
        return now.detached(action.arm, action.T_base_object, Ride(action.fastened_to, seat(context, action)))
    return left(context, action, action.T_base_object, now)


def rehearse_group(context: Context, group: Group, before: Snapshot) -> tuple[Rehearsal, ...]:
    """All chains of a group in order, with the grips between them."""
    now = before
    rehearsals: list[Rehearsal] = []
    for item in group.items:
        if isinstance(item, Chain):
            rehearsals.append(rehearse(context, item, now))
            now = rehearsals[-1].after
        elif isinstance(item.action, Grip):
            now = now.moved(context.robot.with_opening(now.q, item.action.arm, item.action.opening_m))
    return tuple(rehearsals)
