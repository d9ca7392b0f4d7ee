"""A spherical joint turned by the swivel angle: joint angles, and the exact angles at which one meets a limit.

Every matrix entry that the joint angles come from is `a + b cos(psi) + c sin(psi)`. So a joint reaches a limit at
the roots of one such equation, two at most, and between neighbouring roots of all joints nothing changes: testing one angle
between each pair decides the whole circle. After Shimizu, Kakuya, Yoon, Kitagaki, Kosuge, "Analytical Inverse Kinematic
Computation for 7-DOF Redundant Manipulators With Joint Limits", IEEE T-RO 24(5), 2008, section IV.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics.geometry import Spherical
from xei_lang.motion.robot import Array

Mask = NDArray[np.bool_]
TWO_PI = 2.0 * np.pi
ANGLE_TOLERANCE = 1e-9

# Entries of M = Rz(q1) Ry(t) Rz(q3) in the order that this file keeps them: M22, M02, M12, M20, M21.
_ROWS = np.array([2, 0, 1, 2, 2])
_COLUMNS = np.array([2, 2, 2, 0, 1])


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of several joints (k,) and the linear equations (2k, 5) whose roots are where a joint meets one."""

    lower: Array
    upper: Array
    middle: Array
    equations: Array
    constants: Array


def limits(joint: Spherical, lower: Array, upper: Array) -> Limits:
    """For the three joints of a spherical joint, limits (3,)."""
    equations, constants = np.zeros((6, 5)), np.zeros(6)
    for row, (low_or_high, angle) in enumerate((side, k) for side in (lower, upper) for k in range(3)):
        limit = float(low_or_high[angle])
        if angle == 0:
            equations[row, 2], equations[row, 1] = np.cos(limit), -np.sin(limit)
        elif angle == 1:
            equations[row, 0], constants[row] = 1.0, -np.cos(limit + joint.offset)
        else:
            equations[row, 4], equations[row, 3] = np.cos(limit), np.sin(limit)
    return Limits(lower, upper, (lower + upper) / 2, equations, constants)


def entries(left: Array, right: Array, sign: float) -> Array:
    """Coefficients (m, 3, 5) of 1, cos and sin of psi in the kept entries of `left Rx(sign psi) right.T`, both (m, 3, 3)."""
    p, q = left[:, _ROWS, :], right[:, _COLUMNS, :]
    result = np.empty((len(left), 3, 5))
    result[:, 0] = p[..., 0] * q[..., 0]
    result[:, 1] = p[..., 1] * q[..., 1] + p[..., 2] * q[..., 2]
    result[:, 2] = sign * (p[..., 2] * q[..., 1] - p[..., 1] * q[..., 2])
    return result


def critical_angles(coefficients: Array, bounds: Limits) -> Array:
    """Angles (m, 12) in [-pi, pi) at which a joint may meet a limit; -pi stands where an equation has no root."""
    equations = coefficients @ bounds.equations.T
    constant = equations[:, 0] + bounds.constants
    cosine, sine = equations[:, 1], equations[:, 2]
    amplitude = np.sqrt(cosine * cosine + sine * sine)
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.arccos(-constant / amplitude)
    centre = np.arctan2(sine, cosine)
    roots = np.concatenate([centre - half, centre + half], axis=1)
    return np.nan_to_num(wrapped(roots), nan=-np.pi)


def wrapped(angle: Array) -> Array:
    """The same angle in [-pi, pi)."""
    return angle - TWO_PI * np.floor(angle / TWO_PI + 0.5)


def joint_angles(values: Array, flips: Array, offset: float, bounds: Limits) -> Array:
    """Joint angles (..., f, 3) from the kept entries (..., 5), one row for each sign in `flips` (f,) or (..., f).

    The sign is that of sin(q2 + offset). Each angle is the representative nearest to the middle of its limits.
    """
    m22, m02, m12, m20, m21 = (values[..., None, k] for k in range(5))
    result = np.empty((*values.shape[:-1], flips.shape[-1], 3))
    np.arctan2(flips * m12, flips * m02, out=result[..., 0])
    np.arctan2(flips * np.sqrt(m02 * m02 + m12 * m12), m22, out=result[..., 1])
    np.arctan2(flips * m21, -flips * m20, out=result[..., 2])
    result[..., 1] -= offset
    result -= bounds.middle
    result -= TWO_PI * np.round(result / TWO_PI)
    result += bounds.middle
    return result


def within(angles: Array, bounds: Limits, tolerance: float = ANGLE_TOLERANCE) -> Mask:
    """Whether all joints (..., 3) are within limits."""
    return np.all((angles >= bounds.lower - tolerance) & (angles <= bounds.upper + tolerance), axis=-1)


def possible_flips(joint: Spherical, lower: float, upper: float) -> Array:
    """The signs of sin(q2 + offset) that the middle joint's limits leave."""
    sines = np.sin(np.linspace(lower, upper, 103)[1:-1] + joint.offset)
    return np.array([sign for sign in (1.0, -1.0) if bool(np.any(sign * sines > 1e-9))])


@dataclass(frozen=True, slots=True)
class Samples:
    """Swivel angles (n,) chosen from feasible intervals, each with its row (pose) and its column (branch)."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    angle: Array


def sample_intervals(cuts: Array, feasible: Mask, count: int) -> Samples:
    """About `count` angles a row, spread over the feasible intervals in proportion, at least the middle of each.

    cuts: (m, k) sorted angles. feasible: (m, b, k) whether the interval from cut k to the next, past the last to the
    first around the circle, is feasible for branch b. An interval across the first cut counts as two.
    """
    padded = np.zeros((*feasible.shape[:2], feasible.shape[2] + 2), dtype=np.int8)
    padded[:, :, 1:-1] = feasible
    steps = np.diff(padded, axis=2)
    row, column, first = np.nonzero(steps == 1)
    last = np.nonzero(steps == -1)[2]
    ends = np.concatenate([cuts, cuts[:, :1] + TWO_PI], axis=1)
    start = ends[row, first]
    length = ends[row, last] - start
    total = np.bincount(row, weights=length, minlength=len(cuts))
    number = np.maximum(1, np.rint(count * length / np.maximum(total[row], 1e-300))).astype(np.int64)
    owner = np.repeat(np.arange(len(row)), number)
    index = np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number)
    angle = start[owner] + (index + 0.5) / number[owner] * length[owner]
    return Samples(row[owner], column[owner], angle)
