"""Residuals of a sample and their Jacobian, by casadi's automatic differentiation.

A step is `d` (12,): translation and rotation of X, then of Z, each applied on the right. A rotation vector
`w` turns by the unit quaternion along `(1, w/2)`: equal to its exponential to second order, and smooth at
zero, where the residuals are linearised again after each step.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np

from xei_lang.world.calibration.sample import Sample
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Array, matrix_of

casadi: Any = importlib.import_module("casadi")  # its stubs are incomplete

Linear = Callable[[Array, Array], tuple[Array, Array]]
"""From X and Z (4, 4) to the residuals (m,) and their Jacobian (m, 12)."""


def moved(T: Array, step: Array) -> Array:
    """A pose (4, 4) after a step (6,) of translation and rotation on its right."""
    x, y, z = step[3:] / 2.0
    n = 1.0 + x * x + y * y + z * z
    R = np.array([
        [1 + x * x - y * y - z * z, 2 * (x * y - z), 2 * (x * z + y)],
        [2 * (x * y + z), 1 - x * x + y * y - z * z, 2 * (y * z - x)],
        [2 * (x * z - y), 2 * (y * z + x), 1 - x * x - y * y + z * z],
    ]) / n  # fmt: skip
    M = np.eye(4)
    M[:3, :3], M[:3, 3] = R, step[:3]
    return T @ M


def pose_residuals(samples: Sequence[Sample]) -> Linear:
    """Of recorded poses: 3 of position (m), then 3 of rotation (rad), for each sample one after the other."""
    A = np.hstack([sample.A for sample in samples])
    B = np.hstack([sample.B for sample in samples])
    function = _pose_function().map(len(samples))

    def linear(X: Array, Z: Array) -> tuple[Array, Array]:
        return _evaluated(function, (X, Z, A, B), len(samples), 6)

    return linear


def corner_residuals(samples: Sequence[Sample], focal_px: float) -> Linear:
    """Of seen corners: 2 for each (px of an undistorted image), corner by corner and sample by sample."""
    A = np.hstack([sample.A for sample in samples for _ in sample.rays])
    points = np.concatenate([sample.points_m for sample in samples]).T
    rays = np.concatenate([sample.rays for sample in samples]).T
    count = points.shape[1]
    function = _corner_function().map(count)

    def linear(X: Array, Z: Array) -> tuple[Array, Array]:
        errors, jacobian = _evaluated(function, (X, Z, A, points, rays), count, 2)
        return focal_px * errors, focal_px * jacobian

    return linear


def _evaluated(function: Any, arguments: tuple[Array, ...], count: int, rows: int) -> tuple[Array, Array]:
    X, Z, *others = arguments
    repeated = [casadi.repmat(casadi.DM(T), 1, count) for T in (X, Z)]
    errors, jacobian = function(*repeated, *(casadi.DM(other) for other in others))
    blocks = np.asarray(jacobian).reshape(rows, count, 12).transpose(1, 0, 2)
    return np.asarray(errors).T.reshape(-1), blocks.reshape(-1, 12)


@cache
def _pose_function() -> Any:
    X, Z, A, B = (casadi.SX.sym(name, 4, 4) for name in "XZAB")
    d = casadi.SX.sym("d", 12)
    apart = _inverse(Z @ _step(d[6:])) @ A @ X @ _step(d[:6]) @ B
    R = apart[:3, :3]
    turn = casadi.vertcat(R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]) / 2
    return _at_zero((X, Z, A, B), d, casadi.vertcat(apart[:3, 3], turn))


@cache
def _corner_function() -> Any:
    X, Z, A = (casadi.SX.sym(name, 4, 4) for name in "XZA")
    point, ray, d = casadi.SX.sym("point", 3), casadi.SX.sym("ray", 2), casadi.SX.sym("d", 12)
    T_target_optical = A @ X @ _step(d[:6]) @ casadi.DM(matrix_of(T_CAMERA_OPTICAL))
    seen = _inverse(T_target_optical) @ Z @ _step(d[6:]) @ casadi.vertcat(point, 1)
    return _at_zero((X, Z, A, point, ray), d, seen[:2] / seen[2] - ray)


def _at_zero(inputs: tuple[Any, ...], d: Any, errors: Any) -> Any:
    outputs = [
        casadi.substitute(value, d, casadi.DM.zeros(12)) for value in (errors, casadi.jacobian(errors, d))
    ]
    return casadi.Function("linear", list(inputs), outputs)


def _step(d: Any) -> Any:
    x, y, z = d[3] / 2, d[4] / 2, d[5] / 2
    n = 1 + x * x + y * y + z * z
    return casadi.blockcat([
        [(1 + x * x - y * y - z * z) / n, 2 * (x * y - z) / n, 2 * (x * z + y) / n, d[0]],
        [2 * (x * y + z) / n, (1 - x * x + y * y - z * z) / n, 2 * (y * z - x) / n, d[1]],
        [2 * (x * z - y) / n, 2 * (y * z + x) / n, (1 - x * x - y * y + z * z) / n, d[2]],
        [0, 0, 0, 1],
    ])  # fmt: skip


def _inverse(T: Any) -> Any:
    R = T[:3, :3].T
    return casadi.vertcat(casadi.horzcat(R, -(R @ T[:3, 3])), casadi.DM([[0, 0, 0, 1]]))
