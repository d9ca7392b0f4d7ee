"""Free room on a surface: where to set an object down when only the surface is named."""

from __future__ import annotations

import math
from heapq import heapify, heappop, heappush

from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.operations.obstacles import Obstacle, obstacles_on
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.record import Record, record

_GRID_M = 0.05
_EDGE_M = 0.02
_BESIDE_M = 0.05
_AHEAD_M = 0.30
_ALIKE_M = 1e-6


@record
class _Grid(Record):
    """The points of a surface where an object's middle may be: `(i, k)` grid widths in x and y from the
    surface's middle, `i` up to `most_i` and `k` up to `most_k` both ways; `most_k` is -1 where there is none.

    A row is the points of one `i`. Seen from above, in the base frame, a point `(x, y)` lies at
    `middle + x along + y across` from where the arm likes it best.
    """

    most_i: int
    most_k: int
    middle: tuple[float, float]
    along: tuple[float, float]
    across: tuple[float, float]


_Front = tuple[float, float, int, int, tuple[float, float], list[Obstacle]]
"""Where the search stands on one side of a row. A plain tuple, which a heap sorts by its first:

- how far its next point is from where the arm likes it best,
- the row's x,
- the step from point to point, 1 or -1; 0 for a row of which neither side is begun,
- the `k` of the next point,
- where the row's middle lies from where the arm likes it best,
- what may be in the row's way.
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
    radius_m = math.hypot(known.size_m[0], known.size_m[1]) / 2
    obstacles = obstacles_on(profile, scene, host, known, radius_m + _BESIDE_M)
    grid = _grid(scene.T_base_object(surface), host, radius_m, shoulder_xy(profile, arm))
    found = _nearest_free(grid, obstacles)
    return Pose((*found, host.size_m[2])) if found else None


def _grid(T_base_host: Pose, host: LabObject, radius_m: float, shoulder: tuple[float, float]) -> _Grid:
    (ax, ay, _), (bx, by, _), _ = T_base_host.axes()
    x, y, _ = T_base_host.apply((0.0, 0.0, host.size_m[2]))
    middle = (x - shoulder[0] - _AHEAD_M, y - shoulder[1])
    most_i, most_k = _most(host.size_m[0] / 2 - radius_m), _most(host.size_m[1] / 2 - radius_m)
    return _Grid(most_i, most_k if most_i >= 0 else -1, middle, (ax, ay), (bx, by))


def _most(room_m: float) -> int:
    """How many points of the grid lie to either side of the middle one, within `room_m` without the edge: 0
    where it is tight, -1 where not even the middle has room.
    """
    return int(max(0.0, room_m - _EDGE_M) / _GRID_M + 1e-9) if room_m >= 0.0 else -1


def _nearest_free(grid: _Grid, obstacles: list[Obstacle]) -> tuple[float, float] | None:
    """The free point nearest to where the arm likes it; of those that are alike, the one of least x, then y.

    Best first: of all sides of all rows the one whose next point is nearest goes on, past what blocks it.
    """
    most_k, (bx, by) = grid.most_k, grid.across
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
            onward = ((min(k - 1, most_k), -1), (max(k, -most_k), 1))
        else:
            blocking = _blocking(near, x, y)
            if blocking is None:
                best = min(best, (round(away_m, 6), x, y))
                continue
            onward = ((_behind(blocking, x, k, most_k, step), step),)
        for k, step in onward:
            if -most_k <= k <= most_k:
                y = k * _GRID_M
                away_m = math.hypot(px + bx * y, py + by * y)
                heappush(fronts, (away_m, x, step, k, (px, py), near))
    return best[1:] if best[0] < math.inf else None


def _rows(grid: _Grid, obstacles: list[Obstacle]) -> list[_Front]:
    """A front for each row, not begun: as far away as its line is at its nearest, which no point of the row
    beats, and with the first `k` behind that.
    """
    (mx, my), (ax, ay), (bx, by) = grid.middle, grid.along, grid.across
    norm = bx * bx + by * by
    found: list[_Front] = []
    for i in range(-grid.most_i, grid.most_i + 1 if grid.most_k >= 0 else -grid.most_i):
        x = i * _GRID_M
        px, py = mx + ax * x, my + ay * x
        foot = -(px * bx + py * by) / norm
        least_m = math.hypot(px + bx * foot, py + by * foot)
        found.append((least_m, x, 0, math.floor(foot / _GRID_M) + 1, (px, py), obstacles))
    heapify(found)
    return found


def _blocking(obstacles: list[Obstacle], x: float, y: float) -> Obstacle | None:
    for item in obstacles:
        low, high = item.y_range
        if low < y < high and item.blocks(x, y):
            return item
    return None


def _behind(item: Obstacle, x: float, k: int, most_k: int, step: int) -> int:
    """The first `k` from the blocked one on, in steps, that an obstacle leaves free: what it blocks of a row
    is one piece, which ends before the end of its range.
    """
    end = item.y_range[step > 0] / _GRID_M * step
    free = math.ceil(min(end, most_k + 1)) * step
    while free - step != k and not item.blocks(x, (free - step) * _GRID_M):
        free -= step
    return free
