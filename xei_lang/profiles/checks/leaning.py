"""Objects that lean, lie or stand on their head: how that is said, and of which it is worth saying.

An object's frame is at its bottom, z up as it is used: grasps, places and what a vessel holds go by that.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Profile

TILT_RAD = math.radians(10.0)
"""What leans by less is taken to stand upright."""


def lean_rad(T_frame_object: Pose) -> float:
    """The angle between an object's z axis and that of the frame (rad, 0 .. pi)."""
    return math.acos(max(-1.0, min(1.0, T_frame_object.axes()[2][2])))


def leans(T_frame_object: Pose) -> bool:
    """Whether an object is turned by more than eyes are off."""
    return lean_rad(T_frame_object) > TILT_RAD


def lean_text(T_frame_object: Pose) -> str:
    """`is upside down`, `lies on its side` or `leans by 45 deg`."""
    degrees = math.degrees(lean_rad(T_frame_object))
    if degrees > 170.0:
        return "is upside down"
    return "lies on its side" if 80.0 < degrees < 100.0 else f"leans by {degrees:.0f} deg"


def turned_text(T_frame_object: Pose) -> str:
    """How it is turned, for those who mistook the order of a quaternion's numbers."""
    numbers = ", ".join(f"{round(value, 4) + 0.0:g}" for value in T_frame_object.quaternion)
    degrees = math.degrees(lean_rad(T_frame_object))
    return f"its z axis is {degrees:.0f} deg off the vertical: x, y, z, w is {numbers}"


def check_leaning(profile: Profile) -> Iterator[Diagnostic]:
    """Open vessels whose priors have them lean: nothing would stay in them."""
    for item in profile.objects:
        prior = item.prior
        if item.liquid is None or prior is None or prior.in_object or not leans(prior.T_frame_object):
            continue
        yield Diagnostic(
            "XEI0659",
            f"`{item.name}` {lean_text(prior.T_frame_object)}",
            prior.span,
            label="its prior turns it so",
            notes=(turned_text(prior.T_frame_object), "a vessel that does not stand holds nothing"),
            help=("correct `rpy`, which is roll, pitch and yaw about fixed axes",),
        )
