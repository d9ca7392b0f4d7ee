"""Whether jaws touch what they take: with a gap beside it, it would stay where it is."""

from __future__ import annotations

from xei_lang.ir.goals import Attach
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.bodies import Bodies
from xei_lang.motion.verify.context import Context


def check_grips(context: Context) -> None:
    """At each attach, every finger of that hand is at the object, or pressed into its outline."""
    taken = [
        (goal, planned.action)
        for goal in context.plan.goals
        if (planned := context.planned(goal)) is not None and isinstance(planned.action, Attach)
    ]
    if not taken:
        return
    bodies = Bodies(context.robot, context.about, context.world)
    for goal, action in taken:
        # What the world does not have, or without a shape, is told by others.
        if action.object in bodies.bodies:
            _check_touch(context, bodies, goal, action)


def _check_touch(context: Context, bodies: Bodies, goal: TimedGoal, action: Attach) -> None:
    moment, limit = context.timeline.starts[goal.id], context.options.grip_m
    pairs = [(finger, action.object) for finger in _fingers(context, action) if finger in bodies.bodies]
    for pair in pairs:
        bodies.add_pair(pair)
    bodies.arrange(moment.scene)
    bodies.move(moment.q)
    gaps = [min(map(bodies.distance, bodies.shape_pairs(pair))) for pair in pairs]
    widest = max(gaps, default=0.0)
    if widest > limit:
        text = f"the {action.arm} jaws do not touch `{action.object}` when they take it"
        context.found("grip", goal, goal.start_s, action.object, text, value=widest, limit=limit, unit="m")


def _fingers(context: Context, action: Attach) -> tuple[str, ...]:
    joints = next((joints for side, joints in context.about.finger_joints if side == action.arm), ())
    return tuple(context.robot.joints[joint].child for joint in joints if joint in context.robot.joints)
