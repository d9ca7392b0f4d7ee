"""Poses in the words of people: millimetres and degrees, rounded, without negative zeros."""

from __future__ import annotations

import math

from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import PoseIn
from xei_lang.quantity.lengths import millimetres


def pose_text(pose: Pose) -> str:
    """`(560, 45, 755) mm`, with `yaw -90 deg` where it is turned about z, or all of roll, pitch and yaw."""
    place = f"({', '.join(millimetres(value) for value in pose.position_m)}) mm"
    roll, pitch, yaw = (round(math.degrees(angle), 2) + 0.0 for angle in _rpy(pose))
    if roll or pitch:
        return f"{place} rpy ({roll:g}, {pitch:g}, {yaw:g}) deg"
    return f"{place} yaw {yaw:g} deg" if yaw else place


def written_pose(pose: PoseIn) -> str:
    """A pose as a protocol writes it, without rotations of zero."""
    turns = zip(("roll", "pitch", "yaw"), pose.rotation, strict=True)
    parts = [
        *(f"{name}={part}" for name, part in zip("xyz", pose.position, strict=True)),
        *(f"{name}={part}" for name, part in turns if part.magnitude),
        f'frame="{pose.frame}"',
    ]
    return f"pose({', '.join(parts)})"


def _rpy(pose: Pose) -> tuple[float, float, float]:
    """Fixed-axis roll, pitch, yaw (rad); at pitch +-90 deg the roll is taken as 0."""
    x, y, z = pose.axes()
    pitch = math.asin(max(-1.0, min(1.0, -x[2])))
    if abs(x[2]) > 1.0 - 1e-9:
        return 0.0, pitch, math.atan2(-y[0], y[1])
    return math.atan2(y[2], z[2]), pitch, math.atan2(x[1], x[0])
