"""The joints of a whole plan at any times: what a recording of its execution would show."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.timed import Samples, TimedPlan

Array = NDArray[np.float64]


def states_at(timed: TimedPlan, times_s: Array) -> tuple[Array, Array]:
    """Positions and velocities of the joints of `timed.start`, a row for each of the rising `times_s`.

    A joint is exactly at its samples, on the cubic Hermite spline between two, and at rest between goals.
    """
    column_of = {joint: column for column, (joint, _) in enumerate(timed.start)}
    start = np.array([position for _, position in timed.start], dtype=np.float64)
    positions = np.tile(start, (len(times_s), 1))
    velocities = np.zeros_like(positions)
    moving = [(goal.joints, goal.samples) for goal in timed.goals if goal.samples is not None]
    for joints, samples in sorted(moving, key=lambda item: item[1].times_s[0]):
        columns = [column_of[joint] for joint in joints]
        first = int(np.searchsorted(times_s, samples.times_s[0]))
        after = int(np.searchsorted(times_s, samples.times_s[-1], side="right"))
        during = _spline(samples, times_s[first:after])
        positions[first:after, columns], velocities[first:after, columns] = during
        positions[after:, columns], velocities[after:, columns] = samples.positions[-1], 0.0
    return positions, velocities


def _spline(samples: Samples, times_s: Array) -> tuple[Array, Array]:
    """Rows of positions and velocities at times between the first and the last sample, both included."""
    knots, p, v = (np.array(part) for part in (samples.times_s, samples.positions, samples.velocities))
    before = np.searchsorted(knots, times_s, side="right") - 1
    after = np.minimum(before + 1, len(knots) - 1)
    at_knot = (times_s == knots[before])[:, None]
    dt = np.where(at_knot, 1.0, (knots[after] - knots[before])[:, None])
    u = (times_s - knots[before])[:, None] / dt
    p0, v0, p1, v1 = p[before], v[before], p[after], v[after]
    a, b = 3 * (p1 - p0) - dt * (2 * v0 + v1), 2 * (p0 - p1) + dt * (v0 + v1)
    position = p0 + u * (dt * v0 + u * (a + u * b))
    velocity = v0 + (2 * a + 3 * b * u) * u / dt
    return np.where(at_knot, p0, position), np.where(at_knot, v0, velocity)
