"""The orientations in which a hand may come to an object, as a table: they depend on no object.

A way is an elevation of the approach, a heading about the object's z axis and a roll by 180 deg. Whatever of
it takes trigonometry or text is made here, once, because a family is made for every object that is grasped
and has up to a few hundred members.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from xei_lang.ir.families import Turned
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.lower.hand import drop_m, tool_axes

ELEVATIONS_DEG = (0.0, 30.0, 45.0, 60.0, 90.0)
_STEEP_COSTS = {60.0: 0.1, 90.0: 0.4}

APPROACHES: Mapping[str, tuple[float, ...]] = MappingProxyType(
    {"top": (60.0, 90.0), "oblique": (30.0, 45.0, 60.0), "side": (0.0, 30.0)}
)
"""The elevations that `approach` leaves, by its words."""

ROUND_RAD = tuple(2 * math.pi * k / 12 for k in range(12))
"""Headings to a round shape."""
FACES_X_RAD = (0.0, math.pi)
FACES_Y_RAD = (math.pi / 2, -math.pi / 2)
"""Headings along the x and the y axis of a box: the jaws close on the other pair of faces."""


@dataclass(frozen=True, slots=True)
class Roll:
    """One elevation with one roll: how far the hand reaches below the grasp point (m), and the ways by
    heading.
    """

    drop_m: float
    ways: tuple[Turned, ...]


@dataclass(frozen=True, slots=True)
class Tilt:
    """One elevation of the approach, with sine and cosine of its angle and what it costs, and its rolls."""

    elevation_deg: float
    down: float
    level: float
    cost: float
    rolls: tuple[Roll, ...]


@dataclass(frozen=True, slots=True)
class Ways:
    """All ways of a set of headings. `headings` are level unit vectors in the object's frame.

    Tilts, the rolls of a tilt and headings come in the alphabetical order of the ways' words.
    """

    headings: tuple[Vec3, ...]
    tilts: tuple[Tilt, ...]


def _words(elevation_deg: float, heading_rad: float, turned: bool) -> str:
    kind = {0.0: "from the side", 90.0: "straight down"}.get(elevation_deg, f"{elevation_deg:g} deg down")
    azimuth = math.degrees(heading_rad) % 360.0
    return f"{kind}, azimuth {azimuth:g} deg{', rolled' if turned else ''}"


def _level(heading_rad: float) -> Vec3:
    return (math.cos(heading_rad), math.sin(heading_rad), 0.0)


def _roll(elevation_deg: float, headings_rad: list[float], turned: bool) -> Roll:
    elevation = math.radians(elevation_deg)
    ways: list[Turned] = []
    for heading in headings_rad:
        pose = Pose.from_axes((0.0, 0.0, 0.0), *tool_axes(_level(heading), elevation, turned))
        ways.append((_words(elevation_deg, heading, turned), pose.quaternion))
    return Roll(drop_m(elevation, turned), tuple(ways))


def _tilt(elevation_deg: float, headings_rad: list[float]) -> Tilt:
    # Straight down, a roll is a heading.
    turns = (False,) if elevation_deg == 90.0 else (False, True)
    elevation = math.radians(elevation_deg)
    return Tilt(
        elevation_deg,
        math.sin(elevation),
        math.cos(elevation),
        _STEEP_COSTS.get(elevation_deg, 0.0),
        tuple(_roll(elevation_deg, headings_rad, turned) for turned in turns),
    )


def _ways(headings_rad: tuple[float, ...]) -> Ways:
    elevations = sorted(ELEVATIONS_DEG, key=lambda elevation: _words(elevation, 0.0, False))
    headings = sorted(headings_rad, key=lambda heading: _words(0.0, heading, False))
    return Ways(
        tuple(_level(heading) for heading in headings),
        tuple(_tilt(elevation, headings) for elevation in elevations),
    )


WAYS: Mapping[tuple[float, ...], Ways] = {
    headings_rad: _ways(headings_rad) for headings_rad in (ROUND_RAD, FACES_X_RAD, FACES_Y_RAD)
}
"""By set of headings (rad)."""
