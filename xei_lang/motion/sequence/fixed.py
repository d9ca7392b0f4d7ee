"""Goals that leave nothing to choose: named configurations, slide moves, grips, drives, waits and signals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import (
    Detach,
    Grip,
    JointTarget,
    MotionGoal,
    MoveTo,
    NavToPose,
    Perceive,
    SlideMove,
    Wait,
)
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.both_arms import plan_joints
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import grip, leave, still, where
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.snapshot import Snapshot

PERCEIVE_S = 1.0
"""Nominal time to ground a frame again: the schedule must hold a place for it; the run waits for the real
one.
"""


def plan_fixed(context: Context, goal: MotionGoal, before: Snapshot) -> Motion | PathBlocked:
    """The motion of a goal that is not part of a chain, or what stands in its way."""
    action = goal.action
    if isinstance(action, MoveTo) and isinstance(action.target, JointTarget):
        return _to_joints(context, goal, action.target, before, action.speed_fraction)
    if isinstance(action, SlideMove):
        target = JointTarget("slide", ((context.slide_joint, action.height_m),))
        return _to_joints(context, goal, target, before, 1.0)
    if isinstance(action, Grip):
        return grip(context, goal, action, before)
    if isinstance(action, Detach):
        return let_go(context, goal, action, before)
    if isinstance(action, NavToPose):
        after = replace(before, T_world_base=action.T_world_base)
        straight_s = _drive_s(context, before.T_world_base, action.T_world_base)
        # A way by the map is never shorter than the straight one; lowering states its time.
        return Motion(goal, before, after, duration_s=max(straight_s, goal.min_duration_s))
    return still(goal, before, _still_s(goal))


def let_go(context: Context, goal: MotionGoal, action: Detach, before: Snapshot) -> Motion:
    """A hand leaves its object to the other hand, where it is."""
    T_base_object = where(context, action.object, before) or action.T_base_object
    return leave(context, goal, action, T_base_object, before)


def _still_s(goal: MotionGoal) -> float:
    if isinstance(goal.action, Wait):
        return goal.action.duration_s
    return max(PERCEIVE_S, goal.min_duration_s) if isinstance(goal.action, Perceive) else goal.min_duration_s


def _to_joints(
    context: Context, goal: MotionGoal, target: JointTarget, before: Snapshot, speed_fraction: float
) -> Motion | PathBlocked:
    names = context.robot.joint_names
    joints = tuple(joint for joint, _ in sorted(target.joints, key=lambda row: names.index(row[0])))
    wanted = dict(target.joints)
    indices = [names.index(joint) for joint in joints]
    q_goal = np.array([wanted[joint] for joint in joints])
    found = plan_joints(context, before, joints, q_goal, goal.allowed_contacts, context.goal_seed(goal.id))
    if isinstance(found, PathBlocked):
        return found
    q = before.q.copy()
    q[indices] = q_goal
    return Motion(goal, before, before.moved(q), found.path, found.planner, speed_fraction=speed_fraction)


def _drive_s(context: Context, T_from: Pose, T_to: Pose) -> float:
    """Straight drive at the base's speed and a turn in place at its turning rate, one after the other,
    seconds.
    """
    way = T_from.inverse() @ T_to
    distance = math.hypot(way.position_m[0], way.position_m[1])
    turn = 2.0 * math.atan2(abs(way.quaternion[2]), way.quaternion[3])
    calibration = context.profile.calibration
    return distance / calibration.base_speed_m_s + turn / calibration.base_turn_rad_s
