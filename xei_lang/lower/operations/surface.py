"""Free room on a surface: where to set an object down when only the surface is named."""

from __future__ import annotations

import math
from bisect import bisect
from collections.abc import Iterator

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.walk import Scene, Standing
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.record import Record, record

_GRID_M = 0.05
_EDGE_M = 0.02
_BESIDE_M = 0.05
_AHEAD_M = 0.30
_ALIKE_M = 1e-6
_UPRIGHT = 1e-9

_Found = tuple[float, float, float]
"""A free point: how far it is from where the arm likes it, rounded, and its x and y on the surface;
infinitely far for none.
"""

_Range = tuple[float, float]


@record
class _Obstacle(Record):
    """What stands on or over a surface: a point `(x, y)` of the surface's top is at `origin + x along + y
    across` in the obstacle's frame, and blocked where that is above `lowest_m`, under `highest_m` and nearer
    than `beside_m` to the obstacle's outline of these half sizes.
    """

    origin: Vec3
    along: Vec3
    across: Vec3
    half_x: float
    half_y: float
    lowest_m: float
    highest_m: float
    beside_m: float
    x_range: _Range
    y_range: _Range

    def blocks(self, x: float, y: float) -> bool:
        """Whether an object cannot stand at a point."""
        (ox, oy, oz), (ax, ay, az), (bx, by, bz) = self.origin, self.along, self.across
        beside_x = abs(ox + ax * x + bx * y) - self.half_x
        if beside_x >= self.beside_m:
            return False
        beside_y = abs(oy + ay * x + by * y) - self.half_y
        if beside_y >= self.beside_m or not self.lowest_m < oz + az * x + bz * y < self.highest_m:
            return False
        return math.hypot(max(0.0, beside_x), max(0.0, beside_y)) < self.beside_m


@record
class _Row(Record):
    """A row of the grid: the least distance of its line, its x, and the y of its points to both sides from
    where that is.
    """

    least_m: float
    x: float
    sides: tuple[tuple[float, ...], tuple[float, ...]]
    start: tuple[float, float]
    along: tuple[float, float]

    def away(self, y: float) -> float:
        """How far a point is from where the arm likes it."""
        return math.hypot(self.start[0] + self.along[0] * y, self.start[1] + self.along[1] * y)


def free_room(profile: Profile, scene: Scene, arm: Side, surface: str, known: LabObject) -> Pose | None:
    """The free point of a surface's top that is easiest for the arm, in the surface's frame; None where
    there is none.

    Points lie on a grid of 50 mm about the middle, the object's outline 20 mm inside the edge and 50 mm (a
    finger and its room) from everything else; the easiest is nearest to 0.30 m ahead of the shoulder, seen
    from above, and of those that are so to a micrometre the one with the least x, then y.
    """
    host = profile.object(surface)
    if host is None:
        return None
    radius = math.hypot(known.size_m[0], known.size_m[1]) / 2
    obstacles = list(_obstacles(profile, scene, host, known, radius + _BESIDE_M))
    rows = _rows(scene.T_base_object(surface), host, radius, shoulder_xy(profile, arm))
    best = (math.inf, 0.0, 0.0)
    for row in rows:
        if row.least_m > best[0] + _ALIKE_M:
            break
        near = [item for item in obstacles if item.x_range[0] < row.x < item.x_range[1]]
        for ys in row.sides:
            best = min(best, _first_free(row, ys, near, best[0]))
    return Pose((best[1], best[2], host.size_m[2])) if best[0] < math.inf else None


def _first_free(row: _Row, ys: tuple[float, ...], obstacles: list[_Obstacle], most_m: float) -> _Found:
    """The first free one of a row's points, which come with growing distance; none beyond `most_m`."""
    k, x = 0, row.x
    while k < len(ys):
        y, away_m = ys[k], row.away(ys[k])
        if away_m > most_m + _ALIKE_M:
            break
        for item in obstacles:
            low, high = item.y_range
            if low < y < high and item.blocks(x, y):
                k = _behind(item, x, ys, k + 1)
                break
        else:
            return (round(away_m, 6), x, y)
    return (math.inf, 0.0, 0.0)


def _behind(item: _Obstacle, x: float, ys: tuple[float, ...], k: int) -> int:
    """The number of the first point from `k` on that an obstacle leaves: what it blocks of a line is one
    piece.
    """
    return bisect(ys, False, k, key=lambda y: not item.blocks(x, y))


def _rows(T_base_host: Pose, host: LabObject, radius: float, shoulder: tuple[float, float]) -> list[_Row]:
    """The rows of the grid, nearest first, seen from above."""
    (ax, ay, _), along, _ = T_base_host.axes()
    bx, by, _ = along
    ox, oy, _ = T_base_host.apply((0.0, 0.0, host.size_m[2]))
    ox, oy = ox - shoulder[0] - _AHEAD_M, oy - shoulder[1]
    ys = _steps(host.size_m[1] / 2 - radius)
    rows: list[_Row] = []
    for x in _steps(host.size_m[0] / 2 - radius):
        px, py = ox + ax * x, oy + ay * x
        foot = -(px * bx + py * by) / (bx * bx + by * by)
        least_m = math.hypot(px + bx * foot, py + by * foot)
        middle = bisect(ys, foot)
        rows.append(_Row(least_m, x, (ys[:middle][::-1], ys[middle:]), (px, py), (bx, by)))
    return sorted(rows, key=lambda row: (row.least_m, row.x))


def _steps(room_m: float) -> tuple[float, ...]:
    """Grid values from the middle to `room_m` on both sides, without the edge; the middle alone where it is
    tight.
    """
    if room_m < 0.0:
        return ()
    count = int(max(0.0, room_m - _EDGE_M) / _GRID_M + 1e-9)
    return tuple(k * _GRID_M for k in range(-count, count + 1))


def _obstacles(
    profile: Profile, scene: Scene, host: LabObject, known: LabObject, beside_m: float
) -> Iterator[_Obstacle]:
    """What may be in the way somewhere on the surface; what is too far from all of it is left out."""
    T_world_host = scene.standing[host.name].T_world_object
    objects = {item.name: item for item in profile.objects}
    middle, top = T_world_host.position_m, host.size_m[2]
    far = math.hypot(*host.size_m) + known.size_m[2] + 2 * beside_m
    corners = [T_world_host.apply(point) for point in ((0.0, 0.0, top), (1.0, 0.0, top), (0.0, 1.0, top))]
    for name, other in scene.standing.items():
        thing = objects.get(name)
        if thing is None or name in (host.name, known.name):
            continue
        length, width, height = thing.size_m
        reach = far + length + width + height
        if math.dist(middle, other.T_world_object.position_m) > reach:
            continue
        if _is_hidden(other, thing, scene, host, objects):
            continue
        origin, one_x, one_y = (other.T_world_object.locate(corner) for corner in corners)
        along = (one_x[0] - origin[0], one_x[1] - origin[1], one_x[2] - origin[2])
        across = (one_y[0] - origin[0], one_y[1] - origin[1], one_y[2] - origin[2])
        ranges = _ranges(origin, along, across, (length / 2, width / 2), beside_m)
        lowest_m, highest_m = -known.size_m[2], height - 1e-3
        yield _Obstacle(origin, along, across, length / 2, width / 2, lowest_m, highest_m, beside_m, *ranges)


def _ranges(
    origin: Vec3, along: Vec3, across: Vec3, half_m: tuple[float, float], beside_m: float
) -> tuple[_Range, _Range]:
    """What an obstacle blocks, in x and in y of the surface: its outline as the surface sees it, and the room
    beside it; everything for one that stands askew.
    """
    if abs(along[2]) > _UPRIGHT or abs(across[2]) > _UPRIGHT:
        return (-math.inf, math.inf), (-math.inf, math.inf)
    (ox, oy, _), (half_x, half_y) = origin, half_m

    def blocked(axis: Vec3) -> _Range:
        middle = -(axis[0] * ox + axis[1] * oy)
        reach = abs(axis[0]) * half_x + abs(axis[1]) * half_y + beside_m + _ALIKE_M
        return (middle - reach, middle + reach)

    return blocked(along), blocked(across)


def _is_hidden(
    other: Standing, thing: LabObject, scene: Scene, host: LabObject, objects: dict[str, LabObject]
) -> bool:
    """Whether the object stands within the outline of another, which stands on the surface itself: a tube in
    a rack takes no room that the rack does not take.
    """
    carrier, below = scene.standing.get(other.support), objects.get(other.support)
    if carrier is None or below is None or carrier.support != host.name:
        return False
    x, y, _ = carrier.T_world_object.locate(other.T_world_object.position_m)
    radius = math.hypot(thing.size_m[0], thing.size_m[1]) / 2
    return abs(x) + radius <= below.size_m[0] / 2 and abs(y) + radius <= below.size_m[1] / 2
