"""Closed-form inverse kinematics of an arm with a spherical shoulder, a hinge elbow and a spherical wrist (S-R-S).

The tool pose fixes the wrist centre, its distance from the shoulder fixes the elbow, and what is left free is one angle: the
swivel of the elbow about the line from shoulder to wrist. It is 0 where the elbow's hinge lies in the plane of
that line and the arm's first axis. The geometry is measured (`geometry.py`), the limits on the swivel are exact (`swivel.py`).

A branch is a bit set: 1 the shoulder's middle joint flipped, 2 the wrist's, 4 the elbow bent the other way; limits
leave only some. Singular cases: with the arm straight the swivel turns the whole arm and stays well defined, since
it is told by the hinge and not by the elbow's place. With the wrist on the first axis the angle is measured from another
fixed direction. With a spherical joint's outer axes in line only the sum of their angles is fixed; the solution returned
is one of many. Feasible intervals narrower than rounding (1e-12 rad) may be missed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics import swivel
from xei_lang.motion.kinematics.elbow import Elbow, elbow
from xei_lang.motion.kinematics.geometry import Spherical, SrsGeometry
from xei_lang.motion.kinematics.solver import Solutions
from xei_lang.motion.robot import Array

CONFIGURATIONS_PER_POSE = 20
_ON_FIRST_AXIS = 1e-6


@dataclass(frozen=True, slots=True)
class _Poses:
    """Tool poses with all but the swivel angle settled: entries (m, 3, 5) of both spherical joints, elbow (m,)."""

    shoulder: Array
    wrist: Array
    elbow: Array
    valid: swivel.Mask


@dataclass(frozen=True, slots=True)
class SrsArm:
    """The closed-form solver of one arm; see `Solver` for its methods. Make one with `srs_arm`."""

    geometry: SrsGeometry
    elbow: Elbow
    shoulder_limits: swivel.Limits
    wrist_limits: swivel.Limits
    shoulder_flips: Array
    wrist_flips: Array

    @property
    def name(self) -> str:
        return "srs-closed-form"

    def solve(self, T_base_tool: Array, slide_m: float) -> Solutions:
        return self.solve_many(T_base_tool[None], slide_m)[0]

    def solve_many(self, T_base_tool: Array, slide_m: float | Array) -> list[Solutions]:
        parts = [self._solve_bend(T_base_tool, slide_m, bend) for bend in self.elbow.bends]
        return parts[0] if len(parts) == 1 else [_joined(both) for both in zip(*parts, strict=True)]

    def at(self, T_base_tool: Array, slide_m: float, swivel_angle: float, branch: int) -> Array | None:
        q, valid = self.at_many(T_base_tool[None], slide_m, swivel_angle, branch)
        return q[0] if valid[0] else None

    def at_many(
        self, T_base_tool: Array, slide_m: float | Array, swivel_angle: float | Array, branch: int
    ) -> tuple[Array, swivel.Mask]:
        count = len(T_base_tool)
        poses = self._poses(T_base_tool, slide_m, _sign(branch, 4))
        angle = np.broadcast_to(np.asarray(swivel_angle, dtype=np.float64), (count,))
        flips = (np.array([_sign(branch, 1)]), np.array([_sign(branch, 2)]))
        q = self._assemble(poses, np.arange(count), angle, flips)
        valid = poses.valid & swivel.within(q[:, :3], self.shoulder_limits) & swivel.within(q[:, 4:], self.wrist_limits)
        return np.clip(q, self.geometry.lower, self.geometry.upper), valid

    def describe(self, q_arm: Array) -> tuple[float, int]:
        g = self.geometry
        R_shoulder = _rotation(g.shoulder_joint, q_arm[:3])
        local = self.elbow.frames(q_arm[3:4])[0][0]
        reference = self._reference_frame((R_shoulder @ local[:, :1]).T)[0]
        turned = reference.T @ R_shoulder @ local
        branch = int(np.sin(q_arm[1] + g.shoulder_joint.offset) < 0.0)
        branch += 2 * int(np.sin(q_arm[5] + g.wrist_joint.offset) < 0.0)
        branch += 4 * int(self.elbow.bend_of(float(q_arm[3])) < 0.0)
        return float(np.arctan2(turned[2, 1], turned[1, 1])), branch

    def reach_shortfall(self, T_base_tool: Array, slide_m: float) -> float:
        nearest, farthest = self.elbow.reach_m
        distance = float(np.linalg.norm(self._shoulder_to_wrist(T_base_tool[None], slide_m)))
        return max(0.0, distance - farthest, nearest - distance)

    def _shoulder_to_wrist(self, T_base_tool: Array, slide_m: float | Array) -> Array:
        """Vectors (m, 3) in base_link, with the slide lowered to zero."""
        g = self.geometry
        lifted = np.multiply.outer(np.asarray(slide_m, dtype=np.float64), g.slide_axis) + g.shoulder
        return T_base_tool[:, :3, 3] + T_base_tool[:, :3, :3] @ g.wrist_in_tool - lifted

    def _reference_frame(self, along: Array) -> Array:
        """Frames (m, 3, 3) that the swivel turns: x the given direction, y next to the arm's first axis."""
        basis = self.geometry.shoulder_joint.basis
        frame = np.empty((len(along), 3, 3))
        x = along / np.sqrt((along * along).sum(axis=1, keepdims=True))
        y = basis[:, 2] - (x @ basis[:, 2:]) * x
        length = np.sqrt((y * y).sum(axis=1, keepdims=True))
        on_axis = length[:, 0] < _ON_FIRST_AXIS
        if on_axis.any():
            other = basis[:, 0] - (x @ basis[:, :1]) * x
            y = np.where(on_axis[:, None], other, y)
            length = np.sqrt((y * y).sum(axis=1, keepdims=True))
        y = y / length
        frame[:, :, 0], frame[:, :, 1] = x, y
        frame[:, 0, 2] = x[:, 1] * y[:, 2] - x[:, 2] * y[:, 1]
        frame[:, 1, 2] = x[:, 2] * y[:, 0] - x[:, 0] * y[:, 2]
        frame[:, 2, 2] = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
        return frame

    def _poses(self, T_base_tool: Array, slide_m: float | Array, bend: float) -> _Poses:
        g = self.geometry
        along = self._shoulder_to_wrist(T_base_tool, slide_m)
        angle, valid = self.elbow.angle(np.sqrt((along * along).sum(axis=1)), bend)
        before, after = self.elbow.frames(angle)
        reference = self._reference_frame(along)
        turned = g.R_base_tool_zero.T @ g.wrist_joint.after
        shoulder = swivel.entries(g.shoulder_joint.basis.T @ reference, g.shoulder_joint.after.T @ before, 1.0)
        tool = (T_base_tool[:, :3, :3] @ turned).transpose(0, 2, 1)
        wrist = swivel.entries(g.wrist_joint.basis.T @ after, tool @ reference, -1.0)
        return _Poses(shoulder, wrist, angle, valid)

    def _solve_bend(self, T_base_tool: Array, slide_m: float | Array, bend: float) -> list[Solutions]:
        poses = self._poses(T_base_tool, slide_m, bend)
        at_shoulder = swivel.critical_angles(poses.shoulder, self.shoulder_limits)
        cuts = np.concatenate([at_shoulder, swivel.critical_angles(poses.wrist, self.wrist_limits)], axis=1)
        cuts.sort(axis=1)
        samples = swivel.sample_intervals(cuts, self._feasible(poses, cuts), CONFIGURATIONS_PER_POSE)
        shoulder_flips, wrist_flips = self._columns()
        flips = (shoulder_flips[samples.column, None], wrist_flips[samples.column, None])
        q = self._assemble(poses, samples.row, samples.angle, flips)
        q = np.minimum(np.maximum(q, self.geometry.lower), self.geometry.upper)
        branches = (shoulder_flips < 0) + 2 * (wrist_flips < 0) + (4 if bend < 0 else 0)
        ends = np.searchsorted(samples.row, np.arange(len(T_base_tool) + 1)).tolist()
        angle, branch = swivel.wrapped(samples.angle), branches[samples.column]
        return [Solutions(q[a:b], angle[a:b], branch[a:b]) for a, b in zip(ends, ends[1:], strict=False)]

    def _columns(self) -> tuple[Array, Array]:
        """Signs of shoulder and wrist for each column of the feasibility table."""
        return np.repeat(self.shoulder_flips, len(self.wrist_flips)), np.tile(self.wrist_flips, len(self.shoulder_flips))

    def _feasible(self, poses: _Poses, cuts: Array) -> swivel.Mask:
        """Whether each interval (m, k) between cuts is within limits, for each branch: (m, b, k)."""
        g = self.geometry
        following = np.concatenate([cuts[:, 1:], cuts[:, :1] + swivel.TWO_PI], axis=1)
        weights = _weights((cuts + following) / 2)
        shoulder = swivel.joint_angles(
            weights @ poses.shoulder, self.shoulder_flips, g.shoulder_joint.offset, self.shoulder_limits
        )
        wrist = swivel.joint_angles(weights @ poses.wrist, self.wrist_flips, g.wrist_joint.offset, self.wrist_limits)
        wide = (following - cuts > 1e-12) & poses.valid[:, None]
        fits = swivel.within(shoulder, self.shoulder_limits)[..., None] & swivel.within(wrist, self.wrist_limits)[..., None, :]
        return (fits & wide[..., None, None]).reshape(*cuts.shape, -1).transpose(0, 2, 1)

    def _assemble(self, poses: _Poses, row: NDArray[np.int64], angle: Array, flips: tuple[Array, Array]) -> Array:
        """Configurations (n, 7) at swivel angles (n,) of poses `row` (n,); signs (n, 1), or (1,) for all rows."""
        g = self.geometry
        weights = _weights(angle)[:, None, :]
        shoulder, wrist = (weights @ poses.shoulder[row])[:, 0], (weights @ poses.wrist[row])[:, 0]
        q = np.empty((len(angle), 7))
        q[:, :3] = swivel.joint_angles(shoulder, flips[0], g.shoulder_joint.offset, self.shoulder_limits)[:, 0]
        q[:, 3] = poses.elbow[row]
        q[:, 4:] = swivel.joint_angles(wrist, flips[1], g.wrist_joint.offset, self.wrist_limits)[:, 0]
        return q


def srs_arm(geometry: SrsGeometry) -> SrsArm:
    lower, upper = geometry.lower, geometry.upper
    return SrsArm(
        geometry=geometry,
        elbow=elbow(geometry),
        shoulder_limits=swivel.limits(geometry.shoulder_joint, lower[:3], upper[:3]),
        wrist_limits=swivel.limits(geometry.wrist_joint, lower[4:], upper[4:]),
        shoulder_flips=swivel.possible_flips(geometry.shoulder_joint, float(lower[1]), float(upper[1])),
        wrist_flips=swivel.possible_flips(geometry.wrist_joint, float(lower[5]), float(upper[5])),
    )


def _sign(branch: int, bit: int) -> float:
    return -1.0 if branch & bit else 1.0


def _weights(angle: Array) -> Array:
    """(..., 3): 1, cos and sin of each angle."""
    result = np.ones((*angle.shape, 3))
    np.cos(angle, out=result[..., 1])
    np.sin(angle, out=result[..., 2])
    return result


def _rotation(joint: Spherical, q: Array) -> Array:
    (c1, c2, c3), (s1, s2, s3) = (f(q + np.array([0.0, joint.offset, 0.0])) for f in (np.cos, np.sin))
    first = np.array([[c1, -s1, 0.0], [s1, c1, 0.0], [0.0, 0.0, 1.0]])
    second = np.array([[c2, 0.0, s2], [0.0, 1.0, 0.0], [-s2, 0.0, c2]])
    third = np.array([[c3, -s3, 0.0], [s3, c3, 0.0], [0.0, 0.0, 1.0]])
    return joint.basis @ first @ second @ third @ joint.after.T


def _joined(parts: tuple[Solutions, ...]) -> Solutions:
    return Solutions(
        np.concatenate([part.q for part in parts]),
        np.concatenate([part.swivel_angle for part in parts]),
        np.concatenate([part.branch for part in parts]),
    )
