"""Which cells a convex outline covers, and what the base covers on a straight leg or a turn in place.

A cell counts as covered where its square and the outline have an inner point in common: a separating axis is
looked for among the sides of both (S. Gottschalk et al., "OBBTree", SIGGRAPH 1996, for convex polygons).
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from xei_lang.world.map.footprint import Footprint, Point, convex_hull
from xei_lang.world.map.grid import FREE, Indices, OccupancyGrid

Station = tuple[float, float, float]
"""x, y, yaw of the base in the map's frame, m and rad."""

_TURN_STEP = math.radians(10.0)
_TOUCH_M = 1e-9


def covered_cells(outline: tuple[Point, ...], resolution_m: float) -> Indices:
    """Row and column (n, 2) of all cells that a convex outline of the grid's own frame covers."""
    corners = np.array(outline)
    low = np.floor(corners.min(axis=0) / resolution_m).astype(np.int64)
    high = np.floor(corners.max(axis=0) / resolution_m).astype(np.int64)
    width, height = (int(size) for size in high - low + 1)
    index = np.arange(width * height)
    cells: Indices = np.stack([index // width + low[1], index % width + low[0]], axis=1)
    centers = (cells[:, ::-1] + 0.5) * resolution_m
    sides = np.roll(corners, -1, axis=0) - corners
    lengths = np.hypot(sides[:, 0], sides[:, 1])
    sides, lengths = sides[lengths > _TOUCH_M], lengths[lengths > _TOUCH_M]
    axes = np.concatenate([sides[:, ::-1] * np.array([1.0, -1.0]) / lengths[:, None], np.eye(2)])
    reach, along = corners @ axes.T, centers @ axes.T
    square = resolution_m / 2.0 * np.abs(axes).sum(axis=1)
    covered = np.all(along + square > reach.min(axis=0) + _TOUCH_M, axis=1)
    covered &= np.all(along - square < reach.max(axis=0) - _TOUCH_M, axis=1)
    return cells[covered]


def standing_cells(grid: OccupancyGrid, footprint: Footprint, station: Station) -> Indices:
    """The cells, by row and column (n, 2), that the base covers where it stands."""
    return _cells(grid, footprint.at(*station))


def is_leg_free(grid: OccupancyGrid, footprint: Footprint, start: Station, goal: Point) -> bool:
    """Whether the base can go straight from where it stands to a point, with its heading kept."""
    x, y, yaw = start
    swept = convex_hull([*footprint.at(x, y, yaw), *footprint.at(*goal, yaw)])
    return _is_free(grid, swept)


def is_turn_free(grid: OccupancyGrid, footprint: Footprint, at: Point, start: float, turn: float) -> bool:
    """Whether the base can turn in place from a heading by `turn`, rad.

    The turn is taken in steps; between two of them no corner leaves the hull of the outlines that are
    enlarged so far that the chord between them does not cut its arc.
    """
    return all(_is_free(grid, swept) for swept in turn_outlines(footprint, at, start, turn))


def turn_outlines(footprint: Footprint, at: Point, start: float, turn: float) -> list[tuple[Point, ...]]:
    """Convex outlines that together hold all that a turn in place covers."""
    if abs(turn) < 1e-12:
        return [footprint.at(*at, start)]
    steps = max(1, math.ceil(abs(turn) / _TURN_STEP - 1e-9))
    scale = 1.0 / math.cos(turn / steps / 2.0)
    posed = [footprint.at(*at, start + turn * k / steps, scale) for k in range(steps + 1)]
    return [convex_hull([*a, *b]) for a, b in pairwise(posed)]


def _cells(grid: OccupancyGrid, outline: tuple[Point, ...]) -> Indices:
    inside = grid.to_grid(np.array(outline))
    return covered_cells(tuple((float(x), float(y)) for x, y in inside), grid.resolution_m)


def _is_free(grid: OccupancyGrid, outline: tuple[Point, ...]) -> bool:
    return bool(np.all(grid.values_at(_cells(grid, outline)) == FREE))
