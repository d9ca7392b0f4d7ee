"""Weighted least squares over X and Z, with the noise estimated from residuals, and the covariance of X."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from xei_lang.world.calibration.residuals import Linear, corner_residuals, moved, pose_residuals
from xei_lang.world.calibration.sample import Sample
from xei_lang.world.perception.optics import Array

_ITERATIONS = 30
_DONE = 1e-11
"""A step (m, rad) that is none."""
_ROUNDS = 6
_FLOOR = {"position": 1e-7, "rotation": 1e-7, "pixel": 1e-5}
"""Noise (m, rad, px) is never taken to be less, so that exact data have a weight."""


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """`X` and `Z` (4, 4); `covariance` (6, 6) of a small motion on the right of X, translation (m) before
    rotation (rad).

    `noise` is the standard deviation of one residual: of `position` (m) and `rotation` (rad), or of a
    `pixel`. `errors` (m,) are the residuals in these units, `kinds` (m,) which each is.
    """

    X: Array
    Z: Array
    covariance: Array
    noise: dict[str, float]
    errors: Array
    kinds: Array
    rows: tuple[int, ...]

    def worst_sample(self) -> int:
        """The index of the sample with the largest normalised residual."""
        weighted = self.errors / np.array([self.noise[kind] for kind in self.kinds])
        ends = np.cumsum(self.rows)[:-1]
        return int(np.argmax([(part**2).mean() for part in np.split(weighted, ends)]))


def fit(samples: Sequence[Sample], start: tuple[Array, Array], focal_px: float) -> Fit:
    """The fit of all samples, from a start `(X, Z)`.

    Position and rotation are weighted by their own noise, which is estimated from the residuals and their
    redundancy in turn with the fit (Foerstner's variance components).
    """
    linear, kinds, rows = residuals_of(samples, focal_px)
    names = sorted(set(kinds.tolist()))
    noise = dict.fromkeys(names, 1.0)
    poses = start
    errors, jacobian = linear(*poses)
    for _ in range(_ROUNDS if len(names) > 1 else 1):
        weights = np.array([1.0 / noise[kind] for kind in kinds])
        poses = _solve(linear, poses, weights)
        errors, jacobian = linear(*poses)
        weighted = jacobian * weights[:, None]
        inverse = np.linalg.pinv(weighted.T @ weighted)
        leverage = np.einsum("ij,jk,ik->i", weighted, inverse, weighted)
        for name in names:
            own = kinds == name
            redundancy = max(float((1.0 - leverage[own]).sum()), 1.0)
            noise[name] = max(float(np.sqrt((errors[own] ** 2).sum() / redundancy)), _FLOOR[name])
    weighted = jacobian / np.array([noise[kind] for kind in kinds])[:, None]
    covariance: Array = np.linalg.pinv(weighted.T @ weighted)[:6, :6].astype(np.float64)
    return Fit(*poses, covariance, noise, errors, kinds, rows)


def residuals_of(samples: Sequence[Sample], focal_px: float) -> tuple[Linear, Array, tuple[int, ...]]:
    """The residuals of samples, the kind of each, and how many each sample has."""
    if samples[0].is_pixels:
        rows = tuple(2 * len(sample.rays) for sample in samples)
        return corner_residuals(samples, focal_px), np.full(sum(rows), "pixel"), rows
    one = np.array(["position"] * 3 + ["rotation"] * 3)
    return pose_residuals(samples), np.tile(one, len(samples)), (6,) * len(samples)


def _solve(linear: Linear, poses: tuple[Array, Array], weights: Array) -> tuple[Array, Array]:
    """Levenberg's damped Gauss-Newton until steps are within rounding."""
    errors, jacobian = linear(*poses)
    cost, damping = float(((errors * weights) ** 2).sum()), 1e-9
    for _ in range(_ITERATIONS):
        weighted = jacobian * weights[:, None]
        scale = np.linalg.norm(weighted, axis=0) + 1e-300
        stacked = np.vstack([weighted / scale, np.sqrt(damping) * np.eye(12)])
        values = np.concatenate([-errors * weights, np.zeros(12)])
        step = np.linalg.lstsq(stacked, values, rcond=None)[0] / scale
        ahead = moved(poses[0], step[:6]), moved(poses[1], step[6:])
        new_errors, new_jacobian = linear(*ahead)
        new_cost = float(((new_errors * weights) ** 2).sum())
        if new_cost <= cost:
            is_done = float(np.abs(step).max()) < _DONE or cost - new_cost <= 1e-15 * cost
            poses, errors, jacobian, cost = ahead, new_errors, new_jacobian, new_cost
            damping = max(damping * 0.1, 1e-15)
            if is_done:
                break
        else:
            damping *= 100.0
            if damping > 1e3:
                break
    return poses
