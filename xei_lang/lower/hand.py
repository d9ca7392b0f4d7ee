"""The gripper as lowering sees it: how far it opens, and how much room hand and fingers take around the
grasp frame.

The grasp frame lies on the jaws' mid-plane, 80 mm in front of the hand's frame: z approaches, y opens. The
boxes are those of the robot description (`profiles/openarm_bench/robot/figures.yaml`, hand and fingers)
moved into that frame. They serve to leave out grasps that cannot work; whether one is free of collision is
decided by motion planning on the real geometry.
"""

from __future__ import annotations

import math

from xei_lang.ir.geometry import Vec3
from xei_lang.ir.skill_plan import Side
from xei_lang.profiles.model import Profile
from xei_lang.record import Record, record

_TRAVEL_M = 0.044
_FINGERTIP_M = 0.0155
_PALM_M = 0.0689

SIDES: tuple[Side, ...] = ("left", "right")


@record
class Extent(Record):
    """An axis-aligned box in the grasp frame, metres; the opening direction is left out (the jaws may stand
    anywhere).
    """

    lower: tuple[float, float]
    upper: tuple[float, float]


# x and z of each slice of a finger, and of the hand's body: (x, z) lower, (x, z) upper.
_EXTENTS = (
    Extent((-0.0305, -0.0795), (0.0306, -0.0525)),
    Extent((-0.0250, -0.0525), (0.0250, -0.0370)),
    Extent((-0.0230, -0.0370), (0.0230, -0.0230)),
    Extent((-0.0170, -0.0230), (0.0180, -0.0090)),
    Extent((-0.0150, -0.0090), (0.0150, 0.0010)),
    Extent((-0.0132, 0.0010), (0.0130, _FINGERTIP_M)),
    Extent((-0.0290, -0.0860), (0.0291, -_PALM_M)),
)


@record
class Hand(Record):
    """What a gripper can take: the widest gap between its jaws, the reach of its fingertips past the grasp
    point, and the room between grasp point and palm. Metres.
    """

    max_gap_m: float
    fingertip_m: float = _FINGERTIP_M
    palm_m: float = _PALM_M


def hand_of(profile: Profile) -> Hand:
    """The gripper of this robot; its gap is twice the finger travel that the robot's description allows."""
    joints = (profile.robot.joint(f"openarm_{side}_finger_joint1") for side in SIDES)
    return Hand(2 * min((joint.upper for joint in joints if joint), default=_TRAVEL_M))


def drop_m(elevation_rad: float, turned: bool) -> float:
    """How far hand and fingers reach below the grasp point, metres.

    The tool comes `elevation_rad` down from level with its jaws opening level; `turned` is the other roll
    (by 180 deg). The support function of the boxes along the downward axis, which in the grasp frame is
    `(x, z) = (-+cos, sin)`.
    """
    sign = 1.0 if turned else -1.0
    down_x, down_z = sign * math.cos(elevation_rad), math.sin(elevation_rad)
    return max(
        max(down_x * box.lower[0], down_x * box.upper[0]) + max(down_z * box.lower[1], down_z * box.upper[1])
        for box in _EXTENTS
    )


def hand_bodies(side: Side) -> tuple[str, ...]:
    """The bodies of a hand that what it holds may touch, by their link names."""
    return (f"openarm_{side}_hand", f"openarm_{side}_left_finger", f"openarm_{side}_right_finger")


def fingers(side: Side) -> tuple[str, ...]:
    """The fingers of a hand, by their link names."""
    return hand_bodies(side)[1:]


def tool_axes(heading: Vec3, elevation_rad: float, turned: bool) -> tuple[Vec3, Vec3, Vec3]:
    """The columns x, y, z of a tool that heads along the level unit vector `heading`, tilted down by the
    elevation.

    y (the opening) stays level; `turned` rolls the tool by 180 deg about its approach.
    """
    hx, hy, _ = heading
    c, s = math.cos(elevation_rad), math.sin(elevation_rad)
    z = (c * hx, c * hy, -s)
    sign = -1.0 if turned else 1.0
    y = (-sign * hy, sign * hx, 0.0)
    x = (y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0])
    return x, y, z
