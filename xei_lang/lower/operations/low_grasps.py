"""Grasps low on a vessel's body, level or nearly, that leave the other hand room on its cap."""

from __future__ import annotations

import math

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolPose
from xei_lang.ir.geometry import Box, Cylinder, Pose
from xei_lang.lower.hand import drop_m, hand_of, tool_axes
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.caps import Cap
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import reach_direction
from xei_lang.quantity.lengths import mm

_ELEVATIONS_DEG = (0.0, 8.0, 15.0)
_ASIDE_DEG = (0.0, 12.0, -12.0, 24.0, -24.0)
"""Headings, from the way between shoulder and vessel."""
_HALF_HAND_M = 0.031
_HALF_JAW_M = 0.013
_APART_M = 0.004


def low_grasps(work: Work, cap: Cap, T_base_stood: Pose, depth_m: float) -> tuple[ToolPose, ...]:
    """Hands low on the vessel: elevation x heading x height x roll. Refuses a vessel that has no room for
    both hands (XEI0704).
    """
    reach = reach_direction(work.profile, work.arm, T_base_stood)
    ahead = math.atan2(reach[1], reach[0]) - yaw_of(T_base_stood)
    found: list[ToolPose] = []
    clear_m = work.profile.calibration.clearance_m + 0.001
    highest = _highest(work, cap, depth_m)
    for elevation in _ELEVATIONS_DEG:
        for turned in (True, False):
            lowest = clear_m + drop_m(math.radians(elevation), turned)
            for height in _between(lowest, highest):
                for aside in _ASIDE_DEG:
                    heading = ahead + math.radians(aside)
                    level = (math.cos(heading), math.sin(heading), 0.0)
                    x, y, z = tool_axes(level, math.radians(elevation), turned)
                    words = f"{elevation:g} deg down, {aside:g} deg aside, {height * 1000:.1f} mm high"
                    cost = 0.02 * elevation / 8.0 + 0.1 * abs(aside) / 24.0 + (0.0 if turned else 0.05)
                    name = f"low on the body, {words}{', rolled' if turned else ''}"
                    found.append(ToolPose(name, Pose.from_axes((0.0, 0.0, height), x, y, z), round(cost, 6)))
    if not found:
        refuse(
            "XEI0704",
            f"no grasp of `{cap.vessel.name}` leaves room for a hand on its cap",
            work.span,
            f"both hands need {mm(clear_m + drop_m(0.0, True))} under the grasp, which may be at"
            f" {mm(max(0.0, highest))} at most",
            (Label(cap.vessel.span, "its shape is stated here"),),
        )
    return tuple(sorted(found, key=lambda member: (member.cost, member.name)))


def _highest(work: Work, cap: Cap, depth_m: float) -> float:
    """How high the grasp may be: under the other hand's fingertips, and on the body's full width."""
    cap_m = cap.T_vessel_seat.position_m[2] + cap.known.size_m[2] - depth_m
    under_cap = cap_m - hand_of(work.profile).fingertip_m - _APART_M - _HALF_HAND_M
    wide_m = cap.vessel.size_m[0]
    tops = [
        part.T_object_shape.position_m[2] + _height(part.shape) / 2
        for part in cap.vessel.geometry
        if _width(part.shape) >= wide_m - 1e-6
    ]
    return min(under_cap, max(tops, default=cap.vessel.size_m[2]) - _HALF_JAW_M)


def _height(shape: object) -> float:
    return (
        shape.size_m[2] if isinstance(shape, Box) else shape.height_m if isinstance(shape, Cylinder) else 0.0
    )


def _width(shape: object) -> float:
    return (
        shape.size_m[0]
        if isinstance(shape, Box)
        else 2 * shape.radius_m
        if isinstance(shape, Cylinder)
        else 0.0
    )


def _between(lowest: float, highest: float) -> tuple[float, ...]:
    """Heights to try, in tenths of a millimetre."""
    room = highest - lowest
    if room < 0.0:
        return ()
    count = 1 if room < 0.004 else 3
    return tuple(math.floor((highest - room * k / max(1, count - 1)) * 10_000) / 10_000 for k in range(count))


def yaw_of(pose: Pose) -> float:
    """The heading of a pose's x axis about z, rad in -pi .. pi."""
    x, y, _ = pose.axes()[0]
    return math.atan2(y, x)
