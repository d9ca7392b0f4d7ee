"""The planner of free paths against a small world whose truth is known exactly."""

from __future__ import annotations

import numpy as np

from xei_lang.motion.paths.free import FreePath, PathBlocked, plan_free_path


class Pillar:
    """A 3-joint space with a box in the middle that can be passed on two sides."""

    joints = ("a", "b", "c")
    lower = -2.0 * np.ones(3)
    upper = 2.0 * np.ones(3)
    speed = np.array([1.0, 2.0, 2.0])
    half = np.array([0.3, 1.5, 9.0])

    def is_free(self, q: np.ndarray) -> bool:
        return bool(np.any(np.abs(q) >= self.half))

    def edge_is_free(self, q_start: np.ndarray, q_end: np.ndarray) -> bool:
        count = max(2, int(np.ceil(np.abs(q_end - q_start).max() / 0.01)) + 1)
        return all(
            self.is_free(q_start + share * (q_end - q_start)) for share in np.linspace(0.0, 1.0, count)
        )

    def contact(self, q: np.ndarray) -> tuple[str, str] | None:
        return None if self.is_free(q) else ("forearm", "pillar")


class Wall(Pillar):
    """The same space cut in two."""

    half = np.array([0.3, 9.0, 9.0])


LEFT, RIGHT = np.array([-1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])


def test_a_free_line_is_taken_as_it_is() -> None:
    found = plan_free_path(Pillar(), LEFT, np.array([-1.0, 1.5, 0.5]), seed=1)
    assert isinstance(found, FreePath)
    assert found.planner == "line"


def test_a_detour_is_found_and_is_free_to_the_last_sample() -> None:
    found = plan_free_path(Pillar(), LEFT, RIGHT, seed=1)
    assert isinstance(found, FreePath)
    assert found.planner == "rrt-connect"
    assert np.allclose(found.path.start, LEFT) and np.allclose(found.path.end, RIGHT)
    assert all(Pillar().is_free(q) for q in found.path.sampled(0.002))


def test_the_same_seed_gives_the_same_path_whatever_was_planned_before() -> None:
    first = plan_free_path(Pillar(), LEFT, RIGHT, seed=7)
    plan_free_path(Pillar(), RIGHT, LEFT, seed=8)
    again = plan_free_path(Pillar(), LEFT, RIGHT, seed=7)
    assert isinstance(first, FreePath) and isinstance(again, FreePath)
    assert np.array_equal(first.path.coefficients, again.path.coefficients)


def test_a_blocked_path_names_the_two_bodies() -> None:
    blocked = plan_free_path(Wall(), LEFT, RIGHT, seed=1, max_checks=500)
    assert blocked == PathBlocked("between", ("forearm", "pillar"))


def test_a_goal_in_collision_is_said_to_be_the_goal() -> None:
    blocked = plan_free_path(Pillar(), LEFT, np.zeros(3), seed=1)
    assert blocked == PathBlocked("goal", ("forearm", "pillar"))
