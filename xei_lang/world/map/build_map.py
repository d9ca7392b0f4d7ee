"""An occupancy grid from scans at known poses, by log-odds.

H. Moravec and A. Elfes, "High resolution maps from wide angle sonar", ICRA 1985; S. Thrun, W. Burgard and
D. Fox, "Probabilistic Robotics", chapter 9; the weights are those of A. Hornung et al., "OctoMap",
Autonomous Robots 34, 2013. In each scan a cell counts once: as hit where an echo lies in it, else as passed
where a ray crosses it (J. Amanatides and A. Woo, "A fast voxel traversal algorithm", Eurographics 1987).
Counts are whole numbers, so the order of scans does not matter and the same scans give the same bytes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.diagnostics import Diagnostic
from xei_lang.world.map.grid import FREE, OCCUPIED, UNKNOWN, OccupancyGrid
from xei_lang.world.map.read_map import MAX_CELLS
from xei_lang.world.map.recording import CODE, Scans

HIT, PASSED = math.log(0.7 / 0.3), math.log(0.4 / 0.6)
OCCUPIED_CHANCE, FREE_CHANCE = 0.65, 0.196
_MARGIN = 2

Array = NDArray[np.float64]
Counts = NDArray[np.int32]
Keys = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Counted:
    """How often each cell (height, width) was hit and passed; cell (0, 0) begins at `corner`, in cells of
    `resolution_m` from the map's origin (column, row).
    """

    hits: Counts
    passes: Counts
    corner: tuple[int, int]
    resolution_m: float

    def grid(self) -> OccupancyGrid:
        """Occupied, free or unknown, by the chance that the counts give."""
        odds = HIT * self.hits + PASSED * self.passes
        cells = np.full(self.hits.shape, UNKNOWN, dtype=np.int8)
        cells[odds < math.log(FREE_CHANCE / (1.0 - FREE_CHANCE))] = FREE
        cells[odds > math.log(OCCUPIED_CHANCE / (1.0 - OCCUPIED_CHANCE))] = OCCUPIED
        column, row = self.corner
        return OccupancyGrid(
            cells, self.resolution_m, (column * self.resolution_m, row * self.resolution_m, 0.0)
        )


def build_map(scans: Scans, resolution_m: float) -> OccupancyGrid | Diagnostic:
    """The map of all scans, as large as what their echoes reach; XEI0667 where that is no room."""
    counted = count_rays(scans, resolution_m)
    return counted if isinstance(counted, Diagnostic) else counted.grid()


def count_rays(scans: Scans, resolution_m: float) -> Counted | Diagnostic:
    """Hits and passes of all rays with an echo; a ray without one says nothing.

    No echo comes back from glass and from what is black, too, so that such a ray is no sign of free floor.
    """
    low, high = _extent(scans, resolution_m)
    if low is None or high is None:
        return Diagnostic(CODE, "no ray of the recording has an echo", help=("look at the lidar's ranges",))
    width, height = (int(size) for size in high - low)
    if width * height > MAX_CELLS:
        message = f"the scans reach over {width * resolution_m:.0f} m x {height * resolution_m:.0f} m"
        help_ = "look for a wrong pose, or take a coarser --resolution"
        return Diagnostic(CODE, f"{message}: too large for a map", help=(help_,))
    hits, passes = (np.zeros((height, width), dtype=np.int32) for _ in range(2))
    for index in range(len(scans.poses)):
        start, ends = _ray_ends(scans, index, resolution_m)
        if len(ends):
            _count(start - low, ends - low, hits, passes)
    return Counted(hits, passes, (int(low[0]), int(low[1])), resolution_m)


def _extent(scans: Scans, resolution_m: float) -> tuple[Keys, Keys] | tuple[None, None]:
    """The first and the one behind the last cell (column, row) that the rays touch, with a margin."""
    lows: list[Array] = []
    highs: list[Array] = []
    for index in range(len(scans.poses)):
        start, ends = _ray_ends(scans, index, resolution_m)
        if len(ends):
            lows.append(np.minimum(start, ends.min(axis=0)))
            highs.append(np.maximum(start, ends.max(axis=0)))
    if not lows:
        return None, None
    low = np.floor(np.min(lows, axis=0)).astype(np.int64) - _MARGIN
    return low, np.floor(np.max(highs, axis=0)).astype(np.int64) + 1 + _MARGIN


def _ray_ends(scans: Scans, index: int, resolution_m: float) -> tuple[Array, Array]:
    """Where a scan's rays begin (2,) and those with an echo end (n, 2), in cells from the map's origin."""
    x, y, yaw = scans.poses[index]
    ranges = scans.ranges_m[index]
    echo = ~np.isnan(ranges)
    angles, lengths = scans.angles_rad[echo] + yaw, ranges[echo]
    start = np.array([x, y])
    ends = start + lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return start / resolution_m, ends / resolution_m


def _count(start: Array, ends: Array, hits: Counts, passes: Counts) -> None:
    """Add one scan to the counts. All in cells of the counts, (column, row)."""
    cells = np.floor(ends).astype(np.int64)
    low = np.minimum(np.floor(start).astype(np.int64), cells.min(axis=0))
    high = np.maximum(np.floor(start).astype(np.int64), cells.max(axis=0)) + 1
    width, height = (int(size) for size in high - low)
    seen = np.zeros(width * height, dtype=np.uint8)
    local = start - low
    seen[int(local[1]) * width + int(local[0])] = 1
    for axis in (0, 1):
        seen[_crossed(local, ends - low, axis, (width, height))] = 1
    seen[(cells[:, 1] - low[1]) * width + cells[:, 0] - low[0]] = 2
    window = np.s_[int(low[1]) : int(high[1]), int(low[0]) : int(high[0])]
    seen2d = seen.reshape(height, width)
    hits[window] += seen2d == 2
    passes[window] += seen2d == 1


def _crossed(start: Array, ends: Array, axis: int, size: tuple[int, int]) -> Keys:
    """The cells that rays enter across lines of one axis, as row * width + column.

    A ray enters one cell at each line between its ends; with both axes and the cell of the start these are
    all that it crosses.
    """
    first, last = math.floor(start[axis]), np.floor(ends[:, axis]).astype(np.int64)
    counts = np.abs(last - first)
    ray = np.repeat(np.arange(len(ends)), counts)
    nth = np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    way: Keys = np.sign(last[ray] - first)
    entered: Keys = first + way * nth
    line: Keys = entered + (way < 0)
    along = ends[ray] - start
    other: Array = start[1 - axis] + (line - start[axis]) / along[:, axis] * along[:, 1 - axis]
    across = np.clip(np.floor(other).astype(np.int64), 0, size[1 - axis] - 1)
    column, row = (entered, across) if axis == 0 else (across, entered)
    return row * size[0] + column
