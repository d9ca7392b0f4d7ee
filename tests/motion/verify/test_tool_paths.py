"""The verifier finds plans whose tool leaves its stated path, stops short of its end or hurries."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.motion.sequence.bench import SRDF, URDF
from tests.motion.stated_paths import Planned, checked, pour, screw, wipe
from tests.motion.verify.fault_paths import bump, faster, middle_time, resampled
from tests.motion.verify.maker import evaluate
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoalGraph, MoveTo
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.tool_paths import Raster, ToolPath, Turn
from xei_lang.motion.robot import load_robot
from xei_lang.motion.verify.robot import turn as turns
from xei_lang.motion.verify.tool_paths import _followed, _twist, raster_points

ROBOT = load_robot(URDF, SRDF)


def kinds(graph: MotionGoalGraph, timed) -> set[str]:
    return {finding.kind for finding in checked(graph, timed).findings}


def middle(made: Planned, goal: TimedGoal) -> np.ndarray:
    """Where the tool is half way along a goal (pinocchio's kinematics); other joints as the plan starts."""
    assert goal.knots is not None
    assert goal.arm is not None
    q = np.zeros(ROBOT.nq)
    for earlier in made.timed.goals[: [item.id for item in made.timed.goals].index(goal.id)]:
        for joint, value in zip(
            earlier.joints, earlier.samples.positions[-1] if earlier.samples else (), strict=True
        ):
            q[ROBOT.joint_names.index(joint)] = value
    row = evaluate(goal.knots, middle_time(goal.knots))[0]
    q[[ROBOT.joint_names.index(joint) for joint in goal.joints]] = row
    return ROBOT.T_base_frame(q, ROBOT.arm(goal.arm).tool_frame)[:3, 3]


@pytest.mark.parametrize(("made", "path"), [(pour, "arc"), (lambda: screw(180.0), "screw"), (wipe, "raster")])
def test_a_path_that_is_off_by_three_millimetres_is_found(made, path: str) -> None:
    _, goal = made().stated(path)
    assert goal.knots is not None
    height, here = 0.002, middle(made(), goal)
    while True:
        changed = resampled(goal, bump(goal.knots, 3, height))
        if math.dist(here, middle(made(), changed)) >= 0.003:
            break
        height *= 1.2
    assert height < 0.2
    assert "tool_path" in kinds(made().graph, made().with_goal(changed))


def test_a_tool_that_hurries_is_found() -> None:
    made = pour()
    _, goal = made.stated("arc")
    assert goal.knots is not None
    assert "tool_speed" in kinds(made.graph, made.with_goal(resampled(goal, faster(goal.knots, 1.1))))


def restated(made: Planned, path: str, along: ToolPath) -> MotionGoalGraph:
    """The graph with another path for a goal, its target as it was."""
    goal, _ = made.stated(path)
    assert isinstance(goal.action, MoveTo)
    changed = replace(goal, action=replace(goal.action, along=along))
    return replace(made.graph, goals=tuple(changed if item is goal else item for item in made.graph.goals))


def test_a_plan_for_another_path_to_the_same_end_is_found() -> None:
    made = pour()
    goal, _ = made.stated("arc")
    assert isinstance(goal.action, MoveTo)
    arc = goal.action.along
    assert isinstance(arc, Turn)
    x, y, z = arc.point_m
    for other in (
        replace(arc, point_m=(x, y, z + 0.003)),
        replace(arc, angle_rad=arc.angle_rad * 1.02),
        replace(arc, angle_rad=arc.angle_rad - math.tau),
        replace(arc, lead_m=0.02),
    ):
        assert "tool_path" in kinds(restated(made, "arc", other), made.timed)


def test_a_lane_that_is_left_out_is_found() -> None:
    made = wipe()
    goal, _ = made.stated("raster")
    assert isinstance(goal.action, MoveTo)
    raster = goal.action.along
    assert isinstance(raster, Raster)
    finer = replace(raster, pitch_m=raster.lane_distance_m / 2)
    assert finer.lanes == 2 * raster.lanes - 1
    assert "tool_path" in kinds(restated(made, "raster", finer), made.timed)


angles = st.floats(-math.pi, math.pi)


@given(angles, angles, st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=5))
def test_the_twist_of_a_turn_is_its_angle(roll: float, pitch: float, wanted: list[float]) -> None:
    axis = np.array(Pose.from_rpy((0.0, 0.0, 0.0), (roll, pitch, 0.0)).axes()[2])
    assert np.allclose(_twist(turns(axis, np.array(wanted)), axis), wanted, atol=1e-9)


def test_a_place_is_followed_along_a_raster_and_never_taken_for_the_next_lane() -> None:
    points = raster_points(Raster((0.1, 0.2, 0.3), (0.1, 0.0, 0.0), (0.0, 0.06, 0.0), 0.02))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.max() == pytest.approx(0.0005, rel=0.01)
    reached, off = _followed(points, points[::3] + np.array([0.0, 0.0, 0.0004]))
    assert np.allclose(off, 0.0004)
    assert reached.tolist() == list(range(0, len(points), 3))
    assert math.dist(points[-1], (0.1, 0.26, 0.3)) < 1e-9
