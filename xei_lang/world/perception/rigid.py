"""Whether a matrix that somebody sent is a rigid motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.world.perception.optics import pose_of

SLACK = 1e-3
"""How far R R^T may be from the identity in any entry: what single precision and six digits of text lose."""
MAX_DISTANCE_M = 100.0


def rigid_pose(rows: Sequence[Sequence[float]]) -> Pose | str:
    """The pose of a 4x4 matrix by rows, m, or why it is none.

    The rotation is the nearest to what was sent, in the Frobenius norm (by its singular values).
    """
    matrix = np.array(rows, dtype=np.float64)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        return "it is no 4x4 matrix of numbers"
    if np.abs(matrix[3] - (0.0, 0.0, 0.0, 1.0)).max() > SLACK:
        return "its last row is not 0 0 0 1"
    rotation = matrix[:3, :3]
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > SLACK:
        return "its rotation is none: its columns are not orthonormal"
    if np.linalg.det(rotation) < 0.0:
        return "it mirrors: the determinant of its rotation is -1"
    if np.abs(matrix[:3, 3]).max() > MAX_DISTANCE_M:
        return f"it puts the object more than {MAX_DISTANCE_M:g} m away"
    left, _, right = np.linalg.svd(rotation)
    matrix[:3, :3] = left @ right
    return pose_of(matrix)
