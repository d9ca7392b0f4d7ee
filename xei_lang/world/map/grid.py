"""An occupancy grid: which part of the floor is free, occupied or unknown."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose

Cells = NDArray[np.int8]
Points = NDArray[np.float64]
Indices = NDArray[np.int64]

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Values of nav_msgs/OccupancyGrid; what lies between 0 and 100 is a chance in percent, and not free."""


@dataclass(frozen=True, slots=True, eq=False)
class OccupancyGrid:
    """`cells` (height, width), of which row 0, column 0 is at `origin`: the pose (x, y, yaw) in the map's
    frame of that cell's outer corner, from where columns go along x and rows along y (m, rad).
    """

    cells: Cells
    resolution_m: float
    origin: tuple[float, float, float]

    def __post_init__(self) -> None:
        self.cells.setflags(write=False)

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        return int(self.cells.shape[0]), int(self.cells.shape[1])

    def to_grid(self, points_m: Points) -> Points:
        """Points (n, 2) of the map's frame in the grid's own: from its corner, along columns and rows, m."""
        x, y, yaw = self.origin
        c, s = math.cos(yaw), math.sin(yaw)
        return (points_m - np.array([x, y])) @ np.array([[c, -s], [s, c]])

    def to_map(self, points_m: Points) -> Points:
        """Points (n, 2) of the grid's own frame in the map's, m."""
        x, y, yaw = self.origin
        c, s = math.cos(yaw), math.sin(yaw)
        return points_m @ np.array([[c, s], [-s, c]]) + np.array([x, y])

    def cells_at(self, points_m: Points) -> Indices:
        """Row and column (n, 2) of the cells that hold these points (n, 2) of the map's frame; they may lie
        outside of the grid.
        """
        return np.floor(self.to_grid(points_m)[:, ::-1] / self.resolution_m).astype(np.int64)

    def centers_of(self, cells: Indices) -> Points:
        """Centres (n, 2), in the map's frame, of cells given by row and column (n, 2); m."""
        centers: Points = (cells[:, ::-1].astype(np.float64) + 0.5) * self.resolution_m
        return self.to_map(centers)

    def values_at(self, cells: Indices) -> Cells:
        """Values (n,) of cells by row and column (n, 2); what lies outside is unknown."""
        rows, columns = cells[:, 0], cells[:, 1]
        height, width = self.shape
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        values = np.full(len(cells), UNKNOWN, dtype=np.int8)
        values[inside] = self.cells[rows[inside], columns[inside]]
        return values

    def count(self, value: int) -> int:
        """How many cells have this value."""
        return int(np.count_nonzero(self.cells == value))


def yaw_of(pose: Pose) -> float:
    """The heading of a pose's x axis about z, rad in -pi .. pi."""
    x, y, _ = pose.axes()[0]
    return math.atan2(y, x)
