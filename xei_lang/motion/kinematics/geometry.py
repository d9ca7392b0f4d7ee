"""Measures an arm's S-R-S geometry on the model: two spherical joints, shoulder and wrist, and an elbow
hinge.

All vectors are in base_link with every joint, slide included, at zero. Nothing is assumed of the arm's side:
left and right differ where the model says so.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from xei_lang.motion.robot import Array, Robot, Side

INTERSECTION_TOLERANCE_M = 1e-9
RIGHT_ANGLE_TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True)
class Spherical:
    """Three joints whose axes meet in a point, the middle one at right angles to its neighbours.

    `exp(a1 q1) exp(a2 q2) exp(a3 q3) = basis Rz(q1) Ry(q2 + offset) Rz(q3) after.T`, with basis = [a2 x a1,
    a2, a1] and offset the angle about a2 from a1 to a3.
    """

    basis: Array
    offset: float
    after: Array


@dataclass(frozen=True, slots=True)
class SrsGeometry:
    """An arm's closed-form geometry; `lower` and `upper` (7,) are its joint limits in rad."""

    shoulder: Array
    elbow: Array
    wrist: Array
    elbow_axis: Array
    shoulder_joint: Spherical
    wrist_joint: Spherical
    R_base_tool_zero: Array
    wrist_in_tool: Array
    slide_axis: Array
    lower: Array = field(repr=False)
    upper: Array = field(repr=False)


def srs_geometry(robot: Robot, side: Side) -> SrsGeometry | None:
    """The arm's S-R-S geometry, or None where its axes do not meet as closed form needs.

    Asked for: axes 1-3 meet, axes 5-7 meet, axes 1-2, 2-3, 5-6, 6-7 at right angles, and the elbow axis at
    right angles to the lines from it to shoulder and wrist.
    """
    arm = robot.arm(side)
    q = np.zeros(robot.nq)
    points, axes = _axes(robot, arm.joint_names)
    shoulder, wrist = _meeting_point(points[:3], axes[:3]), _meeting_point(points[4:], axes[4:])
    joints = (_spherical(*axes[:3]), _spherical(*axes[4:]))
    if shoulder is None or wrist is None or joints[0] is None or joints[1] is None:
        return None
    along = axes[3]
    elbow = points[3] + along * float(along @ (shoulder - points[3]))
    if abs(float(along @ (wrist - elbow))) > INTERSECTION_TOLERANCE_M:
        return None
    T_base_tool = robot.T_base_frame(q, arm.tool_frame)
    R = T_base_tool[:3, :3]
    return SrsGeometry(
        shoulder=shoulder,
        elbow=elbow,
        wrist=wrist,
        elbow_axis=along,
        shoulder_joint=joints[0],
        wrist_joint=joints[1],
        R_base_tool_zero=R,
        wrist_in_tool=R.T @ (wrist - T_base_tool[:3, 3]),
        slide_axis=np.array(robot.slide_axis),
        lower=robot.lower[arm.span],
        upper=robot.upper[arm.span],
    )


def _axes(robot: Robot, joint_names: tuple[str, ...]) -> tuple[Array, Array]:
    """A point on each joint's axis and the axis' direction (7, 3), from twists of the zero configuration."""
    q = np.zeros(robot.nq)
    points, axes = np.empty((len(joint_names), 3)), np.empty((len(joint_names), 3))
    for row, name in enumerate(joint_names):
        points[row] = robot.T_base_frame(q, name)[:3, 3]
        axes[row] = robot.jacobian(q, name)[3:, robot.joint_names.index(name)]
    return points, axes


def _meeting_point(points: Array, axes: Array) -> Array | None:
    """The point nearest to all lines, or None where it misses one of them."""
    projectors = np.eye(3) - axes[:, :, None] * axes[:, None, :]
    total: Array = np.add.reduce(projectors, axis=0)
    moment: Array = np.einsum("kij,kj->i", projectors, points)
    point = np.asarray(np.linalg.solve(total, moment), dtype=np.float64)
    misses = np.linalg.norm(np.einsum("kij,kj->ki", projectors, point - points), axis=1)
    return point if float(misses.max()) < INTERSECTION_TOLERANCE_M else None


def _spherical(first: Array, second: Array, third: Array) -> Spherical | None:
    if max(abs(float(first @ second)), abs(float(second @ third))) > RIGHT_ANGLE_TOLERANCE:
        return None
    side = np.cross(second, first)
    basis = np.column_stack([side, second, first])
    offset = float(np.arctan2(third @ side, third @ first))
    c, s = np.cos(offset), np.sin(offset)
    turned = basis @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    return Spherical(basis, offset, turned)
