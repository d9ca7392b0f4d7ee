"""The elbow of an S-R-S arm: its angle from the shoulder-wrist distance, and the frame that the swivel angle
turns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics.geometry import SrsGeometry
from xei_lang.motion.kinematics.swivel import ANGLE_TOLERANCE, TWO_PI
from xei_lang.motion.robot import Array

_RADIANS_OF_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class Elbow:
    """Vectors are in base_link at q4 = 0; `across_x` is axis x x, and `across_axis` is `across(axis)`.

    `upper_arm` leads from the elbow to the shoulder and `forearm` to the wrist; `axis` is the hinge.
    |wrist - shoulder|^2 = |upper_arm|^2 + |forearm|^2 - 2 amplitude cos(q4 - phase), by the law of cosines.
    `bends` are the signs of sin(q4 - phase) that the limits leave; `reach_m` the least and greatest distance.
    """

    upper_arm: Array
    forearm: Array
    axis: Array
    across_upper_arm: Array
    across_forearm: Array
    across_axis: Array
    squares: float
    phase: float
    amplitude: float
    lower: float
    upper: float
    bends: tuple[float, ...]
    reach_m: tuple[float, float]

    def angle(self, distance_m: Array, bend: float) -> tuple[Array, NDArray[np.bool_]]:
        """q4 (m,) at which shoulder and wrist are `distance_m` (m,) apart, and whether reach and limits allow
        it.
        """
        cosine = (self.squares - distance_m * distance_m) / (2.0 * self.amplitude)
        middle = (self.lower + self.upper) / 2
        turn = self.phase + bend * np.arccos(np.minimum(np.maximum(cosine, -1.0), 1.0)) - middle
        angle = turn - TWO_PI * np.round(turn / TWO_PI) + middle
        valid = np.abs(cosine) <= 1.0 + _RADIANS_OF_ROUNDING
        valid &= (angle >= self.lower - ANGLE_TOLERANCE) & (angle <= self.upper + ANGLE_TOLERANCE)
        return np.minimum(np.maximum(angle, self.lower), self.upper), valid

    def frames(self, angle: Array) -> tuple[Array, Array]:
        """Frame (m, 3, 3) with x from shoulder to wrist and y the hinge, seen before joint 4 and seen after
        it.
        """
        cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
        before = cosine * self.forearm + sine * self.across_forearm - self.upper_arm
        after = self.forearm - cosine * self.upper_arm + sine * self.across_upper_arm
        length = np.sqrt((before * before).sum(axis=1, keepdims=True))
        return self._frame(before / length), self._frame(after / length)

    def bend_of(self, angle: float) -> float:
        """The sign of `angle`'s bend; a straight arm has the first that the limits leave."""
        sine = float(np.sin(angle - self.phase))
        return self.bends[0] if abs(sine) < 1e-9 else float(np.sign(sine))

    def _frame(self, along: Array) -> Array:
        frame = np.empty((len(along), 3, 3))
        frame[:, :, 0] = along
        frame[:, :, 1] = self.axis
        frame[:, :, 2] = along @ self.across_axis
        return frame


def elbow(geometry: SrsGeometry) -> Elbow:
    """The elbow of a measured arm."""
    v, u, a = geometry.shoulder - geometry.elbow, geometry.wrist - geometry.elbow, geometry.elbow_axis
    even, odd = float(v @ u), float(v @ np.cross(a, u))
    phase, amplitude = float(np.arctan2(odd, even)), float(np.hypot(even, odd))
    squares = float(u @ u + v @ v)
    lower, upper = float(geometry.lower[3]), float(geometry.upper[3])
    sines = np.sin(np.linspace(lower, upper, 103)[1:-1] - phase)
    extremes = [t for t in (phase, phase + np.pi, phase - np.pi) if lower <= t <= upper]
    distances = [
        np.sqrt(max(0.0, squares - 2 * amplitude * np.cos(t - phase))) for t in (lower, upper, *extremes)
    ]
    return Elbow(
        upper_arm=v,
        forearm=u,
        axis=a,
        across_upper_arm=np.cross(a, v),
        across_forearm=np.cross(a, u),
        across_axis=across(a),
        squares=squares,
        phase=phase,
        amplitude=amplitude,
        lower=lower,
        upper=upper,
        bends=tuple(sign for sign in (1.0, -1.0) if bool(np.any(sign * sines > 1e-9))),
        reach_m=(float(min(distances)), float(max(distances))),
    )


def across(axis: Array) -> Array:
    """The matrix (3, 3) with which a row vector times it is its cross product with `axis`."""
    x, y, z = (float(value) for value in axis)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
