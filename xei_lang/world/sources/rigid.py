"""Numbers that claim to be a pose, tested before they are believed."""

from __future__ import annotations

import math
from collections.abc import Sequence

from xei_lang.ir.geometry import Pose

NORM_SLACK = 1e-3
"""How far a quaternion's norm, or a matrix's axes, may be from those of a rotation: numbers written with
four digits pass, a matrix that scales or shears does not.
"""
FARTHEST_M = 20.0
"""No room that a profile describes is larger; numbers beyond are most likely millimetres."""


def pose_of_quaternion(position_m: Sequence[float], quaternion: Sequence[float]) -> Pose | str:
    """The pose of a position and a quaternion x, y, z, w, made of unit norm; or what is wrong with them."""
    wrong = _position_fault(position_m)
    if wrong:
        return wrong
    if not all(math.isfinite(value) for value in quaternion):
        return "its quaternion is not finite"
    norm = math.sqrt(sum(value * value for value in quaternion))
    if abs(norm - 1.0) > NORM_SLACK:
        return f"its quaternion has norm {norm:.4g}, not 1"
    (px, py, pz), (x, y, z, w) = position_m, quaternion
    return Pose((px, py, pz)) @ Pose((0.0, 0.0, 0.0), (x / norm, y / norm, z / norm, w / norm))


def pose_of_matrix(rows: Sequence[Sequence[float]]) -> Pose | str:
    """The pose of a 4x4 homogeneous matrix (row by row, m); or what keeps it from being rigid."""
    if len(rows) != 4 or any(len(row) != 4 for row in rows):
        return "its matrix is not 4 x 4"
    if not all(math.isfinite(value) for row in rows for value in row):
        return "its matrix is not finite"
    position = (rows[0][3], rows[1][3], rows[2][3])
    wrong = _rotation_fault(rows) or _position_fault(position)
    if wrong:
        return wrong
    x, y = _column(rows, 0), _column(rows, 1)
    x = _scaled(x, 1.0 / math.sqrt(_dot(x, x)))
    z = _cross(x, y)
    z = _scaled(z, 1.0 / math.sqrt(_dot(z, z)))
    return Pose.from_axes(position, x, _cross(z, x), z)


def _rotation_fault(rows: Sequence[Sequence[float]]) -> str:
    if any(abs(value - (1.0 if index == 3 else 0.0)) > 1e-9 for index, value in enumerate(rows[3])):
        return "the last row of its matrix is not 0, 0, 0, 1"
    axes = [_column(rows, index) for index in range(3)]
    for name, axis in zip("xyz", axes, strict=True):
        length = math.sqrt(_dot(axis, axis))
        if abs(length - 1.0) > NORM_SLACK:
            return f"its matrix is not rigid: its {name} axis has length {length:.4g}, not 1"
    for first, second in ((0, 1), (1, 2), (2, 0)):
        if abs(_dot(axes[first], axes[second])) > NORM_SLACK:
            names = f"{'xyz'[first]} and {'xyz'[second]}"
            return f"its matrix is not rigid: its axes {names} are not at right angles"
    mirrors = _dot(_cross(axes[0], axes[1]), axes[2]) < 0.0
    return "its matrix mirrors: its axes are left-handed" if mirrors else ""


def _column(rows: Sequence[Sequence[float]], index: int) -> tuple[float, float, float]:
    return (rows[0][index], rows[1][index], rows[2][index])


def _position_fault(position_m: Sequence[float]) -> str:
    if not all(math.isfinite(value) for value in position_m):
        return "its position is not finite"
    far = max(abs(value) for value in position_m)
    if far > FARTHEST_M:
        return f"its position is {far:g} m away: the numbers look like millimetres"
    return ""


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Sequence[float], b: Sequence[float]) -> tuple[float, float, float]:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _scaled(a: Sequence[float], factor: float) -> tuple[float, float, float]:
    return (a[0] * factor, a[1] * factor, a[2] * factor)
