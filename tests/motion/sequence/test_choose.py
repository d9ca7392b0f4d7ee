"""The dynamic programme against trying every run."""

from __future__ import annotations

import itertools

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.motion.sequence.choose import Runs, Speeds, Stage, cheapest


def stages_and_costs(seed: int, sizes: list[int]) -> tuple[tuple[Stage, ...], tuple[np.ndarray, ...]]:
    random = np.random.default_rng(seed)
    stages = tuple(
        Stage(np.zeros((n, 1)), np.zeros((n, 1)), random.uniform(0, 1, n), random.uniform(0, 1, n) > 0.2)
        for n in sizes
    )
    costs = tuple(
        np.where(random.uniform(0, 1, (a, b)) < 0.2, np.inf, random.uniform(0, 1, (a, b)))
        for a, b in itertools.pairwise(sizes)
    )
    return stages, costs


def total(stages: tuple[Stage, ...], costs: tuple[np.ndarray, ...], run: tuple[int, ...]) -> float:
    own = sum(stage.cost[i] if stage.alive[i] else np.inf for stage, i in zip(stages, run, strict=True))
    return float(own + sum(cost[i, j] for cost, (i, j) in zip(costs, itertools.pairwise(run), strict=True)))


@given(st.integers(0, 10_000), st.lists(st.integers(1, 4), min_size=1, max_size=4))
def test_no_run_is_cheaper(seed: int, sizes: list[int]) -> None:
    stages, costs = stages_and_costs(seed, sizes)
    best = min(total(stages, costs, run) for run in itertools.product(*(range(n) for n in sizes)))
    run = cheapest(stages, costs)
    assert (run is None) == np.isinf(best)
    if run is not None:
        assert np.isclose(total(stages, costs, run), best)


def test_ties_go_to_the_lower_index() -> None:
    stage = Stage(np.zeros((3, 1)), np.zeros((3, 1)), np.zeros(3), np.ones(3, dtype=bool))
    assert cheapest((stage, stage), (np.zeros((3, 3)),)) == (0, 0)


def test_travel_time_is_that_of_a_trapezoid_and_of_a_triangle() -> None:
    speeds = Speeds(np.array([2.0]), np.array([4.0]))
    times = speeds.travel_s(np.zeros((1, 1)), np.array([[5.0], [0.25], [0.0]]))
    assert np.allclose(times, [[3.0, 0.5, 0.0]])


def test_slowing_down_stretches_time() -> None:
    speeds = Speeds(np.array([2.0, 1.0]), np.array([4.0, 3.0]))
    distance = np.array([[0.7, 0.1], [0.0, 4.0]])
    assert np.allclose(speeds.scaled(0.2).of_distance(distance), speeds.of_distance(distance) / 0.2)


@given(st.integers(0, 10_000), st.lists(st.integers(1, 5), min_size=2, max_size=4))
def test_asked_again_after_a_change_it_answers_as_if_asked_for_the_first_time(
    seed: int, sizes: list[int]
) -> None:
    random = np.random.default_rng(seed)
    stages, costs = stages_and_costs(seed, sizes)
    runs = Runs(costs)
    for _ in range(8):
        assert runs.cheapest(stages) == cheapest(stages, costs)
        stage, cost = int(random.integers(len(stages))), int(random.integers(len(costs)))
        stages[stage].alive[int(random.integers(sizes[stage]))] = False
        if random.uniform() < 0.3:
            costs[cost][0, 0] += 1.0
            runs.changed(cost)
    assert runs.cheapest(stages) == cheapest(stages, costs)
