"""A spherical joint turned by the swivel angle: joint angles, and the exact angles at which one meets a
limit.

Every matrix entry that the joint angles come from is `a + b cos(psi) + c sin(psi)`. So a joint reaches a
limit at the roots of one such equation, two at most, and between neighbouring roots of all joints nothing
changes: testing one angle between each pair decides the whole circle. After Shimizu, Kakuya, Yoon, Kitagaki,
Kosuge, "Analytical Inverse Kinematic Computation for 7-DOF Redundant Manipulators With Joint Limits", IEEE
T-RO 24(5), 2008, section IV.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics.geometry import Spherical
from xei_lang.motion.robot import Array

Mask = NDArray[np.bool_]
TWO_PI = 2.0 * np.pi
ANGLE_TOLERANCE = 1e-10
_IN_LINE = 1e-10

# Entries of M = Rz(q1) Ry(t) Rz(q3) in the order that this file keeps them; the first five tell where
# limits are met.
_ROWS = np.array([2, 0, 1, 2, 2, 0, 0, 1, 1])
_COLUMNS = np.array([2, 2, 2, 0, 1, 0, 1, 0, 1])
_TURN = np.array([[1.0], [-1.0]])


@dataclass(frozen=True, slots=True)
class Limits:
    """Two spherical joints' limits (2, 1, 3), and the equations (2, 5, 6) and constants (2, 6) of meeting
    one.
    """

    lower: Array
    upper: Array
    middle: Array
    offset: Array
    equations: Array
    constants: Array


def limits(joints: tuple[Spherical, Spherical], lower: Array, upper: Array) -> Limits:
    """For shoulder and wrist, limits (2, 3) in rad."""
    equations, constants = np.zeros((2, 5, 6)), np.zeros((2, 6))
    for k, joint in enumerate(joints):
        for side, (first, second, third) in enumerate((lower[k], upper[k])):
            equations[k, 1:3, 3 * side] = -np.sin(first), np.cos(first)
            equations[k, 0, 3 * side + 1] = 1.0
            constants[k, 3 * side + 1] = -np.cos(second + joint.offset)
            equations[k, 3:5, 3 * side + 2] = np.sin(third), np.cos(third)
    middle = (lower + upper) / 2
    offset = np.array([joint.offset for joint in joints])[:, None]
    return Limits(lower[:, None], upper[:, None], middle[:, None], offset, equations, constants)


def entries(left: Array, right: Array) -> Array:
    """Coefficients (m, 3, 2, 9) of 1, cos and sin of psi in the kept entries of `left Rx(psi) right.T`.

    left, right: (m, 2, 3, 3) for shoulder and wrist; the wrist turns by -psi.
    """
    p, q = left[:, :, _ROWS, :], right[:, :, _COLUMNS, :]
    result = np.empty((len(left), 3, 2, 9))
    np.multiply(p[..., 0], q[..., 0], out=result[:, 0])
    result[:, 1] = p[..., 1] * q[..., 1] + p[..., 2] * q[..., 2]
    result[:, 2] = (p[..., 2] * q[..., 1] - p[..., 1] * q[..., 2]) * _TURN
    return result


def critical_angles(coefficients: Array, bounds: Limits) -> Array:
    """Sorted angles (m, 24) in [-pi, pi) at which a joint may meet a limit; -pi stands for each root that is
    not there.
    """
    equations = coefficients.transpose(0, 2, 1, 3)[..., :5] @ bounds.equations
    constant = equations[:, :, 0] + bounds.constants
    cosine, sine = equations[:, :, 1], equations[:, :, 2]
    with np.errstate(invalid="ignore", divide="ignore"):
        half = np.arccos(-constant / np.sqrt(cosine * cosine + sine * sine))
    centre = np.arctan2(sine, cosine)
    roots = np.concatenate([centre - half, centre + half], axis=1).reshape(len(coefficients), -1)
    angles = np.fmax(wrapped(roots), -np.pi)
    angles.sort(axis=1)
    return angles


def wrapped(angle: Array) -> Array:
    """The same angle in [-pi, pi)."""
    return angle - TWO_PI * np.floor(angle / TWO_PI + 0.5)


def joint_angles(coefficients: Array, swivel_angle: Array, flips: Array, bounds: Limits) -> Array:
    """Joint angles (n, ..., 2, f, 3) at swivel angles (n, ...) of shoulder and wrist, one row for each flip.

    coefficients: (n, ..., 3, 2, 9) as `entries` gives them. flips: broadcast to (..., 2, f), the sign of
    sin(q2 + offset). Each angle is the representative nearest to the middle of its limits.
    """
    values = np.cos(swivel_angle)[..., None, None] * coefficients[..., 1, :, :]
    values += np.sin(swivel_angle)[..., None, None] * coefficients[..., 2, :, :]
    values += coefficients[..., 0, :, :]
    m22, m02, m12, _, _, m00, m01, m10, m11 = (values[..., None, k] for k in range(9))
    size = np.sqrt(m02 * m02 + m12 * m12)
    result = np.empty((*values.shape[:-1], flips.shape[-1], 3))
    np.arctan2(flips * m12, flips * m02, out=result[..., 0])
    np.arctan2(flips * size, m22, out=result[..., 1])
    if size.min(initial=1.0) < _IN_LINE:
        shared = _shared_first_angle(m22, m00, m10, bounds)
        result[..., 0] = np.where(size < _IN_LINE, shared, result[..., 0])
    # The third angle follows from the first, not from M20 and M21: where the outer axes come in line these
    # are all rounding, and the sum of the two angles would be too.
    cosine, sine = np.cos(result[..., 0]), np.sin(result[..., 0])
    np.arctan2(cosine * m10 - sine * m00, cosine * m11 - sine * m01, out=result[..., 2])
    result[..., 1] -= bounds.offset
    result -= bounds.middle
    result -= TWO_PI * np.rint(result / TWO_PI)
    result += bounds.middle
    return result


def _shared_first_angle(m22: Array, m00: Array, m10: Array, bounds: Limits) -> Array:
    """The first angle where the outer axes are in line, so that only the sum or difference of both is fixed.

    Both leave the middles of their limits in proportion to their spans: within limits whenever any choice is.
    """
    sign = np.where(m22 < 0.0, -1.0, 1.0)
    spans = bounds.upper - bounds.lower
    first, third = bounds.middle[..., 0], bounds.middle[..., 2]
    excess = wrapped(np.arctan2(sign * m10, sign * m00) - first - sign * third)
    return first + excess * spans[..., 0] / (spans[..., 0] + spans[..., 2])


def within(angles: Array, bounds: Limits) -> Mask:
    """Whether all three joints of angles (..., 2, f, 3) are within limits."""
    inside: Mask = (angles >= bounds.lower - ANGLE_TOLERANCE) & (angles <= bounds.upper + ANGLE_TOLERANCE)
    return np.logical_and.reduce(inside, axis=-1)


def possible_flips(joint: Spherical, lower: float, upper: float) -> tuple[int, ...]:
    """Which of the signs +1 (0) and -1 (1) of sin(q2 + offset) the middle joint's limits leave."""
    sines = np.sin(np.linspace(lower, upper, 103)[1:-1] + joint.offset)
    return tuple(flip for flip, sign in enumerate((1.0, -1.0)) if bool(np.any(sign * sines > 1e-9)))


@dataclass(frozen=True, slots=True)
class Samples:
    """Swivel angles (n,) chosen from feasible intervals, each with its row (pose) and its column (branch)."""

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    angle: Array

    def chosen(self, mask: Mask) -> Samples:
        """The samples (n,) of which the mask is true."""
        return Samples(self.row[mask], self.column[mask], self.angle[mask])


def sample_intervals(cuts: Array, feasible: Mask, count: int) -> Samples:
    """About `count` angles a row, spread over the feasible intervals in proportion, at least the middle of
    each.

    cuts: (m, k) sorted angles. feasible: (m, b, k) whether the interval from cut k to the next, past the last
    to the first around the circle, is feasible for branch b. An interval across the first cut counts as two.
    """
    padded = np.zeros((*feasible.shape[:2], feasible.shape[2] + 2), dtype=np.bool_)
    padded[:, :, 1:-1] = feasible
    before, after = padded[:, :, :-1], padded[:, :, 1:]
    row, column, first = np.nonzero(after > before)
    last = np.nonzero(before > after)[2]
    ends = np.concatenate([cuts, cuts[:, :1] + TWO_PI], axis=1)
    start = ends[row, first]
    length = ends[row, last] - start
    total = np.bincount(row, weights=length, minlength=len(cuts))
    number = np.maximum(1, np.rint(count * length / np.maximum(total[row], 1e-300))).astype(np.int64)
    owner = np.repeat(np.arange(len(row)), number)
    index = np.arange(len(owner)) - np.repeat(np.cumsum(number) - number, number)
    angle = start[owner] + (index + 0.5) / number[owner] * length[owner]
    return Samples(row[owner], column[owner], angle)
