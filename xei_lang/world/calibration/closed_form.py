"""AX = XB in closed form, from pairs of samples.

Park and Martin, "Robot sensor calibration: solving AX = XB on the Euclidean group", IEEE Trans. Robotics and
Automation 10(5), 1994: the rotation from the logarithms of both motions, then the translation by linear least
squares. The rotation is the orthogonal factor by SVD, so that no inverse square root is needed.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.world.perception.optics import Array

Rotation: Any = importlib.import_module("scipy.spatial.transform").Rotation  # ships no type information

_MAX_ANGLE_RAD = np.radians(165.0)
"""Beyond it the sign of a rotation's axis is at the mercy of noise."""
_MAX_PAIRS = 2000


@dataclass(frozen=True, slots=True, eq=False)
class Start:
    """`X` and `Z` (4, 4) of `A X B = Z`, and `spread_rad` (3,): the root mean square rotation between samples
    along its three principal axes, largest first.
    """

    X: Array
    Z: Array
    spread_rad: Array


def rotation_spread(A: Array) -> Array:
    """The singular values (3,) of the rotations between poses (n, 4, 4), as root mean squares in rad."""
    first, second = _pairs(A)
    turns = _turns(np.linalg.inv(A[second]) @ A[first])
    spread: Array = np.linalg.svd(turns, compute_uv=False) / np.sqrt(len(turns))
    return spread


def park_martin(A: Array, B: Array) -> Start:
    """X and Z from poses (n, 4, 4); the rotations must span two axes, which `rotation_spread` tells."""
    first, second = _pairs(A)
    left: Array = np.linalg.inv(A[second]) @ A[first]
    right: Array = B[second] @ np.linalg.inv(B[first])
    alpha, beta = _turns(left), _turns(right)
    usable = np.linalg.norm(alpha, axis=1) < _MAX_ANGLE_RAD
    if usable.sum() >= 3:
        left, right, alpha, beta = left[usable], right[usable], alpha[usable], beta[usable]
    u, _, vt = np.linalg.svd(alpha.T @ beta)
    X = np.eye(4)
    X[:3, :3] = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
    rows = (left[:, :3, :3] - np.eye(3)).reshape(-1, 3)
    values = (right[:, :3, 3] @ X[:3, :3].T - left[:, :3, 3]).reshape(-1)
    X[:3, 3] = np.linalg.lstsq(rows, values, rcond=None)[0]
    return Start(X, _mean_pose(A @ X @ B), rotation_spread(A))


def _pairs(A: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Indices of all pairs of samples, or of evenly many of them where there are too many."""
    first, second = np.triu_indices(len(A), 1)
    step = max(1, len(first) // _MAX_PAIRS)
    return first[::step], second[::step]


def _turns(motions: Array) -> Array:
    return Rotation.from_matrix(motions[:, :3, :3]).as_rotvec()


def _mean_pose(poses: Array) -> Array:
    mean = np.eye(4)
    mean[:3, :3] = Rotation.from_matrix(poses[:, :3, :3]).mean().as_matrix()
    mean[:3, 3] = poses[:, :3, 3].mean(axis=0)
    return mean
