"""Paths of the tool in space: straight, turning about an axis (arc, screw), covering a rectangle (raster).

Each gives its poses in closed form over a share in [0, 1] of its way, and shares that are close enough to
follow it by. What a configuration space makes of them is `sequence/legs.py`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.tool_paths import Raster, Turn

Array = NDArray[np.float64]

_PER_HALF_CIRCLE = 8


class ToolPath(Protocol):
    """A way of the tool from one pose to another."""

    def poses(self, share: Array) -> Array:
        """`T_base_tool` (m, 4, 4) at shares (m,) of the way."""
        ...

    def shares(self, step_m: float, step_rad: float) -> Array:
        """Ascending shares (m,), both ends among them, between which the tool moves and turns at most so
        far.
        """
        ...


@dataclass(frozen=True, slots=True)
class StraightPath:
    """A straight line that turns at a constant rate, from one pose (4, 4) to another."""

    T_start: Array
    T_end: Array

    def poses(self, share: Array) -> Array:
        """See `ToolPath`."""
        rotation, angle = self._turn()
        poses = np.tile(self.T_start, (len(share), 1, 1))
        poses[:, :3, 3] += share[:, None] * (self.T_end[:3, 3] - self.T_start[:3, 3])
        if angle > 1e-9:
            poses[:, :3, :3] = self.T_start[:3, :3] @ _rotations(_axis(rotation, angle), share * angle)
        poses[share == 1.0] = self.T_end
        return poses

    def shares(self, step_m: float, step_rad: float) -> Array:
        """See `ToolPath`."""
        distance = float(np.linalg.norm(self.T_end[:3, 3] - self.T_start[:3, 3]))
        return _even(max(distance / step_m, self._turn()[1] / step_rad))

    def _turn(self) -> tuple[Array, float]:
        rotation = self.T_start[:3, :3].T @ self.T_end[:3, :3]
        return rotation, math.acos(min(1.0, max(-1.0, (float(np.trace(rotation)) - 1.0) / 2.0)))


@dataclass(frozen=True, slots=True)
class TurningPath:
    """A turn about an axis of the base frame, with its lead, from a pose (4, 4) on."""

    T_start: Array
    turn: Turn

    def poses(self, share: Array) -> Array:
        """See `ToolPath`."""
        return displacements(self.turn, share) @ self.T_start

    def shares(self, step_m: float, step_rad: float) -> Array:
        """See `ToolPath`."""
        arm = self.T_start[:3, 3] - np.array(self.turn.point_m)
        radius = float(np.linalg.norm(np.cross(np.array(self.turn.direction), arm)))
        angle = abs(self.turn.angle_rad)
        length = math.hypot(radius * angle, self.turn.travel_m)
        return _even(max(length / step_m, angle / step_rad))


@dataclass(frozen=True, slots=True)
class SweepingPath:
    """A cover of a rectangle at constant orientation, from a pose (4, 4) on."""

    T_start: Array
    raster: Raster

    def poses(self, share: Array) -> Array:
        """See `ToolPath`."""
        return displacements(self.raster, share) @ self.T_start

    def shares(self, step_m: float, step_rad: float) -> Array:
        """See `ToolPath`. Turns of the path stand closer than its lanes."""
        ends = _marks(self.raster)
        steps = [
            max(1, math.ceil(length / step_m)) if index % 2 == 0 else _PER_HALF_CIRCLE
            for index, length in enumerate(np.diff(ends).tolist())
        ]
        parts: list[Array] = [
            np.linspace(a, b, count + 1)[:-1]
            for a, b, count in zip(ends.tolist(), ends[1:].tolist(), steps, strict=False)
        ]
        return np.concatenate([*parts, ends[-1:]]) / ends[-1]


def displacements(path: Turn | Raster, share: Array) -> Array:
    """What a stated path does to any pose of the base frame: transforms (m, 4, 4) at shares (m,) of it."""
    moved = np.tile(np.eye(4), (len(share), 1, 1))
    if isinstance(path, Raster):
        moved[:, :3, 3] = _raster_points(path, share)
        return moved
    axis, point = np.array(path.direction), np.array(path.point_m)
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    moved[:, :3, :3] = _rotations(skew, share * path.angle_rad)
    moved[:, :3, 3] = point - moved[:, :3, :3] @ point + np.outer(share * path.travel_m, axis)
    return moved


def _marks(raster: Raster) -> Array:
    """Path lengths (2 lanes,) at which lanes and the half circles between them begin and end, in turn."""
    length, radius = math.hypot(*raster.along_m), raster.lane_distance_m / 2
    marks = [0.0]
    for lane in range(raster.lanes):
        ends = (lane > 0) + (lane + 1 < raster.lanes)
        marks.append(marks[-1] + length - ends * radius)
        if lane + 1 < raster.lanes:
            marks.append(marks[-1] + math.pi * radius)
    return np.array(marks)


def _raster_points(raster: Raster, share: Array) -> Array:
    """Where the reference is from its corner (m, 3)."""
    marks, radius = _marks(raster), raster.lane_distance_m / 2
    length = math.hypot(*raster.along_m)
    s: Array = np.clip(share, 0.0, 1.0) * float(marks[-1])
    part = np.asarray(np.clip(np.searchsorted(marks, s, side="right") - 1, 0, len(marks) - 2), dtype=np.int64)
    within, lane = s - marks[part], part // 2
    forth = np.where(lane % 2 == 0, 1.0, -1.0)
    first = np.where(lane > 0, radius, 0.0)
    straight = first + within
    angle = within / max(radius, 1e-12)
    curved = length - radius + radius * np.sin(angle)
    along = np.where(part % 2 == 0, straight, curved)
    along = np.where(forth > 0.0, along, length - along)
    across = 2 * radius * lane + np.where(part % 2 == 0, 0.0, radius * (1.0 - np.cos(angle)))
    edges = [np.array(edge) / max(math.hypot(*edge), 1e-12) for edge in (raster.along_m, raster.across_m)]
    return np.outer(along, edges[0]) + np.outer(across, edges[1])


def _even(steps: float) -> Array:
    return np.linspace(0.0, 1.0, max(2, math.ceil(steps)) + 1)


def _rotations(skew: Array, angle: Array) -> Array:
    """Rotations (m, 3, 3) by angles (m,) about the axis of a cross-product matrix (Rodrigues)."""
    a = angle[:, None, None]
    return np.eye(3) + np.sin(a) * skew + (1.0 - np.cos(a)) * (skew @ skew)


def _axis(rotation: Array, angle: float) -> Array:
    """The cross-product matrix of a rotation's axis."""
    if math.pi - angle > 1e-6:
        return (rotation - rotation.T) / (2.0 * math.sin(angle))
    axis = np.sqrt(np.maximum(np.diag(rotation) + 1.0, 0.0) / 2.0)
    largest = int(np.argmax(axis))
    axis = (rotation[:, largest] + np.eye(3)[largest]) / (2.0 * axis[largest])
    return np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
