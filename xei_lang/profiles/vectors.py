"""Vectors and poses from the quantities of validated models."""

from __future__ import annotations

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.quantity import Quantity


def vec3(values: list[Quantity] | None) -> Vec3:
    """Three quantities in SI units; zero where nothing is given."""
    x, y, z = (value.si for value in values) if values else (0.0, 0.0, 0.0)
    return (x, y, z)


def pose(position: list[Quantity] | None, rpy: list[Quantity] | None) -> Pose:
    """A pose from a position and fixed-axis roll, pitch, yaw."""
    return Pose.from_rpy(vec3(position), vec3(rpy))
