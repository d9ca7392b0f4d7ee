"""Motions put on a clock one after another: TOPP-RA for every path, and samples of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoal, MoveTo
from xei_lang.ir.timed import Knots, Samples, TimedGoal
from xei_lang.motion.robot import Robot
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.poses import pose_of
from xei_lang.motion.timing.samples import sample
from xei_lang.motion.timing.topp import InverseDynamics, PathSpeed, TimingFailure, parameterise

Array = NDArray[np.float64]

RATE_HZ = 100.0


@dataclass(frozen=True, slots=True)
class Untimed:
    """A motion that no speed makes feasible."""

    goal: MotionGoal
    failure: TimingFailure


def time_motion(context: Context, motion: Motion, start_s: float) -> TimedGoal | Untimed:
    """The goal with its trajectory from `start_s` on, in seconds."""
    knots: Knots | None = None
    samples: Samples | None = None
    duration_s = motion.duration_s
    joints = () if motion.path is None else motion.path.joints
    if motion.path is not None:
        torques = inverse_dynamics(context, motion)
        limits, fastest = context.limits_of(joints), tool_bound(context, motion)
        found = parameterise(motion.path, limits, torques, motion.speed_fraction, fastest)
        if isinstance(found, TimingFailure):
            return Untimed(motion.goal, found)
        knots = found
        samples = sample(knots, start_s, RATE_HZ)
        duration_s = knots.times_s[-1]
    goal = motion.goal
    return TimedGoal(
        id=goal.id,
        step_id=goal.step_id,
        kind=goal.kind,
        resource=goal.resources[0] if goal.resources else "",
        resources=goal.resources,
        epoch=goal.epoch,
        start_s=start_s,
        end_s=start_s + duration_s,
        joints=joints,
        samples=samples,
        knots=knots,
        attached=motion.before.attachments(context.robot),
        allowed_contacts=goal.allowed_contacts,
        placed=motion.placed,
        arm=motion.arm,
        tool=_tool(context.robot, motion),
        choice=motion.choice,
        planner=motion.planner,
    )


def _tool(robot: Robot, motion: Motion) -> Pose | None:
    if motion.arm is None:
        return None
    return pose_of(robot.T_base_frame(motion.after.q, robot.arm(motion.arm).tool_frame))


def loaded_robot(context: Context, motion: Motion) -> Robot:
    """The robot with the mass of what its hands carry while the motion runs."""
    robot = context.robot
    for carried in motion.before.carried():
        item = context.world.find(carried.object)
        if item is not None and item.mass_kg > 0.0:
            middle = (0.0, 0.0, item.size_m[2] / 2)
            robot = robot.with_payload(carried.side, item.mass_kg, carried.T_tool_object.apply(middle))
    return robot


def tool_bound(context: Context, motion: Motion) -> PathSpeed | None:
    """The path speeds at which the tool moves and turns as fast as its goal allows; None without bounds."""
    action, path = motion.goal.action, motion.path
    if not isinstance(action, MoveTo) or path is None or motion.arm is None:
        return None
    bounds = (action.tool_speed_m_s, action.tool_turn_rad_s)
    if bounds == (None, None):
        return None
    limits = [math.inf if bound is None else bound for bound in bounds]
    frame = context.robot.arm(motion.arm).tool_frame
    columns = [context.robot.joint_names.index(joint) for joint in path.joints]

    def fastest(s: Array) -> Array:
        whole = np.tile(motion.before.q, (len(s), 1))
        whole[:, columns] = path.evaluate(s, 0)
        jacobians = np.stack([context.robot.jacobian(q, frame)[:, columns] for q in whole])
        twist = np.einsum("mij,mj->mi", jacobians, path.evaluate(s, 1))
        rates = (np.linalg.norm(twist[:, :3], axis=1), np.linalg.norm(twist[:, 3:], axis=1))
        return np.minimum(
            *(limit / np.maximum(rate, 1e-9) for limit, rate in zip(limits, rates, strict=True))
        )

    return fastest


def inverse_dynamics(context: Context, motion: Motion) -> InverseDynamics:
    """Torques of the path's joints, every other joint at rest where it stands."""
    robot = loaded_robot(context, motion)
    joints = () if motion.path is None else motion.path.joints
    columns = [robot.joint_names.index(joint) for joint in joints]
    rest = motion.before.q

    def torques(q: Array, dq: Array, ddq: Array) -> Array:
        whole = np.tile(rest, (len(q), 1))
        speed, acceleration = np.zeros_like(whole), np.zeros_like(whole)
        whole[:, columns], speed[:, columns], acceleration[:, columns] = q, dq, ddq
        return robot.torques(whole, speed, acceleration)[:, columns]

    return torques
