"""What the verifier is given besides the plan: the robot's description and how much error it forgives."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.skill_plan import Side


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """The robot as text: URDF (rooted at the base, primitive collision shapes) and SRDF (disabled pairs).

    `tool_links` name the link whose frame is the tool of each arm; `slide_joint` is the joint of
    `slide_move`, `finger_joints` the joints whose travels add up to the gap between the jaws of each arm.
    """

    urdf_text: str
    srdf_text: str
    tool_links: tuple[tuple[Side, str], ...] = (
        ("left", "openarm_left_grasp"),
        ("right", "openarm_right_grasp"),
    )
    finger_joints: tuple[tuple[Side, tuple[str, ...]], ...] = (
        ("left", ("openarm_left_finger_joint1", "openarm_left_finger_joint2")),
        ("right", ("openarm_right_finger_joint1", "openarm_right_finger_joint2")),
    )
    slide_joint: str = "slide_joint"


@dataclass(frozen=True, slots=True)
class VerifyOptions:
    """Tolerances of the verifier. Ratios multiply a limit; the rest is in SI units.

    `position_tolerance` (rad, m) forgives rounding; `joint_tolerance` and `opening_tolerance_m` say when a
    joint target and a gap are met; `held_*` and `placed_*` bound how far an object's pose may be from what
    the plan says of it (two tool tolerances: that of the grasp and that of the place). Jaws are at
    most `grip_m` from what they take, as wide as a gap may be off. What goes into an
    opening keeps `opening_margin_m` from its wall, and may lie on its mouth and its bottom within
    `opening_skin_m`. With `upright_tilt_rad`, goals that keep upright are held to it.
    """

    rate_hz: float = 1000.0
    position_tolerance: float = 1e-6
    jump_position: float = 1e-5
    jump_velocity: float = 2e-3
    velocity_ratio: float = 1.001
    acceleration_ratio: float = 1.002
    torque_ratio: float = 1.005
    joint_tolerance: float = 1e-3
    opening_tolerance_m: float = 1e-3
    slide_tolerance_m: float = 5e-4
    linear_tolerance_m: float = 2e-3
    tool_path_m: float = 1e-3
    tool_path_rad: float = 5e-3
    tool_speed_ratio: float = 1.01
    held_position_m: float = 2e-3
    held_rotation_rad: float = 0.02
    placed_position_m: float = 2e-3
    placed_rotation_rad: float = 0.02
    stated_tool_m: float = 5e-4
    stated_tool_rad: float = 5e-3
    sample_position: float = 1e-5
    sample_velocity: float = 1e-3
    sample_acceleration: float = 2e-2
    time_tolerance_s: float = 1e-6
    grip_m: float = 1e-3
    contact_m: float = 0.0
    opening_margin_m: float = 1e-4
    opening_skin_m: float = 2e-4
    upright_tilt_rad: float | None = None
