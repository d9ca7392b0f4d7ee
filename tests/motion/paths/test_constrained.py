"""Ways on a circle: every waypoint keeps to it, and the way leads round what is in the way."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.paths.constrained import PROJECTIONS_PER_EDGE, STEP_S, constrained_connect

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plane:
    """Two joints of unit speed; a wedge about the angle `wall` is not free."""

    wall: tuple[float, ...] = ()
    joints: tuple[str, ...] = ("a", "b")

    @property
    def lower(self) -> Array:
        return np.full(2, -2.0)

    @property
    def upper(self) -> Array:
        return np.full(2, 2.0)

    @property
    def speed(self) -> Array:
        return np.ones(2)

    def is_free(self, q: Array) -> bool:
        angle = float(np.arctan2(q[1], q[0]))
        return all(abs(angle - wall) > 0.1 for wall in self.wall)

    def edge_is_free(self, q_start: Array, q_end: Array) -> bool:
        return all(self.is_free(q_start + share * (q_end - q_start)) for share in np.linspace(0.0, 1.0, 20))

    def contact(self, q: Array) -> tuple[str, str] | None:
        return None if self.is_free(q) else ("point", "wall")


def onto_circle(q: Array) -> Array | None:
    radius = float(np.linalg.norm(q))
    return q / radius if radius > 0.1 else None


EAST, NORTH = np.array([1.0, 0.0]), np.array([0.0, 1.0])


def test_every_waypoint_keeps_the_constraint_and_steps_are_short() -> None:
    way = constrained_connect(Plane(), onto_circle, EAST, NORTH, 1, 500)
    assert way is not None
    assert np.array_equal(way[0], EAST)
    assert np.array_equal(way[-1], NORTH)
    assert np.allclose(np.linalg.norm(way, axis=1), 1.0)
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() <= 2.0 * STEP_S


def test_a_blocked_way_is_left_for_the_other_way_round() -> None:
    plane = Plane(wall=(np.pi / 4,))
    way = constrained_connect(plane, onto_circle, EAST, NORTH, 1, 2_000)
    assert way is not None
    assert way[:, 0].min() < -0.9
    assert all(plane.edge_is_free(a, b) for a, b in pairwise(way))


def test_the_search_ends_where_there_is_no_way() -> None:
    assert constrained_connect(Plane(wall=(np.pi / 4, -np.pi / 2)), onto_circle, EAST, NORTH, 1, 300) is None


def test_equal_seeds_give_equal_ways() -> None:
    plane = Plane(wall=(np.pi / 4,))
    ways = [constrained_connect(plane, onto_circle, EAST, NORTH, seed, 2_000) for seed in (3, 3)]
    assert ways[0] is not None
    assert ways[1] is not None
    assert np.array_equal(ways[0], ways[1])


def test_a_start_that_no_step_leaves_ends_the_search() -> None:
    tried: list[Array] = []

    def never(q: Array) -> Array | None:
        tried.append(q)

    assert constrained_connect(Plane(), never, EAST, NORTH, 1, 20) is None
    assert len(tried) == 20 * PROJECTIONS_PER_EDGE
