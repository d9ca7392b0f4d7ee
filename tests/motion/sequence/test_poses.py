"""Tool poses: members that are turns of each other."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.motion.sequence.poses import matrix, orbits, pose_of, same_grasp, tool_poses

angles = st.floats(-math.pi, math.pi)


def family(*poses: Pose) -> Family:
    return Family("f", "tube", tuple(ToolPose(str(k), pose) for k, pose in enumerate(poses)), symmetric=True)


@given(angles, angles, angles, angles, st.floats(0.001, 0.2))
def test_a_turn_about_z_stays_in_its_orbit_and_a_lift_does_not(
    roll: float, pitch: float, yaw: float, turn: float, lift_m: float
) -> None:
    pose = Pose.from_rpy((0.01, 0.02, 0.1), (roll, pitch, yaw))
    turned = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, turn)) @ pose
    lifted = Pose((0.0, 0.0, lift_m)) @ pose
    orbit = orbits(family(pose, turned, lifted))
    assert orbit[0] == orbit[1] != orbit[2]
    assert same_grasp(family(pose, turned, lifted), 0, turned=True).tolist() == [True, True, False]
    assert same_grasp(family(pose, turned, lifted), 0, turned=False).tolist() == [True, False, False]


def test_offsets_are_taken_in_base_and_in_tool() -> None:
    down = Pose.from_rpy((0.0, 0.0, 0.05), (math.pi, 0.0, 0.0))
    target = ToolTarget(
        "f", Pose((0.4, 0.1, 0.7)), offset_base_m=(0.0, 0.0, 0.1), offset_tool_m=(0.0, 0.0, -0.08)
    )
    assert np.allclose(tool_poses(target, family(down))[0][:3, 3], [0.4, 0.1, 0.7 + 0.05 + 0.1 + 0.08])


@given(angles, angles, angles)
def test_a_pose_survives_its_matrix(roll: float, pitch: float, yaw: float) -> None:
    pose = Pose.from_rpy((0.1, -0.2, 0.3), (roll, pitch, yaw))
    assert np.allclose(matrix(pose_of(matrix(pose))), matrix(pose), atol=1e-12)
