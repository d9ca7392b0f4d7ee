"""The quickest way over a lattice of cells and sixteen headings: A* with the base's outline at each move.

Moves are a cell (or a knight's move) ahead or backwards along the heading, and a turn in place to the next
heading; each is checked with the cells that its sweep covers. Bounded by the number of states, not by time.
After M. Likhachev and D. Ferguson, "Planning Long Dynamically Feasible Maneuvers for Autonomous Vehicles",
Int. J. Robotics Research 28(8), 2009, with motions that are straight or in place only.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.world.map.distances import clearances, way_lengths
from xei_lang.world.map.drive import Floor, straight_way
from xei_lang.world.map.footprint import convex_hull
from xei_lang.world.map.grid import FREE, Indices
from xei_lang.world.map.sweep import Station, covered_cells, turn_outlines

_STEPS = ((1, 0), (2, 1), (1, 1), (1, 2), (0, 1), (-1, 2), (-1, 1), (-2, 1))
"""Columns and rows of a step for the headings of half a turn; those of the other half are its backwards."""

HEADINGS = 16
_NEAR = 4
_YAWS = tuple(math.atan2(dy, dx) + (math.pi if k >= 8 else 0.0) for k in range(HEADINGS)
              for dx, dy in (_STEPS[k % 8],))  # fmt: skip

Node = tuple[int, int, int]
"""Row, column and heading."""


def search(floor: Floor, start: Station, goal: Station) -> tuple[Station, ...] | None:
    """The poses of the quickest way from start to goal, or None.

    Each end is joined to the node near it that is reached soonest by a turn, a leg and a turn, from which
    the base can go on.
    """
    lattice = _Lattice.of(floor)
    first, last = _joined(lattice, start), _joined(lattice, goal)
    if first is None or last is None:
        return None
    nodes = _a_star(lattice, first[0], last[0])
    if nodes is None:
        return None
    return (*first[1], *(lattice.pose(node) for node in nodes), *last[1][::-1])


def _joined(lattice: _Lattice, station: Station) -> tuple[Node, tuple[Station, ...]] | None:
    """The node that a stand is joined to, and the way there; None where none is free."""
    floor, near = lattice.floor, lattice.near(station)
    for node in sorted(near, key=lambda one: (floor.seconds((station, lattice.pose(one))), one)):
        if lattice.moves(node) and (way := straight_way(floor, station, lattice.pose(node))):
            return node, way
    return None


@dataclass(frozen=True, slots=True, eq=False)
class _Lattice:
    """The tables of a search. `clear_m` is how far the centre of a cell is from the next one that is not
    free; `legs` and `turns` are the cells (relative row and column) that the move ahead, and the turn to the
    next heading, cover.
    """

    floor: Floor
    blocked: NDArray[np.bool_]
    clear_m: NDArray[np.float64]
    legs: tuple[Indices, ...]
    turns: tuple[Indices, ...]
    yaws: tuple[float, ...]

    @classmethod
    def of(cls, floor: Floor) -> _Lattice:
        resolution_m = floor.grid.resolution_m
        # A cell of margin, so that the outside, which is unknown, is never walked on.
        margin = math.ceil(2.0 * floor.footprint.circumscribed_m / resolution_m) + 3
        blocked = np.pad(floor.grid.cells != FREE, margin, constant_values=True)
        clear = clearances(blocked, resolution_m)
        legs = tuple(_leg_cells(floor, k) for k in range(HEADINGS))
        turns = tuple(_turn_cells(floor, k) for k in range(HEADINGS))
        return cls(floor, blocked, clear, legs, turns, _YAWS)

    @property
    def margin(self) -> int:
        return (self.blocked.shape[0] - self.floor.grid.cells.shape[0]) // 2

    def near(self, station: Station) -> list[Node]:
        """Nodes near a pose: cells of the map about it, with the headings next to its own."""
        grid = self.floor.grid
        row, column = (int(index) + self.margin for index in grid.cells_at(np.array([station[:2]]))[0])
        yaw = station[2] - grid.origin[2]
        headings = sorted(range(HEADINGS), key=lambda k: abs(math.remainder(_YAWS[k] - yaw, math.tau)))[:3]
        height, width = grid.shape
        about = range(-_NEAR, _NEAR + 1)
        rows = [row + dy for dy in about if 0 <= row + dy - self.margin < height]
        columns = [column + dx for dx in about if 0 <= column + dx - self.margin < width]
        return [(r, c, k) for r in rows for c in columns for k in headings]

    def pose(self, node: Node) -> Station:
        grid = self.floor.grid
        cell = np.array([[node[0] - self.margin, node[1] - self.margin]])
        x, y = grid.centers_of(cell)[0]
        return float(x), float(y), math.remainder(_YAWS[node[2]] + grid.origin[2], math.tau)

    def distances(self, goal: Node) -> NDArray[np.float64]:
        """For each cell the length of the shortest way to the goal's by steps of the lattice, m, for a disc
        that fits into the outline: never more than what the base has to drive.
        """
        # A bound on what `is_free` refuses outright, so that no move is lost.
        passable = self.clear_m >= self.floor.footprint.inscribed_m - self.floor.grid.resolution_m
        passable[goal[0], goal[1]] = True
        passable[:2], passable[-2:], passable[:, :2], passable[:, -2:] = False, False, False, False
        return way_lengths(passable, _STEPS, goal[:2], self.floor.grid.resolution_m)

    def is_free(self, row: int, column: int, cells: Indices, reach_m: float, least_m: float) -> bool:
        """Whether a move from a cell stays on free floor: by the distance alone, where that tells."""
        clear_m = self.clear_m[row, column]
        if clear_m > reach_m:
            return True
        if clear_m < least_m:
            return False
        return not self.blocked[cells[:, 0] + row, cells[:, 1] + column].any()

    def moves(self, node: Node) -> list[tuple[Node, float]]:
        """What can be reached in one move, with the seconds that it takes."""
        row, column, heading = node
        floor, outline, resolution_m = self.floor, self.floor.footprint, self.floor.grid.resolution_m
        far_m, near_m = outline.circumscribed_m + 2.0 * resolution_m, outline.inscribed_m - resolution_m
        found: list[tuple[Node, float]] = []
        dx, dy = _step(heading)
        length_m = math.hypot(dx, dy) * resolution_m
        for sign in (1, -1):
            to = (row + sign * dy, column + sign * dx, heading)
            at = (row, column) if sign > 0 else to[:2]
            if self.is_free(*at, self.legs[heading], far_m + length_m, near_m):
                found.append((to, length_m / floor.speed_m_s))
        for other, table in (((heading + 1) % HEADINGS, heading), ((heading - 1) % HEADINGS, heading - 1)):
            turn = abs(math.remainder(_YAWS[other] - _YAWS[heading], math.tau))
            if self.is_free(row, column, self.turns[table % HEADINGS], far_m, near_m):
                found.append(((row, column, other), turn / floor.turn_rad_s))
        return found


def _a_star(lattice: _Lattice, first: Node, last: Node) -> list[Node] | None:
    floor, away_m = lattice.floor, lattice.distances(last)

    def least(node: Node) -> float:
        turn = abs(math.remainder(_YAWS[node[2]] - _YAWS[last[2]], math.tau))
        return float(away_m[node[0], node[1]]) / floor.speed_m_s + turn / floor.turn_rad_s

    if math.isinf(least(first)):
        return None

    best: dict[Node, float] = {first: 0.0}
    came: dict[Node, Node] = {}
    closed: set[Node] = set()
    queue: list[tuple[float, Node]] = [(least(first), first)]
    while queue:
        _, node = heapq.heappop(queue)
        if node == last:
            return _back(came, node)
        if node in closed:
            continue
        closed.add(node)
        for to, cost in lattice.moves(node):
            total = best[node] + cost
            if to not in closed and total < best.get(to, math.inf) - 1e-12:
                best[to], came[to] = total, node
                heapq.heappush(queue, (total + least(to), to))
    return None


def _back(came: dict[Node, Node], node: Node) -> list[Node]:
    way = [node]
    while way[-1] in came:
        way.append(came[way[-1]])
    return way[::-1]


def _step(heading: int) -> tuple[int, int]:
    dx, dy = _STEPS[heading % 8]
    return (dx, dy) if heading < 8 else (-dx, -dy)


def _leg_cells(floor: Floor, heading: int) -> Indices:
    resolution_m = floor.grid.resolution_m
    x = y = resolution_m / 2.0
    dx, dy = _step(heading)
    ends = [*floor.footprint.at(x, y, _YAWS[heading])]
    ends += floor.footprint.at(x + dx * resolution_m, y + dy * resolution_m, _YAWS[heading])
    return covered_cells(convex_hull(ends), resolution_m)


def _turn_cells(floor: Floor, heading: int) -> Indices:
    resolution_m = floor.grid.resolution_m
    center = (resolution_m / 2.0, resolution_m / 2.0)
    turn = math.remainder(_YAWS[(heading + 1) % HEADINGS] - _YAWS[heading], math.tau)
    swept = turn_outlines(floor.footprint, center, _YAWS[heading], turn)
    cells = np.concatenate([covered_cells(outline, resolution_m) for outline in swept])
    return np.unique(cells, axis=0)
