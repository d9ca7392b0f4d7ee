"""What stands in the way on a surface: the other things on and over it, as the points of its top see them."""

from __future__ import annotations

import math

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.lower.walk import Scene, Standing
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.record import Record, record

_UNDER_M = 1e-3
"""A thing whose top is no higher than this over the surface is below it: what carries the surface is."""
_ALIKE_M = 1e-6
_LEVEL = 1e-9
_ANYWHERE = (-math.inf, math.inf)
_X, _Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)

_Range = tuple[float, float]


@record
class Obstacle(Record):
    """A thing that something on the surface may meet.

    A point `(x, y)` of the surface's top is at `origin + x along + y across` in the thing's own frame, and
    blocked where that is nearer than `beside_m` to its outline, of these half sizes. `heights` are those, in
    its frame, between which a point is blocked at all; None where all points are, because it stands as
    upright as the surface. No point outside of `x_range` and `y_range` is blocked.
    """

    origin: Vec3
    along: Vec3
    across: Vec3
    half_x: float
    half_y: float
    beside_m: float
    heights: _Range | None
    x_range: _Range
    y_range: _Range

    def blocks(self, x: float, y: float) -> bool:
        """Whether an object cannot stand at a point."""
        (ox, oy, oz), (ax, ay, az), (bx, by, bz) = self.origin, self.along, self.across
        beside_m = self.beside_m
        beside_x = abs(ox + ax * x + bx * y) - self.half_x
        if beside_x >= beside_m:
            return False
        beside_y = abs(oy + ay * x + by * y) - self.half_y
        if beside_y >= beside_m:
            return False
        if self.heights is not None and not self.heights[0] < oz + az * x + bz * y < self.heights[1]:
            return False
        return beside_x <= 0.0 or beside_y <= 0.0 or math.hypot(beside_x, beside_y) < beside_m


def obstacles_on(
    profile: Profile, scene: Scene, host: LabObject, known: LabObject, beside_m: float
) -> list[Obstacle]:
    """What may be in the way of the middle of `known` somewhere on the top of `host`, with this room beside
    it; what is too far from all of the top, below it or above the object is left out.
    """
    T_world_host = scene.standing[host.name].T_world_object
    itself, near, lowest_m = (host.name, known.name), T_world_host.position_m, -known.size_m[2]
    reach_m = math.hypot(*host.size_m) + known.size_m[2] + 2 * beside_m
    top, axes = T_world_host.apply((0.0, 0.0, host.size_m[2])), T_world_host.axes()
    found: list[Obstacle] = []
    for name, other in scene.standing.items():
        thing, T_world_other = profile.object(name), other.T_world_object
        if thing is None or name in itself:
            continue
        length, width, height = thing.size_m
        if math.dist(near, T_world_other.position_m) > reach_m + length + width + height:
            continue
        if other.support != host.name and _is_hidden(other, thing, scene, host, profile):
            continue
        origin, along, across = T_world_other.locate(top), _X, _Y
        # Most things stand as the surface does.
        if T_world_other.quaternion != T_world_host.quaternion:
            turn = Pose((0.0, 0.0, 0.0), T_world_other.quaternion).locate
            along, across = turn(axes[0]), turn(axes[1])
        half_x, half_y = length / 2, width / 2
        heights, x_range, y_range = (lowest_m, height - _UNDER_M), _ANYWHERE, _ANYWHERE
        if abs(along[2]) < _LEVEL and abs(across[2]) < _LEVEL:
            if not heights[0] < origin[2] < heights[1]:
                continue
            heights = None
            x_range, y_range = _ranges(origin, along, across, half_x, half_y, beside_m)
        found.append(Obstacle(origin, along, across, half_x, half_y, beside_m, heights, x_range, y_range))
    return found


def _ranges(
    origin: Vec3, along: Vec3, across: Vec3, half_x: float, half_y: float, beside_m: float
) -> tuple[_Range, _Range]:
    """The outline of what stands upright, and the room beside it, as the surface sees them."""
    (ox, oy, _), (ax, ay, _), (bx, by, _) = origin, along, across
    x, room_x = -ax * ox - ay * oy, abs(ax) * half_x + abs(ay) * half_y + beside_m + _ALIKE_M
    y, room_y = -bx * ox - by * oy, abs(bx) * half_x + abs(by) * half_y + beside_m + _ALIKE_M
    return (x - room_x, x + room_x), (y - room_y, y + room_y)


def _is_hidden(other: Standing, thing: LabObject, scene: Scene, host: LabObject, profile: Profile) -> bool:
    """Whether the object stands within the outline of another, which stands on the surface itself: a tube in
    a rack takes no room that the rack does not take.
    """
    carrier, below = scene.standing.get(other.support), profile.object(other.support)
    if carrier is None or below is None or carrier.support != host.name:
        return False
    x, y, _ = carrier.T_world_object.locate(other.T_world_object.position_m)
    radius = math.hypot(thing.size_m[0], thing.size_m[1]) / 2
    return abs(x) + radius <= below.size_m[0] / 2 and abs(y) + radius <= below.size_m[1] / 2
