"""The cheapest run through layers of candidates, by dynamic programming (Bellman 1957); ties go to the lower
index.

Where a run needs checks that are dear (a whole linear motion against the scene, a path between two
configurations), the caller removes what failed and asks again: the answer is then the cheapest run among
those that hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Speeds:
    """Velocity and acceleration limits (n,) of joints: rad/s, rad/s2 (m/s, m/s2)."""

    velocity: Array
    acceleration: Array

    def scaled(self, fraction: float) -> Speeds:
        """The limits at a fraction of full speed: time is stretched, so accelerations go by its square."""
        return Speeds(self.velocity * fraction, self.acceleration * fraction**2)

    def travel_s(self, q_from: Array, q_to: Array) -> Array:
        """Lower bound (a, b) of the rest-to-rest time between configurations (a, n) and (b, n): the slowest
        joint's.
        """
        return self.of_distance(np.abs(q_to[None, :, :] - q_from[:, None, :]))

    def of_distance(self, distance: Array) -> Array:
        """Lower bound (...) of the rest-to-rest time over distances (..., n) of the joints."""
        ramp = self.velocity**2 / self.acceleration
        short = 2.0 * np.sqrt(distance / self.acceleration)
        long = distance / self.velocity + self.velocity / self.acceleration
        return np.where(distance < ramp, short, long).max(axis=-1)


@dataclass(frozen=True, slots=True)
class Stage:
    """One layer: where its candidates are entered and left (n, joints), what each costs in seconds, which
    still hold.
    """

    entry: Array
    exit: Array
    cost: Array
    alive: Bools


def cheapest(stages: tuple[Stage, ...], transitions: tuple[Array, ...]) -> tuple[int, ...] | None:
    """The index of the chosen candidate at each stage, or None where no run holds."""
    total = _own_cost(stages[0])
    origins: list[NDArray[np.intp]] = []
    for stage, transition in zip(stages[1:], transitions, strict=True):
        through = total[:, None] + transition
        origin = np.argmin(through, axis=0)
        total = through[origin, np.arange(len(origin))] + _own_cost(stage)
        origins.append(origin)
    last = int(np.argmin(total))
    if not np.isfinite(total[last]):
        return None
    run = [last]
    for origin in reversed(origins):
        run.append(int(origin[run[-1]]))
    return tuple(reversed(run))


def _own_cost(stage: Stage) -> Array:
    return np.where(stage.alive, stage.cost, np.inf)
