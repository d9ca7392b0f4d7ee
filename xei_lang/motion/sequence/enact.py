"""A candidate carried out: the motions of its chain after the free move, each with the scene that it happens
in.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, MoveTo
from xei_lang.ir.timed import Placement
from xei_lang.motion.paths.joint_path import JointPath, line_path, spline_path
from xei_lang.motion.paths.tool_path import ToolPath
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.legs import JUMP_RAD, tool_path
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.poses import pose_of
from xei_lang.motion.sequence.postures import carried
from xei_lang.motion.sequence.sections import Chain
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Held, Ride, Snapshot

Array = NDArray[np.float64]

STEP_M = 0.01
STEP_RAD = math.radians(4.0)
DEVIATION_M = 0.0005
DEVIATION_RAD = 0.002
"""How far the tool may be from its way between two samples of it."""


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

    None where the tool's way leads out of the arm's limits.
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
    path = tool_way(context, layer, index, target)
    if path is None:
        return None
    after = before.moved(context.lift(before.q, chain.arm, layer.q[index, target + 1]))
    return Motion(
        goal, before, after, path, "spline",
        speed_fraction=move.speed_fraction, arm=chain.arm, choice=told,
    )  # fmt: skip


def tool_way(context: Context, layer: Layer, index: int, target: int) -> JointPath | None:
    """The tool's way from one target to the next, straight or as stated, at constant slide and branch.

    The samples are drawn closer until the tool keeps within `DEVIATION_M` and `DEVIATION_RAD` of the way
    between them too.
    """
    chain, member = layer.chain, int(layer.member[index])
    way = tool_path(chain.legs[target], layer.poses[target, member], layer.poses[target + 1, member])
    for closer in (1.0, 0.5, 0.25):
        path = _joint_path(context, layer, index, target, way.shares(closer * STEP_M, closer * STEP_RAD), way)
        if path is None or isinstance(path, JointPath):
            return path
    return None


def _joint_path(
    context: Context, layer: Layer, index: int, target: int, share: Array, way: ToolPath
) -> JointPath | Literal["coarse"] | None:
    """The spline through the way's samples; None where the arm leaves its limits or its wrist flips."""
    chain = layer.chain
    swivel = layer.swivel_angle[index, target] * (1.0 - share) + layer.swivel_angle[index, target + 1] * share
    q, valid = carried(
        context.solvers[chain.arm], way.poses(share)[None], layer.q[index, :1, 0],
        swivel[None], layer.branch[index : index + 1],
    )  # fmt: skip
    arm = q[0, :, 1:]
    if not valid.all() or np.abs(np.diff(arm, axis=0)).max() > JUMP_RAD:
        return None
    path = spline_path(context.robot.arm(chain.arm).joint_names, arm)
    return path if _keeps_way(context, layer, index, path, share, way) else "coarse"


def _keeps_way(
    context: Context, layer: Layer, index: int, path: JointPath, share: Array, way: ToolPath
) -> bool:
    """Whether the tool is on its way half way between the samples as well."""
    if len(path.breaks) != len(share):
        return True
    frame = context.robot.arm(layer.chain.arm).tool_frame
    wanted = way.poses((share[:-1] + share[1:]) / 2)
    q = np.zeros((len(wanted), 8))
    q[:, 0] = layer.q[index, 0, 0]
    q[:, 1:] = path.evaluate((path.breaks[:-1] + path.breaks[1:]) / 2, 0)
    rest = np.zeros(context.robot.nq)
    for T_wanted, row in zip(wanted, context.lift(rest, layer.chain.arm, q), strict=True):
        T_found = context.robot.T_base_frame(row, frame)
        if float(np.linalg.norm(T_found[:3, 3] - T_wanted[:3, 3])) > DEVIATION_M:
            return False
        if float(np.linalg.norm(T_found[:3, :3] - T_wanted[:3, :3])) > math.sqrt(2.0) * DEVIATION_RAD:
            return False
    return True


def _hand_action(
    context: Context, layer: Layer, index: int, target: int, goal: MotionGoal, before: Snapshot, told: str
) -> Motion:
    chain, action = layer.chain, goal.action
    member = int(layer.member[index])
    if isinstance(action, Grip):
        return grip(context, goal, action, before)
    if isinstance(action, Attach):
        held = take(context, chain, action, target, member, before)
        after = before.attached(action.arm, held)
        return Motion(goal, before, after, arm=action.arm, choice=told)
    if isinstance(action, Detach):
        T_base_object = pose_of(layer.poses[target, member]) @ before.held[action.arm].T_tool_object
        return replace(leave(context, goal, action, T_base_object, before), choice=told)
    return still(goal, before)


def leave(
    context: Context, goal: MotionGoal, action: Detach, T_base_object: Pose, before: Snapshot
) -> Motion:
    """A hand lets go of its object at a pose in the base frame, and of what rides on it."""
    after = left(context, action, T_base_object, before)
    riders = before.riders(action.object)
    placed = (
        Placement(action.object, T_base_object),
        *(Placement(rider, T_base_object @ T_object_rider) for rider, T_object_rider in riders),
    )
    return Motion(goal, before, after, arm=action.arm, placed=placed)


def left(context: Context, action: Detach, T_base_object: Pose, before: Snapshot) -> Snapshot:
    """The state after a hand has let go, what it let go of fastened where the action says so."""
    if not action.fastened_to:
        return before.detached(action.arm, T_base_object)
    T_base_carrier = where(context, action.fastened_to, before)
    there = T_base_carrier.inverse() @ T_base_object if T_base_carrier else seat(context, action)
    return before.detached(action.arm, T_base_object, Ride(action.fastened_to, there))


def still(goal: MotionGoal, before: Snapshot, duration_s: float | None = None) -> Motion:
    """A goal that moves nothing: it takes its stated time."""
    return Motion(goal, before, before, duration_s=goal.min_duration_s if duration_s is None else duration_s)


def take(context: Context, chain: Chain, action: Attach, target: int, member: int, before: Snapshot) -> Held:
    """The grasp of an object by a member, where the family's reference stands at the chain's target."""
    T_base_reference = chain.targets[target].T_base_reference
    T_base_object = where(context, action.object, before) or T_base_reference
    return Held(action.object, chain.family, member, T_base_reference.inverse() @ T_base_object)


def seat(context: Context, action: Detach) -> Pose:
    """Where a rider sits on what it is fastened to, screwed on to its end, as the profile says: for a carrier
    in a hand of which is not known yet where it is.
    """
    rider, carrier = (context.profile.object(name) for name in (action.object, action.fastened_to))
    if rider is None or rider.thread is None or carrier is None:
        return Pose()
    key = rider.thread.on_key
    return next((spot.T_object_spot for spot in carrier.spots if spot.name == key), Pose())


def where(context: Context, name: str, before: Snapshot) -> Pose | None:
    """Where an object is in the base frame; None in a hand by a grasp that is not chosen yet."""
    giver = next(iter(before.holders(name)), None)
    if giver is None and name not in before.standing and name in before.riding:
        ride = before.riding[name]
        T_base_carrier = where(context, ride.carrier, before)
        return None if T_base_carrier is None else T_base_carrier @ ride.T_carrier_rider
    if giver is None:
        return before.T_base_object(name)
    if before.held[giver].member == UNCHOSEN:
        return None
    T_base_tool = context.robot.T_base_frame(before.q, context.robot.arm(giver).tool_frame)
    return pose_of(T_base_tool) @ before.held[giver].T_tool_object


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
