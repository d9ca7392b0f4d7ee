from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.motion.kinematics import Solver, arm_solver
from xei_lang.motion.kinematics.geometry import srs_geometry
from xei_lang.motion.robot import SIDES, Array, Robot, Side, load_robot

Fraction = st.floats(0.0, 1.0, allow_nan=False)
fractions = st.lists(Fraction, min_size=8, max_size=8)


@pytest.fixture(scope="module")
def solvers(robot: Robot) -> dict[Side, Solver]:
    return {side: arm_solver(robot, side) for side in SIDES}


def configuration(robot: Robot, side: Side, values: list[float]) -> Array:
    """A configuration in limits; `values` in 0 .. 1 place slide and arm between them."""
    q = np.zeros(robot.nq)
    columns = [robot.slide_index, *robot.arm(side).q_indices]
    q[columns] = robot.lower[columns] + np.array(values) * (robot.upper[columns] - robot.lower[columns])
    return np.clip(q, robot.lower, robot.upper)


def pose_of(robot: Robot, side: Side, q: Array, q_arm: Array) -> Array:
    full = q.copy()
    full[robot.arm(side).span] = q_arm
    return robot.T_base_frame(full, robot.arm(side).tool_frame)


def test_every_pose_in_reach_is_solved_exactly_and_within_limits(
    robot: Robot, solvers: dict[Side, Solver]
) -> None:
    @settings(max_examples=150, deadline=None)
    @given(side=st.sampled_from(SIDES), values=fractions)
    def holds(side: Side, values: list[float]) -> None:
        q = configuration(robot, side, values)
        span = robot.arm(side).span
        T = pose_of(robot, side, q, q[span])
        found = solvers[side].solve(T, q[0])
        inside = min(values) > 1e-6 and max(values) < 1 - 1e-6
        assert len(found) > 0 or not inside, "a pose exactly at limits may have a single configuration"
        assert np.all(found.q >= robot.lower[span])
        assert np.all(found.q <= robot.upper[span])
        for row, angle, branch in zip(found.q, found.swivel_angle, found.branch, strict=True):
            assert np.abs(pose_of(robot, side, q, row) - T).max() < 1e-9
            again = solvers[side].at(T, q[0], float(angle), int(branch))
            assert again is not None
            assert np.abs(pose_of(robot, side, q, again) - T).max() < 1e-9

    holds()


def test_a_configuration_comes_back_from_its_own_swivel_and_branch(
    robot: Robot, solvers: dict[Side, Solver]
) -> None:
    @settings(max_examples=150, deadline=None)
    @given(side=st.sampled_from(SIDES), values=fractions)
    def holds(side: Side, values: list[float]) -> None:
        q = configuration(robot, side, [0.001 + 0.998 * value for value in values])
        q_arm = q[robot.arm(side).span]
        T = pose_of(robot, side, q, q_arm)
        angle, branch = solvers[side].describe(q_arm)
        back = solvers[side].at(T, q[0], angle, branch)
        assert back is not None
        assert np.abs(pose_of(robot, side, q, back) - T).max() < 1e-9
        geometry = srs_geometry(robot, side)
        assert geometry is not None
        if abs(np.sin(q_arm[1] + geometry.shoulder_joint.offset)) > 1e-3:
            assert np.abs(back - q_arm).max() < 1e-6

    holds()


def test_a_thousand_reachable_poses_are_all_solved(robot: Robot, solvers: dict[Side, Solver]) -> None:
    rng = np.random.default_rng(7)
    for side in SIDES:
        q = rng.uniform(robot.lower, robot.upper, (500, robot.nq))
        poses = np.array([robot.T_base_frame(row, robot.arm(side).tool_frame) for row in q])
        found = solvers[side].solve_many(poses, q[:, robot.slide_index])
        assert [len(each) > 0 for each in found] == [True] * 500
        assert 19 <= np.mean([len(each) for each in found]) <= 25


def test_many_poses_give_what_single_poses_give(robot: Robot, solvers: dict[Side, Solver]) -> None:
    rng = np.random.default_rng(8)
    q = rng.uniform(robot.lower, robot.upper, (20, robot.nq))
    poses = np.array([robot.T_base_frame(row, "openarm_left_grasp") for row in q])
    for row, pose, many in zip(q, poses, solvers["left"].solve_many(poses, q[:, 0]), strict=True):
        single = solvers["left"].solve(pose, row[0])
        assert single.q == pytest.approx(many.q, abs=1e-9)
        assert list(single.branch) == list(many.branch)


def test_a_feasible_sliver_is_found(robot: Robot, solvers: dict[Side, Solver]) -> None:
    """With the third joint at its limit to a millionth, the feasible swivel may be as thin: it must not be
    missed.
    """
    rng = np.random.default_rng(9)
    arm = robot.arm("right")
    lower, upper = robot.lower[arm.span], robot.upper[arm.span]
    for corner in range(200):
        q_arm = rng.uniform(lower, upper)
        at_limit = rng.permutation(7)[:3]
        q_arm[at_limit] = np.where(rng.random(3) < 0.5, lower[at_limit] + 1e-7, upper[at_limit] - 1e-7)
        T = pose_of(robot, "right", np.zeros(robot.nq), q_arm)
        assert len(solvers["right"].solve(T, 0.0)) > 0, (corner, q_arm)


def test_following_a_line_at_constant_swivel_is_continuous(robot: Robot, solvers: dict[Side, Solver]) -> None:
    q = robot.configuration("home")
    q[list(robot.arm("right").q_indices)] = [0.3, 0.9, 0.3, 1.4, 0.2, 0.1, 0.1]
    start = robot.T_base_frame(q, "openarm_right_grasp")
    angle, branch = solvers["right"].describe(q[robot.arm("right").span])
    poses = np.repeat(start[None], 101, axis=0)
    poses[:, :3, 3] += np.linspace(0.0, 0.08, 101)[:, None] * np.array([-0.6, 0.0, -0.8])
    rows, valid = solvers["right"].at_many(poses, 0.0, angle, branch)
    assert valid.all()
    assert np.abs(np.diff(rows, axis=0)).max() < 0.02
    assert rows[0] == pytest.approx(q[robot.arm("right").span], abs=1e-9)


def test_the_straight_arm_is_solved(robot: Robot, solvers: dict[Side, Solver]) -> None:
    q = robot.configuration("home")
    for side in SIDES:
        T = robot.T_base_frame(q, robot.arm(side).tool_frame)
        found = solvers[side].solve(T, 0.0)
        assert len(found) > 0
        assert np.abs(found.q[:, 3]).max() < 1e-6


@pytest.mark.parametrize("side", SIDES)
def test_a_shoulder_with_its_outer_axes_in_line_is_solved_up_to_its_limits(
    robot: Robot, solvers: dict[Side, Solver], side: Side
) -> None:
    """Only the sum of joints 1 and 3 is fixed there: it must be shared so that both stay within limits."""
    geometry = srs_geometry(robot, side)
    assert geometry is not None
    q = robot.configuration("home")
    span = robot.arm(side).span
    for first, third in ((0.01, 0.01), (0.99, 0.5), (0.99, 0.99), (0.01, 0.99), (0.5, 0.5)):
        shares = np.array([first, 0.5, third, 0.5, 0.5, 0.5, 0.5])
        q_arm = robot.lower[span] + shares * (robot.upper - robot.lower)[span]
        q_arm[1] = -geometry.shoulder_joint.offset
        T = pose_of(robot, side, q, q_arm)
        back = solvers[side].at(T, 0.0, *solvers[side].describe(q_arm))
        assert back is not None
        assert np.abs(pose_of(robot, side, q, back) - T).max() < 1e-9


def test_out_of_reach_has_no_configuration_and_tells_by_how_much(
    robot: Robot, solvers: dict[Side, Solver]
) -> None:
    q = robot.configuration("home")
    T = robot.T_base_frame(q, "openarm_left_grasp")
    T[2, 3] -= 0.25
    assert len(solvers["left"].solve(T, 0.0)) == 0
    assert solvers["left"].at(T, 0.0, 0.0, 0) is None
    assert solvers["left"].reach_shortfall(T, 0.0) == pytest.approx(0.25, abs=1e-5)
    T[2, 3] += 0.3
    assert solvers["left"].reach_shortfall(T, 0.0) == 0.0


def test_the_slide_moves_the_solutions_along(robot: Robot, solvers: dict[Side, Solver]) -> None:
    q = robot.configuration("ready")
    T = robot.T_base_frame(q, "openarm_left_grasp")
    low = solvers["left"].solve(T, 0.0)
    T[2, 3] += 0.25
    assert solvers["left"].solve(T, 0.25).q == pytest.approx(low.q, abs=1e-9)


@pytest.fixture(scope="module")
def crooked(urdf_text: str, srdf_text: str) -> Robot:
    """The robot with the right wrist's sixth axis 10 mm beside the others: no longer S-R-S."""
    start = urdf_text.index('<joint name="openarm_right_joint6"')
    moved = urdf_text[start:].replace('xyz="0.0375 0 0.1205"', 'xyz="0.0375 0 0.1205" ', 1)
    moved = moved.replace('xyz="0.0375 0 0.1205" ', 'xyz="0.0375 0.01 0.1205"', 1)
    assert moved != urdf_text[start:]
    return load_robot(urdf_text[:start] + moved, srdf_text)


def test_the_solver_says_its_name(solvers: dict[Side, Solver], crooked: Robot) -> None:
    assert [solvers[side].name for side in SIDES] == ["srs-closed-form"] * 2
    assert [arm_solver(crooked, side).name for side in SIDES] == ["srs-closed-form", "numerical-lm"]


def test_an_arm_that_is_not_srs_is_solved_numerically(crooked: Robot) -> None:
    solver = arm_solver(crooked, "right")
    span = crooked.arm("right").span
    rng = np.random.default_rng(4)
    for _ in range(5):
        q = rng.uniform(crooked.lower, crooked.upper)
        T = pose_of(crooked, "right", q, q[span])
        found = solver.solve(T, q[0])
        assert len(found) > 0
        for row in found.q:
            assert np.abs(pose_of(crooked, "right", q, row) - T).max() < 1e-9
            assert np.all(row >= crooked.lower[span])
            assert np.all(row <= crooked.upper[span])
        angle, branch = solver.describe(q[span])
        again = solver.at(T, q[0], angle, branch)
        assert again is not None
        assert solver.describe(again)[0] == pytest.approx(angle)


def test_the_numerical_solver_follows_a_line(crooked: Robot) -> None:
    solver = arm_solver(crooked, "right")
    q = crooked.configuration("home")
    span = crooked.arm("right").span
    q[span] = [0.3, 0.9, 0.3, 1.4, 0.2, 0.1, 0.1]
    poses = np.repeat(pose_of(crooked, "right", q, q[span])[None], 11, axis=0)
    poses[:, 2, 3] -= np.linspace(0.0, 0.05, 11)
    rows, valid = solver.at_many(poses, 0.0, *solver.describe(q[span]))
    assert valid.all()
    assert np.abs(np.diff(rows, axis=0)).max() < 0.1
    far = poses[0].copy()
    far[0, 3] += 1.0
    assert solver.reach_shortfall(far, 0.0) > 0.5
