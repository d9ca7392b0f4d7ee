"""Sampling of exact trajectories at a fixed rate."""

from __future__ import annotations

import math

import numpy as np

from xei_lang.ir.timed import Knots, Row, Samples
from xei_lang.motion.paths.joint_path import Array, JointPath


def evaluate(knots: Knots, t: Array) -> tuple[Array, Array, Array]:
    """Positions, velocities and accelerations (m, n) at times t (m,) from the goal's start.

    Clipped to its duration.
    """
    times = np.array(knots.times_s)
    index = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
    w = np.clip(t, 0.0, times[-1]) - times[index]
    dds = np.array(knots.dds)[index]
    ds = np.array(knots.ds)[index] + dds * w
    s = np.array(knots.s)[index] + np.array(knots.ds)[index] * w + 0.5 * dds * w**2
    path = JointPath((), np.array(knots.breaks), np.array(knots.coefficients), "")
    slope = path.evaluate(s, 1)
    velocity = slope * ds[:, None]
    acceleration = path.evaluate(s, 2) * (ds**2)[:, None] + slope * dds[:, None]
    return path.evaluate(s, 0), velocity, acceleration


def sample(knots: Knots, start_s: float, rate_hz: float) -> Samples:
    """The trajectory at multiples of `1 / rate_hz` from its start, and at its very end.

    Times from the plan's start.
    """
    duration = knots.times_s[-1]
    count = math.floor(duration * rate_hz * (1.0 + 1e-12)) + 1
    t = np.arange(count) / rate_hz
    if duration - t[-1] > 1e-9:
        t = np.append(t, duration)
    else:
        t[-1] = duration
    position, velocity, acceleration = evaluate(knots, t)
    return Samples(tuple((start_s + t).tolist()), _rows(position), _rows(velocity), _rows(acceleration))


def _rows(values: Array) -> tuple[Row, ...]:
    return tuple(tuple(row) for row in values.tolist())
