"""Tool poses of families as arrays: targets times members, and which members turn into each other about z."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Family, ToolTarget

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_ORBIT_DIGITS = 6


def matrix(pose: Pose) -> Array:
    """The homogeneous matrix (4, 4) of a pose."""
    return np.array(pose.matrix())


def pose_of(T: Array) -> Pose:
    """The pose of a homogeneous matrix (4, 4)."""
    x, y, z = ((float(T[0, k]), float(T[1, k]), float(T[2, k])) for k in range(3))
    return Pose.from_axes((float(T[0, 3]), float(T[1, 3]), float(T[2, 3])), x, y, z)


def tool_poses(target: ToolTarget, family: Family) -> Array:
    """`T_base_tool` (members, 4, 4) of a target for each member of its family."""
    members = np.array([member.T_reference_tool.matrix() for member in family.members])
    poses = matrix(target.T_base_reference) @ members @ matrix(Pose(target.offset_tool_m))
    poses[:, :3, 3] += target.offset_base_m
    return poses


def orbits(family: Family) -> Ints:
    """A number (members,) that is equal for members that are one grasp turned about the reference's z axis.

    A tool pose (R, p) turned about z keeps `R.T @ z` and `R.T @ p`, and nothing else is kept: these are
    compared.
    """
    members = np.array([member.T_reference_tool.matrix() for member in family.members])
    kept = np.concatenate(
        [members[:, 2, :3], np.einsum("mji,mj->mi", members[:, :3, :3], members[:, :3, 3])], axis=1
    )
    _, orbit = np.unique(np.round(kept, _ORBIT_DIGITS) + 0.0, axis=0, return_inverse=True)
    return np.asarray(orbit, dtype=np.int64).reshape(-1)


def same_grasp(family: Family, member: int, turned: bool) -> Bools:
    """Which members (m,) show the grasp `member`: itself alone, or with turns of the reference its whole
    orbit.
    """
    names = orbits(family) if turned else np.arange(len(family.members))
    return names == names[member]


def interpolate(T_start: Array, T_end: Array, step_m: float, step_rad: float) -> Array:
    """Poses (m, 4, 4) on a straight line, turning at constant rate, both ends included."""
    rotation = T_start[:3, :3].T @ T_end[:3, :3]
    angle = math.acos(min(1.0, max(-1.0, (float(np.trace(rotation)) - 1.0) / 2.0)))
    distance = float(np.linalg.norm(T_end[:3, 3] - T_start[:3, 3]))
    count = max(2, math.ceil(max(distance / step_m, angle / step_rad)) + 1)
    share = np.linspace(0.0, 1.0, count)
    poses = np.tile(T_start, (count, 1, 1))
    poses[:, :3, 3] += share[:, None] * (T_end[:3, 3] - T_start[:3, 3])
    if angle > 1e-9:
        poses[:, :3, :3] = T_start[:3, :3] @ _rotations(rotation, angle, share)
    poses[-1] = T_end
    return poses


def _rotations(rotation: Array, angle: float, share: Array) -> Array:
    """Rotations (m, 3, 3) about the axis of `rotation` by shares of its angle (Rodrigues)."""
    skew = (
        (rotation - rotation.T) / (2.0 * math.sin(angle)) if math.pi - angle > 1e-6 else _half_turn(rotation)
    )
    a = (share * angle)[:, None, None]
    return np.eye(3) + np.sin(a) * skew + (1.0 - np.cos(a)) * (skew @ skew)


def _half_turn(rotation: Array) -> Array:
    """The cross-product matrix of the axis of a half turn."""
    axis = np.sqrt(np.maximum(np.diag(rotation) + 1.0, 0.0) / 2.0)
    largest = int(np.argmax(axis))
    axis = (rotation[:, largest] + np.eye(3)[largest]) / (2.0 * axis[largest])
    return np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
