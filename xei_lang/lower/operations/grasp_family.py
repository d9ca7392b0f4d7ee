"""The family of grasps of a shape: every way in which the jaws may close on it that is not hopeless from
the start.

Members are (elevation of the approach) x (heading about the object's z axis) x (roll by 180 deg) x (height
on the object). The jaws close across the object's axis, which lies on their mid-plane. Left out is what
cannot work on any posture: jaws too narrow, hand or fingers below the plane that the object stands out of,
the object in the palm, an approach that comes from behind the object towards the robot.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Shape, Sphere
from xei_lang.ir.goals import ToolPose
from xei_lang.lower.hand import Hand, drop_m, tool_axes
from xei_lang.lower.operations.approach import standoff_needed_m

ELEVATIONS_DEG = (0.0, 30.0, 45.0, 60.0, 90.0)
MIN_CLEARANCE_M = 0.001
_HEADINGS = 12
_TOP_MARGIN_M = 0.013
_BEHIND = -0.5
_STEEP_DEG = 60.0
_UPWARD = 0.05


@dataclass(frozen=True, slots=True)
class Closing:
    """One way to close: the width between the jaws, half the depth across them, and the headings (rad) it
    allows.
    """

    width_m: float
    half_depth_m: float
    headings_rad: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Request:
    """What a family is made for.

    `floor_m` is the plane, in the object's frame, below which neither hand nor fingers may reach; `reach`
    is the level unit direction (x, y) in the base frame from the arm's shoulder to the object. `depth_m`
    fixes the grasp point under the top, else heights are sampled. `standoff_m` is the longest way back that
    a member may need.
    """

    height_m: float
    closing: Closing
    floor_m: float
    hand: Hand
    T_base_object: Pose
    reach: tuple[float, float]
    clearance_m: float
    elevations_deg: tuple[float, ...] = ELEVATIONS_DEG
    depth_m: float | None = None
    standoff_m: float = math.inf


def closings(shape: Shape) -> tuple[Closing, ...]:
    """The ways to close on a shape whose axis is z: any heading on a round one, two pairs of faces on a
    box.
    """
    if isinstance(shape, Box):
        x, y, _ = shape.size_m
        return (
            Closing(y, x / 2, (0.0, math.pi)),
            Closing(x, y / 2, (math.pi / 2, -math.pi / 2)),
        )
    headings = tuple(2 * math.pi * k / _HEADINGS for k in range(_HEADINGS))
    return (Closing(2 * shape.radius_m, shape.radius_m, headings),)


def height_of(shape: Shape) -> float:
    """Height of a shape from its bottom to its top, metres."""
    if isinstance(shape, Box):
        return shape.size_m[2]
    if isinstance(shape, Sphere):
        return 2 * shape.radius_m
    return shape.height_m + (2 * shape.radius_m if isinstance(shape, Capsule) else 0.0)


def is_round(shape: Shape) -> bool:
    """Whether the shape may be turned about its z axis without any difference."""
    return isinstance(shape, (Cylinder, Sphere, Capsule))


def members(request: Request) -> tuple[ToolPose, ...]:
    """All members, cheapest first; empty where nothing is left."""
    found: list[ToolPose] = []
    for elevation in request.elevations_deg:
        rolls = (False,) if elevation == 90.0 else (False, True)
        heights = [(turned, _heights(request, math.radians(elevation), turned)) for turned in rolls]
        if not any(possible for _, possible in heights):
            continue
        for heading in request.closing.headings_rad:
            if not _hopeless(request, elevation, heading):
                for turned, possible in heights:
                    found.extend(_at_heights(request, elevation, heading, turned, possible))
    return tuple(sorted(found, key=lambda member: (member.cost, member.name)))


def _hopeless(request: Request, elevation: float, heading: float) -> bool:
    """Whether the approach points up, or comes back towards the robot from behind the object without being
    steep.
    """
    z = tool_axes(_level(heading), math.radians(elevation), False)[2]
    if request.T_base_object.rotate(z)[2] > _UPWARD:
        return True
    return elevation < _STEEP_DEG and _alignment(request, heading) < _BEHIND


def _alignment(request: Request, heading: float) -> float:
    """Cosine between the heading and the way from shoulder to object, in the base frame."""
    x, y, _ = request.T_base_object.rotate(_level(heading))
    return x * request.reach[0] + y * request.reach[1]


def _heights(request: Request, elevation_rad: float, turned: bool) -> tuple[float, ...]:
    """Heights of the grasp point above the object's bottom that keep floor, palm and standoff; highest
    first.
    """
    height, half = request.height_m, request.closing.half_depth_m
    floor = request.floor_m + request.clearance_m + drop_m(elevation_rad, turned)
    lowest = max(floor, height - _deepest(request, elevation_rad))
    highest = height - min(_TOP_MARGIN_M, height / 5)
    if request.depth_m is not None:
        wanted = height - request.depth_m
        heights: tuple[float, ...] = (wanted,) if lowest <= wanted <= height else ()
    elif lowest > highest:
        return ()
    else:
        room = highest - lowest
        count = 1 if room < 0.008 else 2 if room < 0.025 else 3
        heights = tuple(highest - room * k / max(1, count - 1) for k in range(count))
    rounded = (math.ceil(value * 10_000 - 1e-6) / 10_000 for value in heights)
    return tuple(
        value
        for value in rounded
        if standoff_needed_m(height - value, half, elevation_rad, request.hand) <= request.standoff_m + 1e-9
    )


def _deepest(request: Request, elevation_rad: float) -> float:
    """How far under the top the grasp point may lie before the object meets the palm."""
    side = request.closing.half_depth_m * math.cos(elevation_rad)
    room = request.hand.palm_m - request.clearance_m - side
    if room < 0.0:
        return -math.inf
    down = math.sin(elevation_rad)
    return math.inf if down < 1e-9 else room / down


def _at_heights(
    request: Request, elevation: float, heading: float, turned: bool, heights: tuple[float, ...]
) -> Iterator[ToolPose]:
    """The members that differ in nothing but their height on the object."""
    x, y, z = tool_axes(_level(heading), math.radians(elevation), turned)
    quaternion = Pose.from_axes((0.0, 0.0, 0.0), x, y, z).quaternion
    kind = {0.0: "from the side", 90.0: "straight down"}.get(elevation, f"{elevation:g} deg down")
    azimuth = math.degrees(heading) % 360.0
    way = f"{kind}, azimuth {azimuth:g} deg{', rolled' if turned else ''}"
    # Side and oblique grasps first, heading away from the robot; a straight one heads nowhere. About 0 .. 1.
    steep = {60.0: 0.1, 90.0: 0.4}.get(elevation, 0.0)
    turned_away = 0.0 if elevation == 90.0 else 0.2 * (1.0 - _alignment(request, heading))
    for height in heights:
        depth_mm = (request.height_m - height) * 1000
        cost = round(steep + turned_away + 0.1 * (1.0 - height / request.height_m), 6)
        pose = Pose((0.0, 0.0, height), quaternion)
        yield ToolPose(f"{way}, {depth_mm:.1f} mm under the top", pose, cost)


def _level(heading: float) -> tuple[float, float, float]:
    return (math.cos(heading), math.sin(heading), 0.0)
