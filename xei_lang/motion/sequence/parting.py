"""What follows when a hand has closed on what the other one holds: the other opens and backs off. A grasp
from which it cannot is no good, so this is tried with each candidate.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.goals import Detach, Grip, MotionGoal
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import grip, left
from xei_lang.motion.sequence.onward import goes_on, onward_layer
from xei_lang.motion.sequence.sections import Chain, Group, Part
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import Touch, motion_contact
from xei_lang.motion.sequence.transit import plan_transit


@dataclass(frozen=True, slots=True)
class Parting:
    """What the other hand does until it is clear: its jaws, its letting go, and the chain that backs off."""

    goals: tuple[MotionGoal, ...]
    chain: Chain


def parting_of(later: tuple[Part, ...], after: Snapshot) -> Parting | None:
    """The parting that the parts after a group begin with; None where no object is in two hands by then."""
    if all(len(after.holders(held.object)) < 2 for held in after.held.values()):
        return None
    goals = tuple(part for part in later if isinstance(part, MotionGoal))
    group = next((part for part in later if isinstance(part, Group)), None)
    if group is None or not goes_on(group.chains[0]):
        return None
    return Parting(goals[: later.index(group)], group.chains[0])


def parting_touch(context: Context, parting: Parting, now: Snapshot, member: int) -> Touch | None:
    """What the other hand meets when it opens and backs off; `member` is the grasp that is to blame."""
    for goal in parting.goals:
        if isinstance(goal.action, Grip):
            motion = grip(context, goal, goal.action, now)
            bodies = motion_contact(context, motion)
            if bodies is not None:
                return Touch(member, bodies)
            now = motion.after
        elif isinstance(goal.action, Detach):
            now = left(context, goal.action, goal.action.T_base_object, now)
    layer = onward_layer(context, parting.chain, now)
    if len(layer) == 0:
        return Touch(member, None)
    away = plan_transit(context, layer, 0, now)
    return Touch(member, away.bodies) if isinstance(away, PathBlocked) else None
