from __future__ import annotations

import numpy as np
import pytest

from xei_lang.motion.robot import SIDES, Robot, Side, load_robot


def test_q_holds_the_slide_then_the_arms_with_their_fingers(robot: Robot) -> None:
    assert robot.nq == 19
    assert robot.joint_names[robot.slide_index] == "slide_joint"
    for side in SIDES:
        arm = robot.arm(side)
        assert [robot.joint_names[k] for k in arm.q_indices] == [
            f"openarm_{side}_joint{i}" for i in range(1, 8)
        ]
        assert [robot.joint_names[k] for k in arm.finger_indices] == [
            f"openarm_{side}_finger_joint{i}" for i in (1, 2)
        ]
        assert list(range(robot.nq))[arm.span] == list(arm.q_indices)


def test_the_slide_lifts_the_shoulders_from_092_to_152_m(robot: Robot) -> None:
    heights = [
        robot.T_base_frame(robot.configuration(state), "openarm_left_link2")[2, 3]
        for state in ("low", "high")
    ]
    assert heights == pytest.approx([0.918, 1.518], abs=1e-5)
    assert robot.slide_axis == (0.0, 0.0, 1.0)


@pytest.mark.parametrize("side", SIDES)
def test_the_grasp_frame_lies_midway_between_the_jaws(robot: Robot, side: Side) -> None:
    q = robot.with_opening(robot.configuration("ready"), side, 0.05)
    T_base_grasp = robot.T_base_frame(q, f"openarm_{side}_grasp")
    jaws = [robot.T_base_frame(q, f"openarm_{side}_{finger}_finger")[:3, 3] for finger in SIDES]
    in_grasp = [T_base_grasp[:3, :3].T @ (jaw - T_base_grasp[:3, 3]) for jaw in jaws]
    assert in_grasp[0][1] == pytest.approx(-in_grasp[1][1])
    assert in_grasp[0][1] - in_grasp[1][1] == pytest.approx(0.05 + 0.012)


def test_named_configurations_stay_within_limits_and_build_on_another(robot: Robot) -> None:
    for name in robot.states:
        assert robot.in_limits(robot.configuration(name)), name
    q = robot.configuration("open", onto=robot.configuration("ready"))
    assert q[list(robot.arm("left").q_indices)] == pytest.approx(
        robot.configuration("ready")[robot.arm("left").span]
    )
    assert q[robot.arm("left").finger_indices[1]] == 0.044 == robot.max_opening_m("left") / 2


def test_the_jacobian_predicts_a_small_motion(robot: Robot) -> None:
    rng = np.random.default_rng(3)
    q, dq = rng.uniform(robot.lower, robot.upper), rng.normal(size=robot.nq) * 1e-6
    moved = (
        robot.T_base_frame(q + dq, "openarm_left_grasp")[:3, 3]
        - robot.T_base_frame(q, "openarm_left_grasp")[:3, 3]
    )
    assert moved == pytest.approx((robot.jacobian(q, "openarm_left_grasp") @ dq)[:3], abs=1e-10)


def test_a_payload_adds_its_weight_times_the_lever(robot: Robot) -> None:
    q = robot.configuration("ready")[None]
    still = np.zeros_like(q)
    added = robot.with_payload("left", 0.5, (0.0, 0.0, 0.02)).torques(q, still, still) - robot.torques(
        q, still, still
    )
    T = robot.T_base_frame(q[0], "openarm_left_grasp")
    J = robot.jacobian(q[0], "openarm_left_grasp")
    lever = np.array([0.0, 0.0, 0.5 * 9.81])
    moment = np.cross(T[:3, :3] @ [0.0, 0.0, 0.02], lever)
    assert added[0] == pytest.approx(J.T @ np.concatenate([lever, moment]), abs=1e-9)
    assert added[0, robot.slide_index] == pytest.approx(0.5 * 9.81)


def test_the_motors_hold_the_ready_pose_with_one_kilogram_in_each_hand(robot: Robot) -> None:
    loaded = robot.with_payload("left", 1.0, (0.0, 0.0, 0.0)).with_payload("right", 1.0, (0.0, 0.0, 0.0))
    q = robot.configuration("ready")[None]
    assert np.all(np.abs(loaded.torques(q, 0 * q, 0 * q)) < robot.rated_effort)


def test_torques_of_no_rows_are_no_rows(robot: Robot) -> None:
    nothing = np.zeros((0, robot.nq))
    assert robot.torques(nothing, nothing, nothing).shape == (0, robot.nq)


def test_a_description_without_slide_is_refused(urdf_text: str, srdf_text: str) -> None:
    with pytest.raises(ValueError, match="slide"):
        load_robot(urdf_text, srdf_text.replace('<group name="slide">', '<group name="lift">'))


def test_an_unknown_frame_is_a_key_error(robot: Robot) -> None:
    with pytest.raises(KeyError):
        robot.T_base_frame(robot.configuration("home"), "no_such_frame")
