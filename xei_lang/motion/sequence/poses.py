"""Tool poses of families as arrays: targets times members, and which members turn into each other about z."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Pose

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
