"""Samples say what the knots say: both are handed on, so they must be the same motion."""

from __future__ import annotations

import numpy as np

from xei_lang.ir.timed import Samples, TimedGoal
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array

_SIDE_S = 1e-7


def check_samples(context: Context) -> None:
    """Positions, velocities and accelerations of every sample against the knots at its time.

    Accelerations jump at knots, so a sample there may take either side: it must lie between the two limits.
    """
    options = context.options
    for goal in context.plan.goals:
        motion = context.timeline.motions.get(goal.id)
        if motion is None or goal.samples is None:
            continue
        times = np.asarray(goal.samples.times_s) - goal.start_s
        before = motion.at(np.maximum(times - _SIDE_S, 0.0), left=True)
        after = motion.at(np.minimum(times + _SIDE_S, motion.duration_s))
        rows = _rows(goal.samples)
        tolerances = (options.sample_position, options.sample_velocity, options.sample_acceleration)
        names = ("position", "velocity", "acceleration")
        for name, given, low, high, slack in zip(names, rows, before, after, tolerances, strict=True):
            _compare(context, goal, name, given, (low, high), slack=slack)


def _rows(samples: Samples) -> tuple[Array, Array, Array]:
    rows = (samples.positions, samples.velocities, samples.accelerations)
    positions, velocities, accelerations = (np.asarray(row, dtype=float) for row in rows)
    return positions, velocities, accelerations


def _compare(
    context: Context, goal: TimedGoal, name: str, given: Array, sides: tuple[Array, Array], *, slack: float
) -> None:
    assert goal.samples is not None
    lower, upper = np.minimum(*sides), np.maximum(*sides)
    outside = np.maximum(lower - given, given - upper)
    row, column = (int(k) for k in np.unravel_index(int(np.argmax(outside)), outside.shape))
    if outside[row, column] > slack:
        joint, time = goal.joints[column], goal.samples.times_s[row]
        text = f"the sampled {name} of `{joint}` is not that of the knots"
        exact = float(sides[1][row, column])
        context.found("samples", goal, time, joint, text, value=float(given[row, column]), limit=exact)
