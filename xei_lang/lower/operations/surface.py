"""Free room on a surface: where to set an object down when only the surface is named."""

from __future__ import annotations

import math
from heapq import heapify, heappop, heappush

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
_EVERYWHERE = (-math.inf, math.inf)
_X, _Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)

_Range = tuple[float, float]


@record
class _Obstacle(Record):
    """What stands on or over a surface: a point `(x, y)` of the surface's top is at `origin + x along + y
    across` in the obstacle's frame, and blocked where that is nearer than `beside_m` to the obstacle's
    outline of these half sizes; of one that stands askew, only where it is in `heights` too.
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


@record
class _Grid(Record):
    """The points of a surface where an object's middle may be: `(i, k)` grid widths in x and y from its
    middle, `i` up to `long` and `k` up to `wide` both ways; `wide` is -1 where there is none.

    Seen from above, a point `(x, y)` is at `start + x along + y across` from where the arm likes it.
    """

    long: int
    wide: int
    start: tuple[float, float]
    along: tuple[float, float]
    across: tuple[float, float]


_Front = tuple[float, float, int, int, tuple[float, float], list[_Obstacle]]
"""Where the search stands on one side of a row: how far its next point is from where the arm likes it, the
row's x, the step to the point after (0 for a row that is not begun), the point's number in y, where the row's
middle is from where the arm likes it, and what may be in the row's way.
"""


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
    obstacles = _obstacles(profile, scene, host, known, radius + _BESIDE_M)
    grid = _grid(scene.T_base_object(surface), host, radius, shoulder_xy(profile, arm))
    found = _nearest_free(grid, obstacles)
    return Pose((*found, host.size_m[2])) if found else None


def _grid(T_base_host: Pose, host: LabObject, radius: float, shoulder: tuple[float, float]) -> _Grid:
    (ax, ay, _), (bx, by, _), _ = T_base_host.axes()
    x, y, _ = T_base_host.apply((0.0, 0.0, host.size_m[2]))
    start = (x - shoulder[0] - _AHEAD_M, y - shoulder[1])
    long, wide = _count(host.size_m[0] / 2 - radius), _count(host.size_m[1] / 2 - radius)
    return _Grid(long, wide if long >= 0 else -1, start, (ax, ay), (bx, by))


def _nearest_free(grid: _Grid, obstacles: list[_Obstacle]) -> tuple[float, float] | None:
    """The free point nearest to where the arm likes it; of those that are alike, the one of least x, then y.

    Best first: of all sides of all rows the one whose next point is nearest goes on, past what blocks it.
    """
    wide, (bx, by) = grid.wide, grid.across
    fronts = _rows(grid, obstacles)
    best = (math.inf, 0.0, 0.0)
    while fronts:
        away_m, x, step, k, (px, py), near = fronts[0]
        if away_m > best[0] + _ALIKE_M:
            break
        heappop(fronts)
        y = k * _GRID_M
        if step == 0:
            near = [item for item in near if item.x_range[0] < x < item.x_range[1]]
            on = ((min(k - 1, wide), -1), (max(k, -wide), 1))
        else:
            blocking = _blocking(near, x, y)
            if blocking is None:
                best = min(best, (round(away_m, 6), x, y))
                continue
            on = ((_behind(blocking, x, k, wide, step), step),)
        for k, step in on:
            if -wide <= k <= wide:
                y = k * _GRID_M
                away_m = math.hypot(px + bx * y, py + by * y)
                heappush(fronts, (away_m, x, step, k, (px, py), near))
    return best[1:] if best[0] < math.inf else None


def _rows(grid: _Grid, obstacles: list[_Obstacle]) -> list[_Front]:
    """All rows, nearest line first, each at the first point behind its nearest."""
    (ox, oy), (ax, ay), (bx, by) = grid.start, grid.along, grid.across
    norm = bx * bx + by * by
    found: list[_Front] = []
    for i in range(-grid.long, grid.long + 1 if grid.wide >= 0 else -grid.long):
        x = i * _GRID_M
        px, py = ox + ax * x, oy + ay * x
        foot = -(px * bx + py * by) / norm
        least_m = math.hypot(px + bx * foot, py + by * foot)
        found.append((least_m, x, 0, math.floor(foot / _GRID_M) + 1, (px, py), obstacles))
    heapify(found)
    return found


def _blocking(obstacles: list[_Obstacle], x: float, y: float) -> _Obstacle | None:
    for item in obstacles:
        low, high = item.y_range
        if low < y < high and item.blocks(x, y):
            return item
    return None


def _behind(item: _Obstacle, x: float, k: int, wide: int, step: int) -> int:
    """The number of the first point behind the blocked one `k` that an obstacle leaves: what it blocks of a
    line is one piece, which ends before the end of its range.
    """
    end = item.y_range[step > 0] / _GRID_M * step
    free = math.ceil(min(end, wide + 1)) * step
    while free - step != k and not item.blocks(x, (free - step) * _GRID_M):
        free -= step
    return free


def _count(room_m: float) -> int:
    """How many points of the grid lie beside the middle one, to either side, within `room_m` without the
    edge: 0 where it is tight, -1 where not even the middle has room.
    """
    return int(max(0.0, room_m - _EDGE_M) / _GRID_M + 1e-9) if room_m >= 0.0 else -1


def _obstacles(
    profile: Profile, scene: Scene, host: LabObject, known: LabObject, beside_m: float
) -> list[_Obstacle]:
    """What may be in the way somewhere on the surface; what is too far from all of it is left out."""
    T_world_host = scene.standing[host.name].T_world_object
    own, middle, lowest_m = (host.name, known.name), T_world_host.position_m, -known.size_m[2]
    far = math.hypot(*host.size_m) + known.size_m[2] + 2 * beside_m
    corner = T_world_host.apply((0.0, 0.0, host.size_m[2]))
    axes = T_world_host.axes()
    found: list[_Obstacle] = []
    for name, other in scene.standing.items():
        thing, T_world_other = profile.object(name), other.T_world_object
        if thing is None or name in own:
            continue
        length, width, height = thing.size_m
        if math.dist(middle, T_world_other.position_m) > far + length + width + height:
            continue
        if _is_hidden(other, thing, scene, host, profile):
            continue
        origin, along, across = T_world_other.locate(corner), _X, _Y
        # Most things stand as the surface does.
        if T_world_other.quaternion != T_world_host.quaternion:
            turn = Pose((0.0, 0.0, 0.0), T_world_other.quaternion).locate
            along, across = turn(axes[0]), turn(axes[1])
        half_x, half_y = length / 2, width / 2
        heights, x_range, y_range = (lowest_m, height - 1e-3), _EVERYWHERE, _EVERYWHERE
        if abs(along[2]) < _UPRIGHT and abs(across[2]) < _UPRIGHT:
            (ox, oy, oz), (ax, ay, _), (bx, by, _) = origin, along, across
            if not heights[0] < oz < heights[1]:
                continue
            # Its outline as the surface sees it, and the room beside it.
            x, room_x = -ax * ox - ay * oy, abs(ax) * half_x + abs(ay) * half_y + beside_m + _ALIKE_M
            y, room_y = -bx * ox - by * oy, abs(bx) * half_x + abs(by) * half_y + beside_m + _ALIKE_M
            heights, x_range, y_range = None, (x - room_x, x + room_x), (y - room_y, y + room_y)
        found.append(_Obstacle(origin, along, across, half_x, half_y, beside_m, heights, x_range, y_range))
    return found


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
