"""What a group should know of the parts after it: where its arm goes next, and where its hand lets go."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from xei_lang.ir.goals import Detach, Grip, JointTarget, MotionGoal, MoveTo, NavToPose, SlideMove
from xei_lang.ir.skill_plan import Side
from xei_lang.motion.sequence.choose import Array
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import left
from xei_lang.motion.sequence.meeting import Encounter, takes_over
from xei_lang.motion.sequence.parting import Parting, parting_of
from xei_lang.motion.sequence.rehearse import Rehearsal, rehearse_group
from xei_lang.motion.sequence.sections import Group, Part
from xei_lang.motion.sequence.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class Ahead:
    """What comes after a group: the configuration (7,) of the arm that is named next, if one is, and the
    chains of later groups in which the hand still holds what it took in this one, up to where it lets go: the
    grasp must serve in all of them; how the hand parts from it that this group takes it from; and, where the
    two grasps are chosen together, its taking by the other hand after the last of those chains.
    """

    configuration: Array | None = None
    release: tuple[Rehearsal, ...] = ()
    parting: Parting | None = None
    encounter: Encounter | None = None


def look_ahead(
    context: Context, group: Group, later: tuple[Part, ...], start: Snapshot, meeting: bool = False
) -> Ahead:
    """The outlook of a group that begins at `start`, with the parts that follow it in order. With `meeting`,
    how it holds an object out is chosen together with how the other hand takes it.
    """
    after = rehearse_group(context, group, start)[-1].after
    return Ahead(
        _next_configuration(context, group.arm, later),
        _release(context, group.arm, later, after),
        parting_of(later, after),
        _encounter(context, group.arm, later, after) if meeting else None,
    )


def _encounter(context: Context, giver: Side, later: tuple[Part, ...], now: Snapshot) -> Encounter | None:
    """The taking of what a hand holds by the other one, if that comes next; the state before it with the jaws
    as they are by then.
    """
    for index, part in enumerate(later):
        held = now.held.get(giver)
        if held is None:
            return None
        if isinstance(part, MotionGoal):
            now = _passed(context, part, now)
            if isinstance(part.action, Grip):
                now = now.moved(context.robot.with_opening(now.q, part.action.arm, part.action.opening_m))
        elif takes_over(part, giver, held.object):
            rest = later[index + 1 :]
            after = rehearse_group(context, part, now)[-1].after
            kept = _release(context, part.arm, rest, after)
            return Encounter(giver, part, now, parting_of(rest, after), kept)
        else:
            now = rehearse_group(context, part, now)[-1].after
    return None


def _next_configuration(context: Context, arm: Side, later: tuple[Part, ...]) -> Array | None:
    target = _named(later[0]) if later else None
    joints = {} if target is None else dict(target.joints)
    names = context.robot.arm(arm).joint_names
    return np.array([joints[name] for name in names]) if all(name in joints for name in names) else None


def _release(context: Context, arm: Side, later: tuple[Part, ...], now: Snapshot) -> tuple[Rehearsal, ...]:
    """The next chains of the arm while the object is in its hand, carry poses before drives among them, up to
    the one that sets it down.
    """
    if arm not in now.held:
        return ()
    found: list[Rehearsal] = []
    for part in later:
        if arm not in now.held:
            break
        if isinstance(part, MotionGoal):
            now = _passed(context, part, now)
            continue
        rehearsals = rehearse_group(context, part, now)
        for item in rehearsals if part.arm == arm else ():
            found.append(item)
            if arm not in item.after.held:
                return tuple(found)
        now = rehearsals[-1].after
    return tuple(found)


def _passed(context: Context, goal: MotionGoal, now: Snapshot) -> Snapshot:
    """The snapshot after a fixed goal, as far as it is known beforehand."""
    action = goal.action
    if isinstance(action, NavToPose):
        return replace(now, T_world_base=action.T_world_base)
    if isinstance(action, Detach):
        return left(context, action, action.T_base_object, now)
    target = _named(goal)
    q = now.q.copy()
    if isinstance(action, SlideMove):
        q[context.robot.slide_index] = action.height_m
        return now.moved(q)
    if target is None:
        return now
    for joint, value in target.joints:
        q[context.robot.joint_names.index(joint)] = value
    return now.moved(q)


def _named(part: Part) -> JointTarget | None:
    if isinstance(part, MotionGoal) and isinstance(part.action, MoveTo):
        return part.action.target if isinstance(part.action.target, JointTarget) else None
    return None
