"""Grasps low on a vessel's body, level or nearly, that leave the other hand room on its cap."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import attrgetter, itemgetter

from xei_lang.diagnostics import Label
from xei_lang.ir.families import Members, Point, Turned
from xei_lang.ir.geometry import Box, Cylinder, Pose, Vec3
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
_ORIGIN = (0.0, 0.0, 0.0)


def low_grasps(work: Work, cap: Cap, T_base_stood: Pose, depth_m: float) -> Members:
    """Hands low on the vessel: elevation x heading x height x roll. Refuses a vessel that has no room for
    both hands (XEI0704).
    """
    reach = reach_direction(work.profile, work.arm, T_base_stood)
    ahead = math.atan2(reach[1], reach[0]) - yaw_of(T_base_stood)
    clear_m = work.profile.calibration.clearance_m + 0.001
    highest = _highest(work, cap, depth_m)
    levels = {aside: _level(ahead + math.radians(aside)) for aside in _ASIDE_DEG}
    found: list[tuple[float, Turned, Point]] = []
    for tilt in _TILTS:
        rolls = [
            (turned, _points(clear_m + tilt.drops_m[turned], highest, turned)) for turned in (False, True)
        ]
        for way in tilt.ways:
            for turned, points in rolls:
                if points:
                    axes = tool_axes(levels[way.aside_deg], tilt.elevation_rad, turned)
                    orientation = (way.words, Pose.from_axes(_ORIGIN, *axes).quaternion)
                    cost = way.costs[turned]
                    found += [(cost, orientation, point) for point in points]
    if not found:
        refuse(
            "XEI0704",
            f"no grasp of `{cap.vessel.name}` leaves room for a hand on its cap",
            work.span,
            f"both hands need {mm(clear_m + drop_m(0.0, True))} under the grasp, which may be at"
            f" {mm(max(0.0, highest))} at most",
            (Label(cap.vessel.span, "its shape is stated here"),),
        )
    # They were made in the order of their names, in which those of one cost stay.
    found.sort(key=itemgetter(0))
    return Members(found)


@dataclass(frozen=True, slots=True)
class _Way:
    """A heading from the way between shoulder and vessel, its words, and its costs unrolled and rolled."""

    aside_deg: float
    words: str
    costs: tuple[float, float]


@dataclass(frozen=True, slots=True)
class _Tilt:
    """An elevation: how far the hand reaches below the grasp point (m), unrolled and rolled, and the ways to
    come in the order of their words.
    """

    elevation_rad: float
    drops_m: tuple[float, float]
    ways: tuple[_Way, ...]


def _tilt(elevation_deg: float) -> _Tilt:
    elevation = math.radians(elevation_deg)
    ways = sorted((_way(elevation_deg, aside) for aside in _ASIDE_DEG), key=attrgetter("words"))
    return _Tilt(elevation, (drop_m(elevation, False), drop_m(elevation, True)), tuple(ways))


def _way(elevation_deg: float, aside_deg: float) -> _Way:
    cost = 0.02 * elevation_deg / 8.0 + 0.1 * abs(aside_deg) / 24.0
    words = f"low on the body, {elevation_deg:g} deg down, {aside_deg:g} deg aside"
    return _Way(aside_deg, words, (round(cost + 0.05, 6), round(cost, 6)))


_TILTS = tuple(sorted(map(_tilt, _ELEVATIONS_DEG), key=lambda tilt: tilt.ways[0].words))


def _level(heading_rad: float) -> Vec3:
    return (math.cos(heading_rad), math.sin(heading_rad), 0.0)


def _points(lowest: float, highest: float, rolled: bool) -> list[Point]:
    """Grasp points on the axis, in the order of their words."""
    words = "mm high, rolled" if rolled else "mm high"
    return sorted(
        (f", {height * 1000:.1f} {words}", (0.0, 0.0, height)) for height in _between(lowest, highest)
    )


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
