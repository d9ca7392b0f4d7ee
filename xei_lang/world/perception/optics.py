"""A calibrated camera over numpy arrays: rays, pixels, and the optical frame.

Pixels are `(u, v)` from the centre of the top left pixel, u to the right, v down. The optical frame has x to
the right, y down and z forward; the camera's body frame, which profiles place, has x forward, y left and z up
(REP 103, https://www.ros.org/reps/rep-0103.html).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Camera
from xei_lang.world.perception.pose_request import Intrinsics

Array = NDArray[np.float64]

T_CAMERA_OPTICAL = Pose((0.0, 0.0, 0.0), (-0.5, 0.5, -0.5, 0.5))
"""Pose of the optical frame in the camera's body frame."""

_EXACT = (int(cv2.TERM_CRITERIA_COUNT) + int(cv2.TERM_CRITERIA_EPS), 40, 1e-12)


@dataclass(frozen=True, slots=True, eq=False)
class Optics:
    """Intrinsics as OpenCV takes them: `matrix` (3, 3), `distortion` (n,), `size_px` (width, height)."""

    matrix: Array
    distortion: Array
    size_px: tuple[int, int]

    @staticmethod
    def of(camera: Camera) -> Optics:
        """The optics of a profile's camera."""
        matrix = np.array([[camera.fx, 0.0, camera.cx], [0.0, camera.fy, camera.cy], [0.0, 0.0, 1.0]])
        distortion = np.array(camera.distortion or (0.0,) * 5)
        return Optics(matrix, distortion, (camera.width, camera.height))

    @staticmethod
    def of_intrinsics(lens: Intrinsics) -> Optics:
        """The optics of intrinsics that came with a picture."""
        matrix = np.array([[lens.fx, 0.0, lens.cx], [0.0, lens.fy, lens.cy], [0.0, 0.0, 1.0]])
        return Optics(matrix, np.array(lens.distortion or (0.0,) * 5), (lens.width, lens.height))

    def rays(self, points_px: Array) -> Array:
        """Undistorted image coordinates (n, 2), at a depth of 1 m in the optical frame, of pixels (n, 2)."""
        flat = np.ascontiguousarray(points_px, dtype=np.float64).reshape(-1, 1, 2)
        return np.asarray(
            cv2.undistortPoints(flat, self.matrix, self.distortion, criteria=_EXACT),
            dtype=np.float64,
        ).reshape(-1, 2)

    def project(self, points_optical_m: Array) -> tuple[Array, Array]:
        """Pixels (n, 2) of points (n, 3) in the optical frame, and their derivatives (n, 2, 3) by the points.

        The derivative by the points is projectPoints' own by the translation, with no rotation.
        """
        points = np.ascontiguousarray(points_optical_m, dtype=np.float64).reshape(-1, 1, 3)
        zero = np.zeros(3)
        pixels, jacobian = cv2.projectPoints(points, zero, zero, self.matrix, self.distortion)[:2]
        return (
            np.asarray(pixels, dtype=np.float64).reshape(-1, 2),
            np.asarray(jacobian, dtype=np.float64)[:, 3:6].reshape(-1, 2, 3),
        )


def matrix_of(pose: Pose) -> Array:
    """The 4x4 matrix of a pose."""
    return np.array(pose.matrix())


def pose_of(matrix: Array) -> Pose:
    """The pose of a rigid 4x4 matrix."""
    columns = [tuple(float(value) for value in matrix[:3, k]) for k in range(4)]
    x, y, z, p = ((c[0], c[1], c[2]) for c in columns)
    return Pose.from_axes(p, x, y, z)
