"""Distances over a grid: to what is not free, and along the steps of a lattice."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

ndimage: Any = importlib.import_module("scipy.ndimage")  # ships no type information
sparse: Any = importlib.import_module("scipy.sparse")
csgraph: Any = importlib.import_module("scipy.sparse.csgraph")

Mask = NDArray[np.bool_]
Lengths = NDArray[np.float64]
Step = tuple[int, int]
"""Columns and rows."""


def clearances(blocked: Mask, resolution_m: float) -> Lengths:
    """From the centre of each cell to that of the nearest blocked one, m."""
    return np.asarray(ndimage.distance_transform_edt(~blocked), dtype=np.float64) * resolution_m


def way_lengths(
    passable: Mask, steps: tuple[Step, ...], goal: tuple[int, int], resolution_m: float
) -> Lengths:
    """From each cell the length of the shortest way to the goal's (row, column), m; infinite where there is
    none. Ways go from passable cell to passable cell by the steps, ahead or backwards; no step may lead out
    of the array from a passable cell.
    """
    width = passable.shape[1]
    rows, columns = np.nonzero(passable)
    starts: list[NDArray[np.int64]] = []
    ends: list[NDArray[np.int64]] = []
    lengths: list[Lengths] = []
    for dx, dy in steps:
        both = passable[rows + dy, columns + dx]
        starts.append(rows[both] * width + columns[both])
        ends.append((rows[both] + dy) * width + columns[both] + dx)
        lengths.append(np.full(len(starts[-1]), math.hypot(dx, dy) * resolution_m))
    edges = (np.concatenate(lengths), (np.concatenate(starts), np.concatenate(ends)))
    graph = sparse.coo_array(edges, shape=(passable.size, passable.size)).tocsr()
    found = csgraph.dijkstra(graph, directed=False, indices=goal[0] * width + goal[1])
    return np.asarray(found, dtype=np.float64).reshape(passable.shape)
