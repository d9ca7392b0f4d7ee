"""A small trajectory maker of the tests' own: joint paths with trapezoids along them, in closed form.

It knows nothing of the planner or the verifier; kinematics come straight from pinocchio.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio as pin

from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import JointLimit, Knots, Samples

Array = np.ndarray


class Arm:
    """Forward kinematics and straight-line following of one tool, by pinocchio."""

    def __init__(self, urdf_text: str) -> None:
        self.model = pin.buildModelFromXML(urdf_text)
        self.data = self.model.createData()
        self.names = [str(name) for name in self.model.names][1:]

    def vector(self, joints: Mapping[str, float]) -> Array:
        q = pin.neutral(self.model)
        for name, value in joints.items():
            q[self.names.index(name)] = value
            if name.endswith("finger_joint1"):
                q[self.names.index(name[:-1] + "2")] = value
        return q

    def tool(self, joints: Mapping[str, float], link: str) -> Pose:
        pin.framesForwardKinematics(self.model, self.data, self.vector(joints))
        frame = self.data.oMf[self.model.getFrameId(link)]
        axes = [tuple(float(v) for v in frame.rotation[:, k]) for k in range(3)]
        return Pose.from_axes(tuple(float(v) for v in frame.translation), *axes)

    def follow(
        self,
        joints: Mapping[str, float],
        moved: Sequence[str],
        link: str,
        shift_m: Sequence[float],
        steps: int,
    ) -> list[dict[str, float]]:
        """Joint values along a straight shift of the tool in the base, its orientation kept, by damped
        Newton steps."""
        q, frame = self.vector(joints), self.model.getFrameId(link)
        columns = [self.names.index(name) for name in moved]
        pin.framesForwardKinematics(self.model, self.data, q)
        start = self.data.oMf[frame].copy()
        rows = [dict(joints)]
        for step in range(1, steps + 1):
            shift = np.asarray(shift_m) * step / steps
            goal = pin.SE3(start.rotation, start.translation + shift)
            for _ in range(40):
                pin.framesForwardKinematics(self.model, self.data, q)
                error = pin.log6(self.data.oMf[frame].actInv(goal)).vector
                jacobian = pin.computeFrameJacobian(self.model, self.data, q, frame)[:, columns]
                damped = jacobian @ jacobian.T + 1e-10 * np.eye(6)
                q[columns] += jacobian.T @ np.linalg.solve(damped, error)
            assert np.linalg.norm(error) < 1e-9, "the maker's own kinematics did not converge"
            rows.append({**joints, **{name: float(q[self.names.index(name)]) for name in moved}})
        return rows


def spline(points: Array) -> tuple[Array, Array]:
    """Breaks and coefficients (pieces, powers, joints) of a clamped-free C2 cubic spline through points at
    equal steps.

    Two points give a straight line. Natural ends: the second derivative is zero there.
    """
    count = len(points) - 1
    breaks = np.linspace(0.0, 1.0, count + 1)
    if count == 1:
        return breaks, np.stack([points[:1], points[1:] - points[:1]], axis=1)
    h = 1.0 / count
    matrix = np.eye(count + 1)
    right = np.zeros_like(points)
    for k in range(1, count):
        matrix[k, k - 1 : k + 2] = (1.0, 4.0, 1.0)
        right[k] = 6.0 * (points[k + 1] - 2.0 * points[k] + points[k - 1]) / h**2
    second = np.linalg.solve(matrix, right)
    a, c = points[:-1], second[:-1] / 2.0
    b = (points[1:] - points[:-1]) / h - h * (2.0 * second[:-1] + second[1:]) / 6.0
    d = (second[1:] - second[:-1]) / (6.0 * h)
    return breaks, np.stack([a, b, c, d], axis=1)


def trapezoid(breaks: Array, coefficients: Array, limits: Sequence[JointLimit], share: float) -> Knots:
    """The path with the fastest trapezoid of `s` that keeps `share` of every velocity and acceleration
    limit."""
    u = np.linspace(0.0, 1.0, 21)[:, None, None] * np.diff(breaks)[None, :, None]
    c = np.concatenate(
        [coefficients, np.zeros((len(coefficients), 4 - coefficients.shape[1], coefficients.shape[2]))],
        axis=1,
    )
    first = np.abs(c[:, 1] + 2 * c[:, 2] * u + 3 * c[:, 3] * u**2).max(axis=(0, 1))
    second = np.abs(2 * c[:, 2] + 6 * c[:, 3] * u).max(axis=(0, 1))
    moving = first > 1e-12
    velocity = share * np.array([limit.velocity for limit in limits])[moving]
    acceleration = share * np.array([limit.acceleration for limit in limits])[moving]
    speed = min(
        (velocity / first[moving]).min(), np.sqrt(0.3 * acceleration / (second[moving] + 1e-12)).min()
    )
    pull = (0.7 * acceleration / first[moving]).min()
    length = float(breaks[-1])
    speed = float(min(speed, np.sqrt(pull * length)))
    ramp, cruise = speed / pull, length / speed - speed / pull
    times = np.cumsum([0.0, ramp, max(cruise, 0.0), ramp])
    s1 = 0.5 * pull * ramp**2
    rows = (breaks, times, [0.0, s1, s1 + speed * (times[2] - times[1]), 0.0], [0.0, speed, speed, 0.0])
    breaks_row, times_row, s_row, ds_row = (tuple(float(v) for v in row) for row in rows)
    end = s_row[2] + speed * ramp - 0.5 * pull * ramp**2
    s_row = (*s_row[:3], float(end))
    pieces = tuple(tuple(tuple(float(v) for v in row) for row in piece) for piece in coefficients)
    return Knots(breaks_row, pieces, times_row, s_row, ds_row, (float(pull), 0.0, -float(pull)))


def evaluate(knots: Knots, t: float) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration at one time: a second, scalar reading of the definition in
    `Knots`."""
    i = 0
    while i + 1 < len(knots.dds) and t >= knots.times_s[i + 1]:
        i += 1
    w = t - knots.times_s[i]
    s = knots.s[i] + knots.ds[i] * w + knots.dds[i] * w * w / 2
    sd, sdd = knots.ds[i] + knots.dds[i] * w, knots.dds[i]
    p = 0
    while p + 1 < len(knots.coefficients) and s >= knots.breaks[p + 1]:
        p += 1
    u = s - knots.breaks[p]
    rows = np.array(knots.coefficients[p])
    q = sum(row * u**k for k, row in enumerate(rows))
    q1 = sum((k * row * u ** (k - 1) for k, row in enumerate(rows) if k >= 1), np.zeros(rows.shape[1]))
    q2 = sum(
        (k * (k - 1) * row * u ** (k - 2) for k, row in enumerate(rows) if k >= 2), np.zeros(rows.shape[1])
    )
    return q, q1 * sd, q2 * sd * sd + q1 * sdd


def sample(knots: Knots, start_s: float, rate_hz: float = 100.0) -> Samples:
    """Samples of the knots from `start_s` on, the end included."""
    duration = knots.times_s[-1]
    count = int(duration * rate_hz)
    times = [k / rate_hz for k in range(count + 1)]
    if duration - times[-1] > 1e-9:
        times.append(duration)
    rows = [evaluate(knots, t) for t in times]
    columns = [tuple(tuple(float(v) for v in row[k]) for row in rows) for k in range(3)]
    return Samples(tuple(start_s + t for t in times), *columns)
