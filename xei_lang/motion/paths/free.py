"""Collision-free paths between two configurations: the straight line, or RRT-Connect, shortcuts, rounding."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from xei_lang.motion.paths.joint_path import Array, JointPath, blended_path, line_path
from xei_lang.motion.paths.rrt_connect import rrt_connect
from xei_lang.motion.paths.space import FreeSpace

SHORTCUTS = 80
BLEND_FRACTIONS = (0.45, 0.2, 0.08, 0.02)
_BLEND_SAMPLES = 12


@dataclass(frozen=True, slots=True)
class PathBlocked:
    """No path was found: which two bodies met, and whether at the start, the goal or between.

    `bodies` is None where nothing is met: then the straight way leaves the range of the joints.
    """

    where: str
    bodies: tuple[str, str] | None


@dataclass(frozen=True, slots=True)
class FreePath:
    """A path without collisions, and which planner found it (`line` or `rrt-connect`)."""

    path: JointPath
    planner: str


def plan_free_path(
    space: FreeSpace, q_start: Array, q_goal: Array, seed: int, max_checks: int = 20_000
) -> FreePath | PathBlocked:
    """A C2 path of the moving joints from `q_start` to `q_goal` (n,), free of collision.

    A pure function of its arguments: the search stops after `max_checks` edges, never on the clock.
    """
    for where, q in (("start", q_start), ("goal", q_goal)):
        bodies = space.contact(q)
        if bodies is not None:
            return PathBlocked(where, bodies)
    if space.edge_is_free(q_start, q_goal):
        return FreePath(line_path(space.joints, q_start, q_goal), "line")
    waypoints = rrt_connect(space, q_start, q_goal, seed, max_checks)
    if waypoints is None:
        return PathBlocked("between", _first_contact(space, q_start, q_goal))
    waypoints = shortcut(space, waypoints, seed)
    return FreePath(round_corners(space, waypoints), "rrt-connect")


def shortcut(space: FreeSpace, waypoints: Array, seed: int) -> Array:
    """Replace stretches of a polyline (m, n) by free straight lines while that saves time."""
    random = np.random.default_rng(seed)
    points = [*waypoints]
    for _ in range(SHORTCUTS):
        if len(points) < 3:
            break
        lengths = np.array([_time(space, a, b) for a, b in pairwise(points)])
        ends = np.concatenate([[0.0], np.cumsum(lengths)])
        first, last = sorted(random.uniform(0.0, ends[-1], 2).tolist())
        i, j = (min(bisect_right(ends.tolist(), x), len(lengths)) - 1 for x in (first, last))
        if i == j:
            continue
        a = _between(points[i], points[i + 1], (first - ends[i]) / lengths[i])
        b = _between(points[j], points[j + 1], (last - ends[j]) / lengths[j])
        if _time(space, a, b) < (last - first) - 1e-9 and space.edge_is_free(a, b):
            points = [*points[: i + 1], a, b, *points[j + 1 :]]
            points = _drop_repeats(points)
    return np.stack(points)


def round_corners(space: FreeSpace, waypoints: Array) -> JointPath:
    """The polyline with its corners rounded as far as they stay free; the tightest is kept in any case,

    since it leaves the checked polyline by less than `BLEND_FRACTIONS[-1]` of a segment.
    """
    path = blended_path(space.joints, waypoints, BLEND_FRACTIONS[0])
    for fraction in BLEND_FRACTIONS:
        path = blended_path(space.joints, waypoints, fraction)
        if _corners_are_free(space, path):
            break
    return path


def _corners_are_free(space: FreeSpace, path: JointPath) -> bool:
    for i in range(1, len(path.breaks) - 1, 2):
        start, end = float(path.breaks[i]), float(path.breaks[i + 1])
        q = path.evaluate(np.linspace(start, end, _BLEND_SAMPLES), 0)
        if not all(space.edge_is_free(a, b) for a, b in pairwise(q)):
            return False
    return True


def _time(space: FreeSpace, a: Array, b: Array) -> float:
    """Seconds that the slowest joint needs at its full speed."""
    return float(np.max(np.abs(b - a) / space.speed))


def _between(a: Array, b: Array, share: float) -> Array:
    return a + min(max(share, 0.0), 1.0) * (b - a)


def _drop_repeats(points: list[Array]) -> list[Array]:
    kept = [points[0]]
    kept.extend(b for a, b in pairwise(points) if np.max(np.abs(b - a)) > 1e-9)
    return kept


def _first_contact(space: FreeSpace, q_start: Array, q_goal: Array) -> tuple[str, str] | None:
    """The bodies that meet first on the straight line: the likeliest thing in the way."""
    for share in np.linspace(0.0, 1.0, 200):
        bodies = space.contact(_between(q_start, q_goal, float(share)))
        if bodies is not None:
            return bodies
    return None
