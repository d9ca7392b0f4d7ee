"""Geometric paths in joint space: piecewise polynomials in a path position s, exact and cheap to evaluate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_MIN_LENGTH = 1e-9


@dataclass(frozen=True, slots=True)
class JointPath:
    """A path over named joints: on piece i, `q(s) = sum_k coefficients[i, k] * (s - breaks[i])**k`.

    `breaks` has shape (P+1,), ascending from 0; `coefficients` has shape (P, K, n). Every path made here is
    at least C1, so that TOPP-RA can follow it without stopping; `kind` tells how it came about (`line`,
    `blend`, `spline`).
    """

    joints: tuple[str, ...]
    breaks: Array
    coefficients: Array
    kind: str

    @property
    def length(self) -> float:
        """The largest path position."""
        return float(self.breaks[-1])

    @property
    def start(self) -> Array:
        """Joint positions at s = 0, shape (n,)."""
        return self.evaluate(np.zeros(1), 0)[0]

    @property
    def end(self) -> Array:
        """Joint positions at the end, shape (n,)."""
        return self.evaluate(self.breaks[-1:], 0)[0]

    def evaluate(self, s: Array, order: int) -> Array:
        """Positions (order 0) or derivatives by s (order 1, 2) at path positions (m,): shape (m, n)."""
        piece = np.clip(np.searchsorted(self.breaks, s, side="right") - 1, 0, len(self.breaks) - 2)
        u = (s - self.breaks[piece])[:, None]
        coefficients = self.coefficients[piece]
        degree = coefficients.shape[1] - 1
        total = np.zeros((len(s), coefficients.shape[2]))
        for k in range(degree, order - 1, -1):
            factor = float(np.prod(np.arange(k - order + 1, k + 1))) if order else 1.0
            total = total * u + factor * coefficients[:, k]
        return total

    def sampled(self, step: float) -> Array:
        """Positions at most `step` apart in s, both ends included: shape (m, n)."""
        count = max(2, int(np.ceil(self.length / step)) + 1)
        return self.evaluate(np.linspace(0.0, self.length, count), 0)


def line_path(joints: tuple[str, ...], q_start: Array, q_end: Array) -> JointPath:
    """The straight line between two joint positions of shape (n,); s is the Euclidean length."""
    length = max(float(np.linalg.norm(q_end - q_start)), _MIN_LENGTH)
    coefficients = np.stack([q_start, (q_end - q_start) / length])[None]
    return JointPath(joints, np.array([0.0, length]), coefficients, "line")


def blended_path(joints: tuple[str, ...], waypoints: Array, blend_fraction: float = 0.45) -> JointPath:
    """Straight lines through waypoints of shape (m, n) with rounded corners, C2.

    Within `blend_fraction` of the shorter neighbouring segment, the direction turns from one line to the
    next by the smooth step `3 x^2 - 2 x^3`. A corner stays inside the triangle that its waypoint and its two
    ends span.
    """
    waypoints = _without_repeats(waypoints)
    if len(waypoints) < 3:
        return line_path(joints, waypoints[0], waypoints[-1])
    delta = np.diff(waypoints, axis=0)
    lengths = np.linalg.norm(delta, axis=1)
    directions = delta / lengths[:, None]
    radii = np.concatenate([[0.0], blend_fraction * np.minimum(lengths[:-1], lengths[1:]), [0.0]])
    breaks: list[float] = [0.0]
    pieces: list[Array] = []
    zero = np.zeros(waypoints.shape[1])
    for i, direction in enumerate(directions):
        straight = lengths[i] - radii[i] - radii[i + 1]
        start = waypoints[i] + radii[i] * direction
        pieces.append(np.stack([start, direction, zero, zero, zero]))
        breaks.append(breaks[-1] + straight)
        if i + 1 < len(directions):
            width = 2.0 * radii[i + 1]
            turn = directions[i + 1] - direction
            corner = waypoints[i + 1] - radii[i + 1] * direction
            pieces.append(np.stack([corner, direction, zero, turn / width**2, -turn / (2.0 * width**3)]))
            breaks.append(breaks[-1] + width)
    return JointPath(joints, np.array(breaks), np.stack(pieces), "blend")


def spline_path(joints: tuple[str, ...], waypoints: Array) -> JointPath:
    """The natural cubic spline through waypoints of shape (m, n) over chord length, C2."""
    from scipy.interpolate import CubicSpline  # pyright: ignore[reportMissingTypeStubs]

    waypoints = _without_repeats(waypoints)
    if len(waypoints) < 3:
        return line_path(joints, waypoints[0], waypoints[-1])
    breaks = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(waypoints, axis=0), axis=1))])
    spline = CubicSpline(breaks, waypoints, bc_type="natural")
    coefficients = np.ascontiguousarray(np.transpose(spline.c[::-1], (1, 0, 2)))
    return JointPath(joints, breaks, coefficients, "spline")


def _without_repeats(waypoints: Array) -> Array:
    """Drop waypoints that repeat the one before; a path that never moves keeps its two ends."""
    steps = np.linalg.norm(np.diff(waypoints, axis=0), axis=1)
    kept = waypoints[np.concatenate([[True], steps > _MIN_LENGTH])]
    return kept if len(kept) > 1 else waypoints[[0, -1]]
