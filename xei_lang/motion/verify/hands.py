"""What the plan says is held and set down, against what the history of attach and detach makes of it."""

from __future__ import annotations

import math
from itertools import combinations

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, MotionGoal, in_hand
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import Attachment, TimedGoal
from xei_lang.motion.verify.context import Context, pose_error
from xei_lang.motion.verify.timeline import Held, Moment


def check_hands(context: Context) -> None:
    """Each goal lists every held object that its joints carry, what rides on those, and nothing that is not
    held, at the pose in the hand that attaching made; a detach lets go of what was held, at the place that
    was asked for, and says where that and its riders are left."""
    for goal in context.plan.goals:
        planned = context.planned(goal)
        if planned is None:
            continue
        _check_listed(context, goal)
        _check_shared(context, goal)
        _check_carried(context, goal)
        if isinstance(planned.action, Attach):
            _check_attach(context, goal, planned.action)
        elif isinstance(planned.action, Detach):
            _check_detach(context, goal, planned, planned.action)


def _check_listed(context: Context, goal: TimedGoal) -> None:
    start, end = context.timeline.starts[goal.id], context.timeline.ends[goal.id]
    for item in goal.attached:
        moment = next((m for m in (start, end) if any(h.object == item.object for h in m.scene.held)), None)
        if moment is None:
            text = f"the plan says that `{item.object}` is held, but nothing has taken it"
            context.found("attachment", goal, goal.start_s, item.object, text)
        elif item.link not in context.robot.links:
            context.found(
                "attachment", goal, goal.start_s, item.object, f"`{item.link}` is no link of the robot"
            )
        else:
            T_base_object = context.robot.pose(moment.q, item.link) @ item.T_link_object
            _check_same_pose(context, goal, moment, item.object, T_base_object)
            _check_same_hand(context, goal, moment, item)


def _check_same_hand(context: Context, goal: TimedGoal, moment: Moment, item: Attachment) -> None:
    """No joint of the goal moves what the plan says it moves without moving it, or the other way about: a
    pose that is right at the start says nothing of who carries it on.
    """
    moved = {context.robot.column[joint] for joint in goal.joints if joint in context.robot.column}
    stated = moved.intersection(context.robot.columns(item.link))
    held = [other for other in moment.scene.held if other.object == item.object]
    if not any(stated == moved.intersection(context.robot.columns(other.link)) for other in held):
        hand = held[0].side
        text = f"the plan says that `{item.link}` carries `{item.object}`, which the {hand} hand holds"
        context.found("attachment", goal, goal.start_s, item.object, text)


def _check_same_pose(
    context: Context, goal: TimedGoal, moment: Moment, name: str, T_base_object: Pose
) -> None:
    held = next(item for item in moment.scene.held if item.object == name)
    actual = context.robot.pose(moment.q, held.link) @ held.T_link_object
    distance, angle = pose_error(T_base_object, actual)
    options = context.options
    if distance > options.held_position_m or angle > options.held_rotation_rad:
        text = f"`{name}` sits elsewhere in the hand than where it was taken"
        context.found(
            "attachment",
            goal,
            goal.start_s,
            name,
            text,
            value=distance,
            limit=options.held_position_m,
            unit="m",
        )


def _check_carried(context: Context, goal: TimedGoal) -> None:
    listed = {item.object for item in goal.attached}
    moved = {context.robot.column[joint] for joint in goal.joints if joint in context.robot.column}
    for held in context.timeline.starts[goal.id].scene.held:
        carried = moved.intersection(context.robot.columns(held.link))
        if carried and held.object not in listed:
            where = f"on `{held.rides_on}` in" if held.rides_on else "in"
            text = f"`{held.object}` is {where} the hand that moves, but the plan does not say so"
            context.found("attachment", goal, goal.start_s, held.object, text)


def _check_shared(context: Context, goal: TimedGoal) -> None:
    """While two hands hold an object, no joint moves the one against the other."""
    moved = {context.robot.column[joint] for joint in goal.joints if joint in context.robot.column}
    held = context.timeline.starts[goal.id].scene.held
    for first, second in combinations((item for item in held if not item.rides_on), 2):
        between = set(context.robot.columns(first.link)) ^ set(context.robot.columns(second.link))
        if first.object == second.object and moved & between:
            text = f"`{first.object}` is in both hands while one moves against the other"
            context.found("attachment", goal, goal.start_s, first.object, text)


def _check_attach(context: Context, goal: TimedGoal, action: Attach) -> None:
    held = context.timeline.starts[goal.id].scene.held
    before = [item for item in held if item.object == action.object and not item.rides_on]
    if before and not _is_left_to(context, goal, action):
        context.found("attachment", goal, goal.start_s, action.object, f"`{action.object}` is already held")
    if not any(item.object == action.object for item in context.timeline.ends[goal.id].scene.held):
        context.found(
            "attachment", goal, goal.start_s, action.object, f"the world has no object `{action.object}`"
        )


def _is_left_to(context: Context, goal: TimedGoal, action: Attach) -> bool:
    """Whether the hand that holds the object leaves it next, to the one that takes it."""
    rows = [context.planned(later) for later in context.plan.goals if later.start_s >= goal.end_s - 1e-9]
    acts = [row.action for row in rows if row is not None and row.id != goal.id]
    left = next((act for act in acts if isinstance(act, Detach) and act.object == action.object), None)
    return left is not None and left.arm != action.arm and left.place == in_hand(action.arm)


def _check_detach(context: Context, goal: TimedGoal, planned: MotionGoal, action: Detach) -> None:
    start, end = context.timeline.starts[goal.id], context.timeline.ends[goal.id]
    taken = (item for item in start.scene.held if not item.rides_on)
    holders: dict[Side, Held] = {item.side: item for item in taken if item.object == action.object}
    held = holders.get(action.arm)
    if held is None:
        text = f"the {action.arm} hand lets go of `{action.object}`, which it does not hold"
        context.found("attachment", goal, goal.start_s, action.object, text)
        return
    others = [in_hand(side) for side in holders if side != action.arm]
    if (others or action.place.endswith(" hand")) and action.place not in others:
        text = f"`{action.object}` is not left to a hand that holds it"
        context.found("attachment", goal, goal.start_s, action.object, text)
    symmetric = any(family.id == held.family and family.symmetric for family in context.graph.families)
    where = "where it was asked for"
    _check_left(context, goal, action.object, action.T_base_object, end, symmetric=symmetric, where=where)
    _check_fastened(context, goal, action, end)
    for name in (action.object, *_on_it(end, action.object)):
        _check_stated(context, goal, name, end)


def _check_fastened(context: Context, goal: TimedGoal, action: Detach, end: Moment) -> None:
    """What is to ride on something from here on does, and nothing else."""
    if end.scene.riders.get(action.object, "") != action.fastened_to:
        text = f"`{action.object}` cannot ride on `{action.fastened_to}`"
        context.found("attachment", goal, goal.start_s, action.object, text)


def _on_it(moment: Moment, name: str) -> tuple[str, ...]:
    """What is fastened on an object, and on that."""
    own = [rider for rider, on in moment.scene.riders.items() if on == name]
    return tuple(found for rider in own for found in (rider, *_on_it(moment, rider)))


def _check_stated(context: Context, goal: TimedGoal, name: str, end: Moment) -> None:
    """The plan says where an object is left, and it is there."""
    stated = [item for item in goal.placed if item.object == name]
    if not stated:
        text = f"the plan does not say where `{name}` is left"
        context.found("placement", goal, goal.end_s, name, text)
    for item in stated:
        where = "where the plan says"
        _check_left(context, goal, name, item.T_base_object, end, symmetric=False, where=where)


def _check_left(
    context: Context, goal: TimedGoal, name: str, wanted: Pose, end: Moment, *, symmetric: bool, where: str
) -> None:
    options = context.options
    actual = end.scene.objects[name]
    distance, angle = pose_error(wanted, actual)
    if symmetric:
        wanted_z, actual_z = wanted.axes()[2], actual.axes()[2]
        angle = 2.0 * math.asin(min(1.0, 0.5 * math.dist(wanted_z, actual_z)))
    context.margin("placement", distance / options.placed_position_m, name, goal.id, goal.end_s)
    if distance > options.placed_position_m:
        text = f"`{name}` is left {distance * 1e3:.3g} mm from {where}"
        limit = options.placed_position_m
        context.found("placement", goal, goal.end_s, name, text, value=distance, limit=limit, unit="m")
    elif angle > options.placed_rotation_rad:
        text = f"`{name}` is left turned by {math.degrees(angle):.3g} deg from {where}"
        limit = options.placed_rotation_rad
        context.found("placement", goal, goal.end_s, name, text, value=angle, limit=limit, unit="rad")
