"""Faults of where motion ends and how it gets there: wrong goals and crooked lines."""

from __future__ import annotations

import math

import numpy as np

from tests.motion.verify.fault_bench import Bench, Fault
from tests.motion.verify.fault_paths import bump, middle_time, ramp, resampled
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Grip, JointTarget, MoveTo, SlideMove


def wrong_goal(bench: Bench) -> Fault | None:
    """The last joint value is off by more than the tolerance; for a tool, a scan over all members and turns
    of the reference (half a degree apart) finds none within one and a half tolerances of position or
    rotation."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    column = bench.random.randrange(len(goal.joints))
    shift = 10 ** bench.random.uniform(-2.2, -0.7) * bench.random.choice([1, -1])
    action = bench.planned(goal).action
    if not isinstance(action, MoveTo):
        shift = bench.random.uniform(0.0015, 0.02) * bench.random.choice([1, -1])
    changed = resampled(goal, ramp(goal.knots, column, shift))
    plan = bench.with_goal(changed)
    if isinstance(action, MoveTo) and isinstance(action.target, JointTarget):
        if goal.joints[column] not in dict(action.target.joints):
            return None
    elif isinstance(action, MoveTo) and isinstance(action.target, ToolTarget):
        link = dict(bench.robot.tool_links)[action.arm or "right"]
        tool = bench.arm.tool(bench.joints_at(changed.end_s, plan), link)
        if not _misses(bench, action.target, tool):
            return None
    elif not isinstance(action, Grip | SlideMove):
        return None
    return bench.fault("wrong goal", "wrong_goal", plan)


def _misses(bench: Bench, target: ToolTarget, tool: Pose) -> bool:
    family = bench.graph.family(target.family)
    turns = 720 if family.symmetric and target.turn_reference else 1
    for member in family.members:
        for k in range(turns):
            turn = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 2 * math.pi * k / turns))
            wanted = Pose(target.offset_base_m) @ target.T_base_reference @ turn
            wanted = wanted @ member.T_reference_tool @ Pose(target.offset_tool_m)
            off = wanted.inverse() @ tool
            angle = 2 * math.acos(min(1.0, off.quaternion[3]))
            far = math.dist((0.0, 0.0, 0.0), off.position_m) > 1.5 * target.position_tolerance_m
            if not far and angle < 1.5 * target.rotation_tolerance_rad:
                return False
    return True


def crooked_line(bench: Bench) -> Fault | None:
    """A bump moves the tool, half way, more than 2.5 mm from the line between its ends (pinocchio's
    kinematics)."""
    lines = [
        goal
        for goal in bench.moving
        if isinstance(action := bench.planned(goal).action, MoveTo) and action.path == "linear"
    ]
    if not lines:
        return None
    goal = bench.random.choice(lines)
    assert goal.knots is not None
    column, height = bench.random.randrange(len(goal.joints)), bench.random.uniform(0.01, 0.08)
    changed = resampled(goal, bump(goal.knots, column, height))
    plan = bench.with_goal(changed)
    action = bench.planned(goal).action
    assert isinstance(action, MoveTo)
    link = dict(bench.robot.tool_links)[action.arm or "right"]
    middle = goal.start_s + middle_time(goal.knots)
    a, b, m = (
        np.array(bench.arm.tool(bench.joints_at(t, plan), link).position_m)
        for t in (goal.start_s, changed.end_s, middle)
    )
    along = (b - a) / np.linalg.norm(b - a)
    if np.linalg.norm((m - a) - ((m - a) @ along) * along) < 2.5e-3:
        return None
    return bench.fault("crooked line", "linear_path", plan)
