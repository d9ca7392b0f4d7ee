"""A candidate carried out: the motions of its chain after the free move, each with the scene that it happens
in.
"""

from __future__ import annotations

import math
from dataclasses import replace

from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, MoveTo
from xei_lang.ir.timed import Placement
from xei_lang.motion.paths.joint_path import JointPath, line_path, spline_path
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.layers import Layer, carried
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.poses import interpolate, pose_of
from xei_lang.motion.sequence.sections import Chain
from xei_lang.motion.sequence.snapshot import Held, Snapshot

STEP_M = 0.01
STEP_RAD = math.radians(4.0)


def grip(context: Context, goal: MotionGoal, action: Grip, before: Snapshot) -> Motion:
    """The jaws brought to another gap: the first finger's trajectory, the second mimics it."""
    robot = context.robot
    opening = min(max(action.opening_m, 0.0), robot.max_opening_m(action.arm))
    after = before.moved(robot.with_opening(before.q, action.arm, opening))
    index = robot.arm(action.arm).finger_indices[0]
    path = line_path((robot.joint_names[index],), before.q[[index]], after.q[[index]])
    return Motion(goal, before, after, path, "line", arm=action.arm)


def carry_out(context: Context, layer: Layer, index: int, start: Snapshot) -> tuple[Motion, ...] | None:
    """The motions of the chain's goals after the first, from the first target's configuration in `start`.

    None where a straight line leaves the arm's limits on its way.
    """
    chain, now, target = layer.chain, start, 0
    told = choice_name(layer, index, start)
    motions: list[Motion] = []
    for goal in chain.goals[1:]:
        if isinstance(goal.action, MoveTo):
            motion = _straight(context, layer, index, target, goal, now, told)
            target += 1
        else:
            motion = _hand_action(context, layer, index, target, goal, now, told)
        if motion is None:
            return None
        motions.append(motion)
        now = motion.after
    return tuple(motions)


def _straight(
    context: Context, layer: Layer, index: int, target: int, goal: MotionGoal, before: Snapshot, told: str
) -> Motion | None:
    chain, move = layer.chain, goal.action
    assert isinstance(move, MoveTo)
    path = straight_path(context, layer, index, target)
    if path is None:
        return None
    after = before.moved(context.lift(before.q, chain.arm, layer.q[index, target + 1]))
    return Motion(
        goal, before, after, path, "spline",
        speed_fraction=move.speed_fraction, arm=chain.arm, choice=told,
    )  # fmt: skip


def straight_path(context: Context, layer: Layer, index: int, target: int) -> JointPath | None:
    """The tool's straight line from one target to the next, at constant slide, swivel and branch."""
    chain, member = layer.chain, int(layer.member[index])
    poses = interpolate(layer.poses[target, member], layer.poses[target + 1, member], STEP_M, STEP_RAD)
    q, valid = carried(
        context.solvers[chain.arm], poses[None], layer.q[index, :1, 0],
        layer.swivel_angle[index : index + 1], layer.branch[index : index + 1],
    )  # fmt: skip
    if not valid.all():
        return None
    return spline_path(context.robot.arm(chain.arm).joint_names, q[0, :, 1:])


def _hand_action(
    context: Context, layer: Layer, index: int, target: int, goal: MotionGoal, before: Snapshot, told: str
) -> Motion:
    chain, action = layer.chain, goal.action
    member = int(layer.member[index])
    if isinstance(action, Grip):
        return grip(context, goal, action, before)
    if isinstance(action, Attach):
        held = take(chain, action, target, member, before)
        after = before.attached(action.arm, held)
        return Motion(goal, before, after, arm=action.arm, choice=told)
    if isinstance(action, Detach):
        held = before.held[action.arm]
        T_base_object = pose_of(layer.poses[target, member]) @ held.T_tool_object
        after = before.detached(action.arm, T_base_object)
        placed = (Placement(held.object, T_base_object),)
        return Motion(goal, before, after, arm=action.arm, placed=placed, choice=told)
    return still(goal, before)


def still(goal: MotionGoal, before: Snapshot, duration_s: float | None = None) -> Motion:
    """A goal that moves nothing: it takes its stated time."""
    return Motion(goal, before, before, duration_s=goal.min_duration_s if duration_s is None else duration_s)


def take(chain: Chain, action: Attach, target: int, member: int, before: Snapshot) -> Held:
    """The grasp of an object by a member, where the family's reference stands at the chain's target."""
    T_reference_base = chain.targets[target].T_base_reference.inverse()
    return Held(action.object, chain.family, member, T_reference_base @ before.T_base_object(action.object))


def as_held(chain: Chain, snapshot: Snapshot, member: int) -> Snapshot:
    """The snapshot with the arm's object held by the member that is shown: what a turn of a round object
    amounts to.
    """
    held = snapshot.held.get(chain.arm)
    if held is None or held.member == member:
        return snapshot
    return snapshot.attached(chain.arm, replace(held, member=member))


def choice_name(layer: Layer, index: int, snapshot: Snapshot) -> str:
    """The member that was chosen: the one that the hand holds by, or else the candidate's own."""
    held = snapshot.held.get(layer.chain.arm)
    member = int(layer.member[index]) if held is None else held.member
    return layer.chain.family.members[member].name
