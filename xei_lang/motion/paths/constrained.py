"""Paths on which every configuration keeps a constraint, searched in joint space.

Two trees grow towards each other in short steps, each step projected back onto the constraint: CBiRRT2 of
Berenson, Srinivasa, Ferguson, Kuffner, "Manipulation Planning on Constraint Manifolds" (ICRA 2009).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from xei_lang.motion.paths.joint_path import Array
from xei_lang.motion.paths.space import FreeSpace

Project = Callable[[Array], Array | None]
"""The nearest configuration that keeps the constraint (the same one where it does already), or None."""

STEP_S = 0.12
"""Longest step, as seconds of motion at full speed."""
SHORTCUTS = 80
PROJECTIONS_PER_EDGE = 5
"""How many steps may be projected for each edge that may be looked at: from a start that hardly any step
leaves, edges alone would never be used up."""
_SAME_S = 1e-6


class _Budget:
    """How many edges may still be looked at, and how many steps projected."""

    def __init__(self, edges: int) -> None:
        self.edges = edges
        self.projections = PROJECTIONS_PER_EDGE * edges

    @property
    def lasts(self) -> bool:
        return self.edges > 0 and self.projections > 0


class _Tree:
    """Configurations (n,) and which one each was reached from."""

    def __init__(self, root: Array) -> None:
        self.nodes = [root]
        self.parents = [-1]

    def nearest(self, q: Array, speed: Array) -> int:
        return int(np.argmin(np.linalg.norm((np.stack(self.nodes) - q) / speed, axis=1)))

    def grow(self, index: int, steps: list[Array]) -> int:
        for q in steps:
            self.nodes.append(q)
            self.parents.append(index)
            index = len(self.nodes) - 1
        return index

    def branch(self, index: int) -> list[Array]:
        """From the root to a node."""
        found: list[Array] = []
        while index >= 0:
            found.append(self.nodes[index])
            index = self.parents[index]
        return found[::-1]


def constrained_connect(
    space: FreeSpace, project: Project, q_start: Array, q_goal: Array, seed: int, max_checks: int
) -> Array | None:
    """Waypoints (m, n) at most `STEP_S` apart, each keeping the constraint, with free straight lines between
    them; None once `max_checks` edges have been tried, or `PROJECTIONS_PER_EDGE` times as many steps. Both
    ends must keep the constraint. Shortening a way that was found may take half as many again.
    """
    random, budget = np.random.default_rng(seed), _Budget(max_checks)
    here, there, forward = _Tree(q_start), _Tree(q_goal), True
    target = q_goal
    while budget.lasts:
        start = here.nearest(target, space.speed)
        steps, _ = _walk(space, project, here.nodes[start], target, budget)
        end = here.grow(start, steps)
        other = there.nearest(here.nodes[end], space.speed)
        steps, met = _walk(space, project, there.nodes[other], here.nodes[end], budget)
        last = there.grow(other, steps)
        if met:
            first, second = here.branch(end), there.branch(last)[::-1]
            way = [*first, *second[1:]] if forward else [*second[::-1], *first[::-1][1:]]
            return _shortened(space, project, way, random, _Budget(max_checks // 2))
        here, there, forward = there, here, not forward
        target = random.uniform(space.lower, space.upper)
    return None


def _walk(
    space: FreeSpace, project: Project, start: Array, target: Array, budget: _Budget
) -> tuple[list[Array], bool]:
    """Steps from a configuration towards another as far as they get nearer, and whether they arrive."""
    steps: list[Array] = []
    now, left = start, _seconds(space, start, target)
    while left > _SAME_S:
        if not budget.lasts:
            return steps, False
        share = min(1.0, STEP_S / left)
        budget.projections -= 1
        following = project(now + share * (target - now))
        if following is None or _outside(space, following):
            return steps, False
        gap, step = _seconds(space, following, target), _seconds(space, now, following)
        if gap > left - 0.1 * min(STEP_S, left) or step > 2.0 * STEP_S:
            return steps, False
        budget.edges -= 1
        if not space.edge_is_free(now, following):
            return steps, False
        steps.append(following)
        now, left = following, gap
    return steps, True


def _shortened(
    space: FreeSpace, project: Project, way: list[Array], random: np.random.Generator, budget: _Budget
) -> Array:
    """The way with stretches replaced by more direct ones, while the budget lasts."""
    for _ in range(SHORTCUTS):
        if len(way) < 3:
            break
        a, b = random.integers(0, len(way), 2)
        first, last = min(int(a), int(b)), max(int(a), int(b))
        if last - first < 2:
            continue
        steps, met = _walk(space, project, way[first], way[last], budget)
        if met and _length(space, [way[first], *steps]) < _length(space, way[first : last + 1]) - 1e-9:
            way = [*way[: first + 1], *steps[:-1], *way[last:]]
    return np.stack(way)


def _seconds(space: FreeSpace, a: Array, b: Array) -> float:
    return float(np.linalg.norm((b - a) / space.speed))


def _length(space: FreeSpace, way: list[Array]) -> float:
    return sum(float(np.max(np.abs(b - a) / space.speed)) for a, b in pairwise(way))


def _outside(space: FreeSpace, q: Array) -> bool:
    return bool(np.any(q < space.lower - 1e-9) or np.any(q > space.upper + 1e-9))
