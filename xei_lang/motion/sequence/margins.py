"""How near a plan comes to its limits: for each kind of limit the nearest approach, and where."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.timed import Margin, TimedGoal
from xei_lang.motion.sequence.assemble import inverse_dynamics
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.motions import Motion

Array = NDArray[np.float64]

_TORQUE_STRIDE = 5


def margins(
    context: Context, motions: tuple[Motion, ...], goals: tuple[TimedGoal, ...]
) -> tuple[Margin, ...]:
    """The largest share used of velocity, acceleration and torque limits, and the smallest distance to an end
    of range.

    Ratios are of the planning limits; the distance is in rad or m. Taken from the samples, torque from every
    fifth.
    """
    worst: dict[str, Margin] = {}
    for motion, goal in zip(motions, goals, strict=True):
        for margin in _of_goal(context, motion, goal):
            known = worst.get(margin.name)
            if known is None or _nearer(margin, known):
                worst[margin.name] = margin
    return tuple(worst[name] for name in sorted(worst))


def _nearer(margin: Margin, known: Margin) -> bool:
    return margin.value < known.value if margin.name == "joint range" else margin.value > known.value


def _of_goal(context: Context, motion: Motion, goal: TimedGoal) -> Iterator[Margin]:
    samples = goal.samples
    if samples is None:
        return
    limits = context.limits_of(goal.joints)
    q, v, a = (np.array(rows) for rows in (samples.positions, samples.velocities, samples.accelerations))
    lower, upper = np.array([row.lower for row in limits]), np.array([row.upper for row in limits])
    times = np.array(samples.times_s)
    yield _margin("velocity", np.abs(v) / [row.velocity for row in limits], goal, times)
    yield _margin("acceleration", np.abs(a) / [row.acceleration for row in limits], goal, times)
    if goal.arm is not None and goal.kind == "move_to":
        yield _margin("joint range", np.minimum(q - lower, upper - q), goal, times, smallest=True)
    pick = slice(None, None, _TORQUE_STRIDE)
    torques = np.abs(inverse_dynamics(context, motion)(q[pick], v[pick], a[pick]))
    yield _margin("torque", torques / [row.torque for row in limits], goal, times[pick])


def _margin(name: str, values: Array, goal: TimedGoal, times: Array, smallest: bool = False) -> Margin:
    flat = int(np.argmin(values) if smallest else np.argmax(values))
    row, column = divmod(flat, values.shape[1])
    return Margin(name, float(values[row, column]), goal.joints[column], goal.id, float(times[row]))
