"""The verifier's own evaluator of `Knots`: position, velocity and acceleration at any time, vectorised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.timed import Knots

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Motion:
    """Knots as arrays: `coefficients` is (pieces, powers, joints); the rest as in `Knots`."""

    breaks: Array
    coefficients: Array
    times: Array
    s: Array
    ds: Array
    dds: Array

    @staticmethod
    def of(knots: Knots) -> Motion:
        """The arrays of well-formed knots; pieces of lower degree are filled up with zeros."""
        powers = max(len(piece) for piece in knots.coefficients)
        joints = len(knots.coefficients[0][0])
        coefficients = np.zeros((len(knots.coefficients), powers, joints))
        for index, piece in enumerate(knots.coefficients):
            coefficients[index, : len(piece)] = piece
        rows = (knots.breaks, knots.times_s, knots.s, knots.ds, knots.dds)
        breaks, times, s, ds, dds = (np.asarray(row, dtype=float) for row in rows)
        return Motion(breaks, coefficients, times, s, ds, dds)

    @property
    def duration_s(self) -> float:
        """Time of the last knot, from the goal's start."""
        return float(self.times[-1])

    def phase(self, t: Array, left: bool = False) -> tuple[Array, Array, Array]:
        """`s`, `ds/dt` and `d2s/dt2` at times t; `left` takes the limit from before where t is a knot."""
        side = "left" if left else "right"
        index = np.clip(np.searchsorted(self.times, t, side=side) - 1, 0, len(self.dds) - 1)
        w = t - self.times[index]
        s = self.s[index] + w * (self.ds[index] + 0.5 * w * self.dds[index])
        return s, self.ds[index] + w * self.dds[index], self.dds[index]

    def at(self, t: Array, left: bool = False) -> tuple[Array, Array, Array]:
        """Positions, velocities and accelerations (times, joints) at times t from the goal's start, by the
        chain rule."""
        s, sd, sdd = self.phase(t, left)
        side = "left" if left else "right"
        piece = np.clip(np.searchsorted(self.breaks, s, side=side) - 1, 0, len(self.breaks) - 2)
        u = (s - self.breaks[piece])[:, None]
        powers = self.coefficients.shape[1]
        shape = (len(t), self.coefficients.shape[2])
        q, q1, q2 = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        for power in range(powers - 1, -1, -1):
            q2 = q2 * u + 2.0 * q1
            q1 = q1 * u + q
            q = q * u + self.coefficients[piece, power]
        sd, sdd = sd[:, None], sdd[:, None]
        return q, q1 * sd, q2 * sd * sd + q1 * sdd

    def ends(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Position and velocity at the start and at the end."""
        first, last = self.at(np.array([0.0])), self.at(np.array([self.duration_s]), left=True)
        return (first[0][0], first[1][0]), (last[0][0], last[1][0])

    def critical_times(self) -> Array:
        """Knots, the middles between them, and when the path passes from piece to piece: where extremes
        hide."""
        middles = 0.5 * (self.times[1:] + self.times[:-1])
        crossings = np.interp(self.breaks[1:-1], np.maximum.accumulate(self.s), self.times)
        return np.unique(np.concatenate([self.times, middles, crossings]))


def grid(start_s: float, end_s: float, rate_hz: float) -> Array:
    """Times from start to end, both included, no further apart than one period."""
    count = max(1, int(np.ceil((end_s - start_s) * rate_hz - 1e-9)))
    return np.linspace(start_s, end_s, count + 1)
