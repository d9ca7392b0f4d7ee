"""Closed-form inverse kinematics of an arm with a spherical shoulder, a hinge elbow and a spherical wrist
(S-R-S).

The tool pose fixes the wrist centre, its distance from the shoulder fixes the elbow, and what is left free is
one angle: the swivel of the elbow about the line from shoulder to wrist. It is 0 where the elbow's hinge lies
in the plane of that line and the arm's first axis. The geometry is measured (`geometry.py`), the limits on
the swivel are exact (`swivel.py`).

A branch is a bit set: 1 the shoulder's middle joint flipped, 2 the wrist's, 4 the elbow bent the other way;
limits leave only some. Singular cases: with the arm straight the swivel turns the whole arm and stays well
defined, since it is told by the hinge and not by the elbow's place. With the wrist on the first axis the
angle is measured from another fixed direction. With a spherical joint's outer axes in line only the sum of
their angles is fixed; it is shared in proportion to their spans, within limits whenever any share is.
Feasible intervals narrower than rounding (1e-12 rad) may be missed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics import swivel
from xei_lang.motion.kinematics.elbow import Elbow, across, elbow
from xei_lang.motion.kinematics.geometry import Spherical, SrsGeometry
from xei_lang.motion.kinematics.solver import Solutions
from xei_lang.motion.robot import Array

CONFIGURATIONS_PER_POSE = 20
_ON_FIRST_AXIS = 1e-4
_NARROWEST_RAD = 1e-12
_SIGNS = np.array([1.0, -1.0])


@dataclass(frozen=True, slots=True)
class _Poses:
    """Tool poses with all but the swivel angle settled: entries (m, 3, 2, 9) of shoulder and wrist, elbow
    (m,).
    """

    entries: Array
    elbow: Array
    valid: swivel.Mask


@dataclass(frozen=True, slots=True)
class SrsArm:
    """The closed-form solver of one arm; see `Solver` for its methods. Make one with `srs_arm`.

    `shoulder_flips` and `wrist_flips` (b,) tell each branch that limits leave: 0 the sign +1, 1 the sign -1.
    """

    geometry: SrsGeometry = field(repr=False)
    elbow: Elbow = field(repr=False)
    limits: swivel.Limits = field(repr=False)
    across_axes: tuple[Array, Array] = field(repr=False)
    R_tool_wrist: Array = field(repr=False)
    shoulder_flips: NDArray[np.int64]
    wrist_flips: NDArray[np.int64]

    @property
    def name(self) -> str:
        """`srs-closed-form`."""
        return "srs-closed-form"

    def solve(self, T_base_tool: Array, slide_m: float) -> Solutions:
        """Configurations spread over all feasible swivel angles of all branches."""
        return self.solve_many(T_base_tool[None], slide_m)[0]

    def solve_many(self, T_base_tool: Array, slide_m: float | Array) -> list[Solutions]:
        """`solve` for many poses at once, ten times as fast a pose."""
        parts = [self._solve_bend(T_base_tool, slide_m, bend) for bend in self.elbow.bends]
        return parts[0] if len(parts) == 1 else [_joined(both) for both in zip(*parts, strict=True)]

    def at(self, T_base_tool: Array, slide_m: float, swivel_angle: float, branch: int) -> Array | None:
        """The configuration with this swivel angle and branch."""
        q, valid = self.at_many(T_base_tool[None], slide_m, swivel_angle, branch)
        return q[0] if valid[0] else None

    def at_many(
        self, T_base_tool: Array, slide_m: float | Array, swivel_angle: float | Array, branch: int
    ) -> tuple[Array, swivel.Mask]:
        """`at` for many poses at once."""
        count = len(T_base_tool)
        poses = self._poses(T_base_tool, slide_m, _sign(branch, 4))
        angle = np.broadcast_to(np.asarray(swivel_angle, dtype=np.float64), (count,))
        flips = np.array([[_sign(branch, 1)], [_sign(branch, 2)]])
        turned = swivel.joint_angles(poses.entries, angle, flips, self.limits)
        valid = poses.valid & swivel.within(turned, self.limits)[:, :, 0].all(axis=1)
        return self._assembled(turned, poses.elbow), valid

    def describe(self, q_arm: Array) -> tuple[float, int]:
        """Swivel angle and branch of a configuration."""
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
        """Metres between the pose's wrist and the shell that the elbow's limits let it reach."""
        nearest, farthest = self.elbow.reach_m
        distance = float(np.linalg.norm(self._shoulder_to_wrist(T_base_tool[None], slide_m)))
        return max(0.0, distance - farthest, nearest - distance)

    def _shoulder_to_wrist(self, T_base_tool: Array, slide_m: float | Array) -> Array:
        """Vectors (m, 3) in base_link, with the slide lowered to zero."""
        g = self.geometry
        lifted = np.multiply.outer(np.asarray(slide_m, dtype=np.float64), g.slide_axis) + g.shoulder
        return T_base_tool[:, :3, 3] + T_base_tool[:, :3, :3] @ g.wrist_in_tool - lifted

    def _reference_frame(self, direction: Array) -> Array:
        """Frames (m, 3, 3) that the swivel turns: x the given unit vector, y next to the arm's first axis."""
        x, axis = direction, self.geometry.shoulder_joint.basis[:, 2]
        z = x @ self.across_axes[0]
        length = np.sqrt((z * z).sum(axis=1, keepdims=True))
        if length.min(initial=1.0) < _ON_FIRST_AXIS:
            near = length < _ON_FIRST_AXIS
            axis = np.where(near, self.geometry.shoulder_joint.basis[:, 0], axis)
            z = np.where(near, x @ self.across_axes[1], z)
            length = np.sqrt((z * z).sum(axis=1, keepdims=True))
        frame = np.empty((len(x), 3, 3))
        frame[:, :, 0] = x
        frame[:, :, 1] = (axis - (x * axis).sum(axis=1, keepdims=True) * x) / length
        frame[:, :, 2] = z / length
        return frame

    def _poses(self, T_base_tool: Array, slide_m: float | Array, bend: float) -> _Poses:
        g = self.geometry
        along = self._shoulder_to_wrist(T_base_tool, slide_m)
        distance = np.sqrt((along * along).sum(axis=1))
        angle, valid = self.elbow.angle(distance, bend)
        before, after = self.elbow.frames(angle)
        reference = self._reference_frame(along / np.maximum(distance, 1e-300)[:, None])
        left, right = np.empty((2, len(along), 2, 3, 3))
        np.matmul(g.shoulder_joint.basis.T, reference, out=left[:, 0])
        np.matmul(g.wrist_joint.basis.T, after, out=left[:, 1])
        np.matmul(g.shoulder_joint.after.T, before, out=right[:, 0])
        np.matmul((T_base_tool[:, :3, :3] @ self.R_tool_wrist).transpose(0, 2, 1), reference, out=right[:, 1])
        return _Poses(swivel.entries(left, right), angle, valid)

    def _solve_bend(self, T_base_tool: Array, slide_m: float | Array, bend: float) -> list[Solutions]:
        poses = self._poses(T_base_tool, slide_m, bend)
        cuts = swivel.critical_angles(poses.entries, self.limits)
        samples = swivel.sample_intervals(cuts, self._feasible(poses, cuts), CONFIGURATIONS_PER_POSE)
        flips = np.empty((len(samples.angle), 2, 1))
        flips[:, 0, 0] = _SIGNS[self.shoulder_flips[samples.column]]
        flips[:, 1, 0] = _SIGNS[self.wrist_flips[samples.column]]
        turned = swivel.joint_angles(poses.entries[samples.row], samples.angle, flips, self.limits)
        sound: swivel.Mask = np.logical_and.reduce(swivel.within(turned, self.limits)[:, :, 0], axis=1)
        if not sound.all():
            samples, turned = samples.chosen(sound), turned[sound]
        q = self._assembled(turned, poses.elbow[samples.row])
        branch = (self.shoulder_flips + 2 * self.wrist_flips + (4 if bend < 0 else 0))[samples.column]
        angle = swivel.wrapped(samples.angle)
        ends = np.searchsorted(samples.row, np.arange(len(T_base_tool) + 1)).tolist()
        return [Solutions(q[a:b], angle[a:b], branch[a:b]) for a, b in pairwise(ends)]

    def _feasible(self, poses: _Poses, cuts: Array) -> swivel.Mask:
        """Whether each interval (m, k) between cuts is within limits, for each branch: (m, b, k)."""
        following = np.concatenate([cuts[:, 1:], cuts[:, :1] + swivel.TWO_PI], axis=1)
        turned = swivel.joint_angles(poses.entries[:, None], (cuts + following) / 2, _SIGNS, self.limits)
        fits = swivel.within(turned, self.limits)
        wide = (following - cuts > _NARROWEST_RAD) & poses.valid[:, None]
        both = fits[:, :, 0, self.shoulder_flips] & fits[:, :, 1, self.wrist_flips] & wide[:, :, None]
        return both.transpose(0, 2, 1)

    def _assembled(self, turned: Array, elbow_angle: Array) -> Array:
        """Configurations (n, 7), rounding at the limits cut off."""
        q = np.empty((len(turned), 7))
        q[:, :3], q[:, 3], q[:, 4:] = turned[:, 0, 0], elbow_angle, turned[:, 1, 0]
        return np.minimum(np.maximum(q, self.geometry.lower), self.geometry.upper)


def srs_arm(geometry: SrsGeometry) -> SrsArm:
    """The closed-form solver for a measured geometry."""
    lower, upper = geometry.lower[[[0, 1, 2], [4, 5, 6]]], geometry.upper[[[0, 1, 2], [4, 5, 6]]]
    joints = (geometry.shoulder_joint, geometry.wrist_joint)
    shoulder, wrist = (
        swivel.possible_flips(joint, float(lower[k, 1]), float(upper[k, 1])) for k, joint in enumerate(joints)
    )
    return SrsArm(
        geometry=geometry,
        elbow=elbow(geometry),
        limits=swivel.limits(joints, lower, upper),
        across_axes=(
            across(geometry.shoulder_joint.basis[:, 2]),
            across(geometry.shoulder_joint.basis[:, 0]),
        ),
        R_tool_wrist=geometry.R_base_tool_zero.T @ geometry.wrist_joint.after,
        shoulder_flips=np.repeat(np.array(shoulder), len(wrist)),
        wrist_flips=np.tile(np.array(wrist), len(shoulder)),
    )


def _sign(branch: int, bit: int) -> float:
    return -1.0 if branch & bit else 1.0


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
