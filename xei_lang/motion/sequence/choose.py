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
Ints = NDArray[np.intp]


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
        slowest = np.zeros((len(q_from), len(q_to)))
        for joint in range(q_from.shape[1]):
            # A joint at a time, into one array: layers of thousands would else fill gigabytes.
            distance = np.abs(q_to[None, :, joint] - q_from[:, None, joint])
            np.maximum(slowest, self._of_joint(joint, distance), out=slowest)
        return slowest

    def of_distance(self, distance: Array) -> Array:
        """Lower bound (...) of the rest-to-rest time over distances (..., n) of the joints."""
        slowest = np.zeros(distance.shape[:-1])
        for joint in range(distance.shape[-1]):
            np.maximum(slowest, self._of_joint(joint, distance[..., joint]), out=slowest)
        return slowest

    def _of_joint(self, joint: int, distance: Array) -> Array:
        velocity, acceleration = float(self.velocity[joint]), float(self.acceleration[joint])
        short = 2.0 * np.sqrt(distance / acceleration)
        long = distance / velocity + velocity / acceleration
        fastest: Array = np.where(distance < velocity**2 / acceleration, short, long)
        return fastest


@dataclass(frozen=True, slots=True)
class Stage:
    """One layer: where its candidates are entered and left (n, joints), what each costs in seconds, which
    still hold.
    """

    entry: Array
    exit: Array
    cost: Array
    alive: Bools


@dataclass(frozen=True, slots=True)
class _Step:
    """Into a stage: the totals (a,) that it was reckoned from, and for each candidate the least total (b,) on
    the way in and the index (b,) that it comes from.
    """

    before: Array
    least: Array
    origin: Ints


class Runs:
    """The dynamic programme, asked again while candidates are struck out and ways become dearer: what has not
    changed since the last question is not reckoned again.
    """

    def __init__(self, transitions: tuple[Array, ...]) -> None:
        self._transitions = transitions
        self._known: dict[int, _Step] = {}

    def changed(self, transition: int) -> None:
        """The costs of this transition were changed."""
        self._known.pop(transition, None)

    def cheapest(self, stages: tuple[Stage, ...]) -> tuple[int, ...] | None:
        """The index of the chosen candidate at each stage, or None where no run holds."""
        total = _own_cost(stages[0])
        for index, stage in enumerate(stages[1:]):
            self._known[index] = self._step(index, total)
            total = self._known[index].least + _own_cost(stage)
        last = int(np.argmin(total))
        if not np.isfinite(total[last]):
            return None
        run = [last]
        for index in reversed(range(len(stages) - 1)):
            run.append(int(self._known[index].origin[run[-1]]))
        return tuple(reversed(run))

    def _step(self, index: int, total: Array) -> _Step:
        known, transition = self._known.get(index), self._transitions[index]
        if known is None or bool((total < known.before).any()):
            through = total[:, None] + transition
            origin = np.argmin(through, axis=0)
            return _Step(total, through[origin, np.arange(len(origin))], origin)
        # Totals have only grown: the way in changes for those alone that came from where they did.
        again = np.flatnonzero((total > known.before)[known.origin])
        if len(again) == 0:
            return _Step(total, known.least, known.origin)
        least, origin = known.least.copy(), known.origin.copy()
        through = total[:, None] + transition[:, again]
        origin[again] = np.argmin(through, axis=0)
        least[again] = through[origin[again], np.arange(len(again))]
        return _Step(total, least, origin)


def cheapest(stages: tuple[Stage, ...], transitions: tuple[Array, ...]) -> tuple[int, ...] | None:
    """`Runs.cheapest`, asked once."""
    return Runs(transitions).cheapest(stages)


def _own_cost(stage: Stage) -> Array:
    return np.where(stage.alive, stage.cost, np.inf)
