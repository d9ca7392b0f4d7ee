"""The family of grasps of a shape: every way in which the jaws may close on it that is not hopeless from
the start.

Members are (elevation of the approach) x (heading about the object's z axis) x (roll by 180 deg) x (height
on the object). The jaws close across the object's axis, which lies on their mid-plane. Left out is what
cannot work on any posture: jaws too narrow, hand or fingers below the plane that the object stands out of,
the object in the palm, an approach that comes from behind the object towards the robot.
"""

from __future__ import annotations

import math
from operator import itemgetter

from xei_lang.ir.families import Members, Point, Turned
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.lower.hand import Hand
from xei_lang.lower.operations.approach import standoff_needed_m
from xei_lang.lower.operations.closing import Closing
from xei_lang.lower.operations.grasp_ways import ELEVATIONS_DEG, WAYS, Tilt
from xei_lang.record import Record, record

_TOP_MARGIN_M = 0.013
"""How far the highest grasp point lies under the top, on objects that are tall enough."""
_STEEP_DEG = 60.0
_BEHIND = -0.5
"""The least cosine between heading and reach of an approach that is not steep: others come from behind."""
_UPWARD = 0.05
"""The most that an approach may point up, as the z of its unit vector in the base frame."""

_BACK_COST = 0.2
"""For each unit that a heading's cosine lacks to straight away from the robot."""
_LOW_COST = 0.1
"""Of a grasp at the very bottom; at the top it is 0."""


@record
class Request(Record):
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


@record
class Grasps(Record):
    """The members of a family, and the way back along the approach (m) that takes the fingertips of each of
    them clear of the object.
    """

    members: Members
    standoff_m: float


_Row = tuple[float, Turned, Point]
"""A member, as `Members` has it: its cost, its orientation, its grasp point."""

_Height = tuple[float, Point]
"""A grasp point on the object's axis, in the object's frame, and what it costs in millionths."""

_Heading = tuple[float, float]
"""Of a heading its cosine to the way from shoulder to object, and how far it points up: the z of its unit
vector in the base frame.
"""

_COST = itemgetter(0)


def grasps(request: Request) -> Grasps | None:
    """All members, cheapest first; None where nothing is left."""
    ways = WAYS[request.closing.headings_rad]
    headings = _in_base(request, ways.headings)
    axis_z = request.T_base_object.rotate((0.0, 0.0, 1.0))[2]
    found: list[_Row] = []
    standoff_m = 0.0
    for tilt in ways.tilts:
        hopeful = _hopeful(tilt, headings, axis_z) if tilt.elevation_deg in request.elevations_deg else []
        if not hopeful:
            continue
        deepest_m = _deepest(request, tilt)
        rolls: list[tuple[tuple[Turned, ...], list[_Height]]] = []
        for roll in tilt.rolls:
            heights, needed_m = _heights(request, tilt, roll.drop_m, deepest_m)
            rolls.append((roll.ways, heights))
            standoff_m = max(standoff_m, needed_m)
        found += _rows(hopeful, rolls)
    # They were made in the order of their names, in which those of one cost stay.
    found.sort(key=_COST)
    return Grasps(Members(found), standoff_m) if found else None


def _in_base(request: Request, headings: tuple[Vec3, ...]) -> list[_Heading]:
    rotate, (reach_x, reach_y) = request.T_base_object.rotate, request.reach
    turned = [rotate(heading) for heading in headings]
    return [(x * reach_x + y * reach_y, z) for x, y, z in turned]


def _hopeful(tilt: Tilt, headings: list[_Heading], axis_z: float) -> list[tuple[int, float]]:
    """The headings left at a tilt, by their numbers, with what the way costs without its height; left out are
    approaches that point up, or come back towards the robot from behind the object without being steep.

    `axis_z` is how far the object's axis points up, 1 where it stands upright.
    """
    behind = _BEHIND if tilt.elevation_deg < _STEEP_DEG else -math.inf
    level, down, cost = tilt.level, tilt.down * axis_z, tilt.cost
    # Side and oblique grasps first, heading away from the robot; a straight one heads nowhere.
    back_cost = 0.0 if tilt.elevation_deg == 90.0 else _BACK_COST
    return [
        (number, cost + back_cost * (1.0 - alignment))
        for number, (alignment, rise) in enumerate(headings)
        if alignment >= behind and level * rise - down <= _UPWARD
    ]


def _rows(
    hopeful: list[tuple[int, float]], rolls: list[tuple[tuple[Turned, ...], list[_Height]]]
) -> list[_Row]:
    """The members at one tilt, in the order of their names; their costs, of about 0 .. 1, have six
    decimals.
    """
    # Each `for` over a tuple of one gives a value its name; the half rounds costs to whole millionths.
    return [
        ((millionths + height_cost) // 1.0 / 1e6, turned, point)
        for number, way_cost in hopeful
        for millionths in (1e6 * way_cost + 0.5,)
        for ways, heights in rolls
        for turned in (ways[number],)
        for height_cost, point in heights
    ]


def _heights(request: Request, tilt: Tilt, drop_m: float, deepest_m: float) -> tuple[list[_Height], float]:
    """Heights of the grasp point above the object's bottom that keep floor, palm and standoff, highest first,
    which is cheapest first; and the longest way back that one of them needs (m).
    """
    top, half_depth_m = request.height_m, request.closing.half_depth_m
    lowest = max(request.floor_m + request.clearance_m + drop_m, top - deepest_m)
    found: list[_Height] = []
    longest_m = 0.0
    for exact in _sampled(request, lowest):
        # Up to a tenth of a millimetre, as the name says it, and never under the lowest.
        height = math.ceil(exact * 10_000 - 1e-6) / 10_000
        standoff_m = standoff_needed_m(top - height, half_depth_m, tilt.down, tilt.level, request.hand)
        if standoff_m <= request.standoff_m + 1e-9:
            under = f", {(top - height) * 1000:.1f} mm under the top"
            found.append((1e6 * (_LOW_COST * (1.0 - height / top)), (under, (0.0, 0.0, height))))
            longest_m = max(longest_m, standoff_m)
    return found, longest_m


def _sampled(request: Request, lowest: float) -> tuple[float, ...]:
    """The written height if it is not under the lowest one, else up to three between that and the top."""
    top = request.height_m
    if request.depth_m is not None:
        wanted = top - request.depth_m
        return (wanted,) if lowest - 1e-9 <= wanted <= top else ()
    highest = top - min(_TOP_MARGIN_M, top / 5)
    room = highest - lowest
    if room < 0.0:
        return ()
    if room < 0.008:
        return (highest,)
    return (highest, highest - room) if room < 0.025 else (highest, highest - room / 2, highest - room)


def _deepest(request: Request, tilt: Tilt) -> float:
    """How far under the top the grasp point may lie before the object meets the palm."""
    room = request.hand.palm_m - request.clearance_m - request.closing.half_depth_m * tilt.level
    if room < 0.0:
        return -math.inf
    return math.inf if tilt.down < 1e-9 else room / tilt.down
