"""One pose from the corners of all tags of a frame, with its residual and covariance.

Both start poses of a planar target come from IPPE (Collins and Bartoli, IJCV 109, 2014), of another one from
SQPnP (Terzakis and Lourakis, ECCV 2020); each is then refined by Gauss-Newton on the reprojection error.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from xei_lang.world.perception.optics import Array, Optics

Rotation: Any = importlib.import_module("scipy.spatial.transform").Rotation  # ships no type information

_ITERATIONS = 50
_FLAT_M = 1e-6
_SAME = 1e-3
"""Entries of two poses that differ by less (m) are one solution, reached from two starts."""
MIN_NOISE_PX = 0.03
"""No corner is believed to be known better than this, however well the few of an image agree."""


@dataclass(frozen=True, slots=True, eq=False)
class JointPose:
    """`T_optical_frame` (4, 4) from all corners at once.

    `errors_px` (n, 2) are the residuals of the corners, observed minus predicted. `covariance` (6, 6) is that
    of a small motion `d` in `T @ exp(d)`, translation (m) before rotation (rad), in the axes of the frame; it
    holds the noise of corners, not the error of the layout. `other_rms_px` is the residual of the second
    solution of a planar target, infinite where there is none; `noise_px` is the standard deviation of a
    coordinate of a corner that the covariance was made with.
    """

    T_optical_frame: Array
    errors_px: Array
    covariance: Array
    other_rms_px: float
    noise_px: float

    @property
    def rms_px(self) -> float:
        """Root mean square distance of a corner from where the pose puts it."""
        return rms(self.errors_px)


def joint_pose(points_m: Array, pixels: Array, optics: Optics) -> JointPose | None:
    """The pose of a frame whose points (n, 3) are seen at pixels (n, 2); None where no pose explains them.

    n is 4 or more, not all points on a line.
    """
    solved = [_refine(T, points_m, pixels, optics) for T in _starts(points_m, pixels, optics)]
    solved = [one for one in solved if one is not None]
    if not solved:
        return None
    solved.sort(key=lambda one: rms(one[1]))
    T, errors, jacobian = solved[0]
    distinct = [other for other in solved[1:] if not np.allclose(other[0], T, atol=_SAME)]
    freedom = max(errors.size - 6, 1)
    variance = max(float((errors**2).sum()) / freedom, MIN_NOISE_PX**2)
    covariance: Array = variance * np.linalg.pinv(jacobian.T @ jacobian).astype(np.float64)
    other = rms(distinct[0][1]) if distinct else float("inf")
    return JointPose(T, errors, covariance, other, float(np.sqrt(variance)))


def size_ratio(
    pose: JointPose, centres_m: Array, points_m: Array, pixels: Array, optics: Optics
) -> tuple[float, float]:
    """How large the tags look against their stated size, beside the distances between them, and its standard
    deviation.

    `centres_m` (n, 3) is the centre of the tag of each corner (n, 3). For one tag size and distance cannot be
    told apart, and the deviation is infinite.
    """
    placed, ratio = pose.T_optical_frame, 1.0
    deviation = float("inf")
    for _ in range(6):
        scaled = centres_m + ratio * (points_m - centres_m)
        errors, jacobian, by_pixel = _linear(placed, scaled, pixels, optics)
        by_ratio = by_pixel @ placed[:3, :3] @ (points_m - centres_m)[..., None]
        full = np.hstack([jacobian, by_ratio.reshape(-1, 1)])
        # Columns of unit length, so that only what cannot be observed looks singular.
        lengths = np.linalg.norm(full, axis=0)
        u, s, vt = np.linalg.svd(full / lengths, full_matrices=False)
        if s[-1] < 1e-3 * s[0]:
            return 1.0, float("inf")
        step = (vt.T @ ((u.T @ errors.reshape(-1)) / s)) / lengths
        placed, ratio = placed @ exp_se3(step[:6]), ratio + float(step[6])
        variance = max(float((errors**2).sum()) / max(errors.size - 7, 1), MIN_NOISE_PX**2)
        deviation = float(np.sqrt(variance * ((vt[:, 6] / s) ** 2).sum()) / lengths[6])
    return ratio, deviation


def rms(errors_px: Array) -> float:
    """Root mean square length of errors (n, 2)."""
    return float(np.sqrt((errors_px**2).sum(axis=1).mean()))


def exp_se3(motion: Array) -> Array:
    """The rigid motion (4, 4) of a translation and a rotation vector (6,), applied one after the other."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(motion[3:]).as_matrix()
    T[:3, 3] = motion[:3]
    return T


def _starts(points_m: Array, pixels: Array, optics: Optics) -> list[Array]:
    rays = optics.rays(pixels)
    flat = np.linalg.svd(points_m - points_m.mean(axis=0))[1][-1] < _FLAT_M
    method = cv2.SOLVEPNP_IPPE if flat else cv2.SOLVEPNP_SQPNP
    try:
        _, turns, shifts, _ = cv2.solvePnPGeneric(
            points_m.reshape(-1, 1, 3), rays.reshape(-1, 1, 2), np.eye(3), np.zeros(5), flags=method
        )
    except cv2.error:
        return []
    found: list[Array] = []
    for turn, shift in zip(turns, shifts, strict=True):
        T = np.eye(4)
        T[:3, :3] = Rotation.from_rotvec(np.asarray(turn).reshape(3)).as_matrix()
        T[:3, 3] = np.asarray(shift).reshape(3)
        if np.isfinite(T).all():
            found.append(T)
    return found


def _refine(start: Array, points: Array, pixels: Array, optics: Optics) -> tuple[Array, Array, Array] | None:
    """Levenberg's damped Gauss-Newton from a start; None where points end up behind the camera."""
    placed = start
    errors, jacobian, _ = _linear(placed, points, pixels, optics)
    damping = 1e-6
    for _ in range(_ITERATIONS):
        normal = jacobian.T @ jacobian
        damped = normal + damping * np.diag(np.diag(normal))
        step: Array = np.linalg.lstsq(damped, jacobian.T @ errors.reshape(-1), rcond=None)[0].astype(
            np.float64
        )
        moved = placed @ exp_se3(step)
        new_errors, new_jacobian, _ = _linear(moved, points, pixels, optics)
        if rms(new_errors) <= rms(errors):
            placed, errors, jacobian = moved, new_errors, new_jacobian
            damping *= 0.1
            if float(np.abs(step).max()) < 1e-12:
                break
        else:
            damping *= 100.0
            if damping > 1e6:
                break
    in_front = bool(((points @ placed[:3, :3].T + placed[:3, 3])[:, 2] > 0).all())
    return (placed, errors, jacobian) if in_front and np.isfinite(errors).all() else None


def _linear(T: Array, points: Array, pixels: Array, optics: Optics) -> tuple[Array, Array, Array]:
    """Errors (n, 2), their Jacobian (2n, 6) by a motion `T @ exp(d)` with its sign turned, and the
    derivatives of pixels by points of the optical frame (n, 2, 3).
    """
    R = T[:3, :3]
    predicted, by_point = optics.project(points @ R.T + T[:3, 3])
    turned = by_point @ R
    x, y, z = points.T
    zero = np.zeros_like(x)
    minus_cross = np.stack([zero, z, -y, -z, zero, x, y, -x, zero], axis=1).reshape(-1, 3, 3)
    jacobian = np.concatenate([turned, turned @ minus_cross], axis=2).reshape(-1, 6)
    return pixels - predicted, jacobian, by_point
