"""How the base comes from one place to another: laws that any map must keep, and ways that are known."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.world.map.lab import room, with_box
from xei_lang.world.map.drive import Floor, is_free, measures, plan_drive, straight_way
from xei_lang.world.map.footprint import Footprint, convex_hull
from xei_lang.world.map.grid import FREE, OCCUPIED, OccupancyGrid
from xei_lang.world.map.sweep import Station, covered_cells, is_turn_free, standing_cells

BASE = Footprint(((-0.37, -0.31), (0.37, -0.31), (0.37, 0.31), (-0.37, 0.31)))
SPEED, TURN = 0.3, 0.65


def floor(grid: OccupancyGrid, footprint: Footprint = BASE) -> Floor:
    return Floor(grid, footprint, SPEED, TURN)


def stations(lower=(-0.9, -2.9), upper=(0.9, 0.9)):
    return st.tuples(st.floats(lower[0], upper[0]), st.floats(lower[1], upper[1]), st.floats(-3.14, 3.14))


OBSTACLES = [
    room(),
    with_box(room(), (-0.1, 0.1), (-1.2, -1.1)),
    with_box(room(), (-1.4, 0.0), (-1.2, -1.1)),
    with_box(with_box(room(), (-1.4, -0.4), (-1.2, -1.1)), (0.4, 1.4), (-1.2, -1.1)),
]


@settings(max_examples=25)
@given(st.sampled_from(OBSTACLES), stations(), stations())
def test_a_way_is_free_begins_and_ends_where_asked_and_is_the_same_back(
    grid: OccupancyGrid, start: Station, goal: Station
) -> None:
    way = plan_drive(floor(grid), start, goal)
    back = plan_drive(floor(grid), goal, start)
    assert (way is None) == (back is None)
    if way is None or back is None:
        return
    assert back == way[::-1]
    assert (way[0], way[-1]) == (start, goal)
    assert is_free(floor(grid), way)
    length_m, turn_rad = measures(way)
    assert length_m >= math.dist(start[:2], goal[:2]) - 1e-9
    assert turn_rad >= abs(math.remainder(goal[2] - start[2], math.tau)) - 1e-9
    for a, b in pairwise(way):
        _is_driven(a, b)


def _is_driven(a: Station, b: Station) -> None:
    """A leg goes along the heading and keeps it; a turn keeps the place."""
    distance = math.dist(a[:2], b[:2])
    if distance > 1e-6:
        assert abs(math.remainder(b[2] - a[2], math.tau)) < 1e-6
        direction = math.atan2(b[1] - a[1], b[0] - a[0])
        assert abs(math.sin(direction - a[2])) * distance < 1e-6


def test_with_nothing_in_the_way_it_is_the_straight_one_of_least_time() -> None:
    way = plan_drive(floor(room()), (0.0, 0.0, 0.0), (0.0, -2.2, -math.pi / 2))
    assert way is not None
    assert measures(way) == pytest.approx((2.2, math.pi / 2))
    # Backwards, where that turns less.
    way = plan_drive(floor(room()), (0.0, -2.2, math.pi / 2), (0.0, 0.0, -math.pi / 2 + math.pi))
    assert way is not None and measures(way) == pytest.approx((2.2, 0.0))
    way = plan_drive(floor(room()), (0.5, 0.0, 0.0), (-0.5, 0.0, 0.0))
    assert way is not None and measures(way) == pytest.approx((1.0, 0.0))


def test_a_turn_in_place_is_a_way_without_length() -> None:
    way = plan_drive(floor(room()), (0.0, 0.0, 0.0), (0.0, 0.0, 2.0))
    assert way is not None and measures(way) == pytest.approx((0.0, 2.0))


def test_a_corridor_is_driven_in_and_out_where_the_base_cannot_turn() -> None:
    """0.8 m wide: the base fits along it (0.62 m) but does not turn (0.97 m)."""
    grid = with_box(with_box(room(), (-1.4, -0.4), (-3.4, -1.0)), (0.4, 1.4), (-3.4, -1.0))
    inside, outside = (0.0, -2.5, math.pi / 2), (0.0, 0.5, 0.0)
    way = plan_drive(floor(grid), inside, outside)
    assert way is not None
    assert measures(way) == pytest.approx((3.0, math.pi / 2), abs=0.1)
    assert not is_turn_free(grid, BASE, (0.0, -2.5), math.pi / 2, math.pi)
    assert plan_drive(floor(grid), inside, (0.0, 0.5, -math.pi / 2)) is not None
    assert plan_drive(floor(grid), (0.0, -2.5, -math.pi / 2), inside) is not None  # out, round and in again


def test_a_detour_is_not_much_longer_than_the_shortest() -> None:
    """Round a long box: the shortest way of the base's centre hugs the corner at its circumscribed radius."""
    grid = with_box(room(lower=(-3.0, -3.5), upper=(3.0, 1.5)), (-1.0, 1.0), (-1.2, -0.8))
    way = plan_drive(floor(grid), (0.0, 0.5, 0.0), (0.0, -2.5, 0.0))
    assert way is not None
    around = 2 * math.dist((0.0, 0.5), (1.0 + 0.31, -0.8)) + 0.4
    assert around * 0.9 < measures(way)[0] < around * 1.25


def test_nothing_is_driven_over_that_is_not_known_to_be_free() -> None:
    for value in (-1, 50, OCCUPIED):
        grid = with_box(room(), (-1.5, 1.5), (-1.2, -1.1), value=value)
        assert plan_drive(floor(grid), (0.0, 0.5, 0.0), (0.0, -2.5, 0.0)) is None
    assert plan_drive(floor(room()), (0.0, 0.0, 0.0), (0.0, 30.0, 0.0)) is None


@settings(max_examples=60)
@given(
    st.lists(st.tuples(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4)), min_size=3, max_size=8),
    st.randoms(use_true_random=False),
)
def test_the_cells_that_an_outline_covers_hold_every_point_of_it(points, random) -> None:
    hull = convex_hull(points)
    if len(hull) < 3:
        return
    covered = {tuple(cell) for cell in covered_cells(hull, 0.05).tolist()}
    inner = np.mean(hull, axis=0)
    for _ in range(50):
        weights = np.array([random.random() + 1e-3 for _ in hull])
        point = weights / weights.sum() @ np.array(hull) * 0.999 + inner * 0.001
        cell = (math.floor(point[1] / 0.05), math.floor(point[0] / 0.05))
        on_line = np.min(np.abs(point / 0.05 - np.rint(point / 0.05))) < 1e-6
        assert on_line or cell in covered
    low, high = np.min(hull, axis=0) - 0.05, np.max(hull, axis=0) + 0.05
    for row, column in covered:
        assert low[0] <= column * 0.05 <= high[0] and low[1] <= row * 0.05 <= high[1]


@settings(max_examples=40)
@given(st.floats(-3, 3), st.floats(-3, 3))
def test_a_turn_covers_every_heading_on_its_way(start: float, turn: float) -> None:
    """Wherever the base stands in between, it covers no cell that the turn was not asked about."""
    grid = OccupancyGrid(np.full((40, 40), FREE, dtype=np.int8), 0.05, (-1.0, -1.0, 0.0))
    for part in np.linspace(0.0, 1.0, 23):
        cells = standing_cells(grid, BASE, (0.01, 0.02, start + part * turn))
        row, column = cells[int(part * (len(cells) - 1))]
        blocked = grid.cells.copy()
        blocked[row, column] = OCCUPIED
        assert not is_turn_free(OccupancyGrid(blocked, 0.05, grid.origin), BASE, (0.01, 0.02), start, turn)


def test_the_grid_may_be_turned_in_the_map() -> None:
    plain = with_box(room(lower=(-2.5, -3.5)), (-0.2, 0.2), (-1.3, -1.0))
    yaw, (x, y, _) = 0.7, plain.origin
    c, s = math.cos(yaw), math.sin(yaw)
    turned = OccupancyGrid(plain.cells, plain.resolution_m, (c * x - s * y, s * x + c * y, yaw))

    def at(pose: Station) -> Station:
        return (c * pose[0] - s * pose[1], s * pose[0] + c * pose[1], pose[2] + yaw)

    ends: tuple[Station, Station] = (0.0, 0.0, 0.0), (0.0, -2.2, -math.pi / 2)
    a, b = plan_drive(floor(plain), *ends), plan_drive(floor(turned), at(ends[0]), at(ends[1]))
    assert a is not None and b is not None
    assert measures(a)[0] == pytest.approx(measures(b)[0], rel=0.05)
    assert straight_way(floor(plain), *ends) is None
