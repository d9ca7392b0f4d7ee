"""How a convex shape stands in a hole: how far out from the axis it reaches, and how deep, of all of it that
is under the mouth.

Round shapes are taken as prisms around them, wider by a fifth of a percent at most, so that nothing of them
is missed; spheres as they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Box, Capsule, Primitive, Sphere
from xei_lang.ir.world import Opening
from xei_lang.motion.verify.evaluate import Array

_SIDES = 48

Frames = tuple[Array, Array]
"""Rotations (n, 3, 3) and origins (n, 3)."""


@dataclass(frozen=True, slots=True)
class Inside:
    """For each of n poses: how far the shape reaches out from the axis of the hole that it is in, and how far
    under the mouth, m. Nothing of it is under the mouth where `depth_m` is 0.
    """

    radius_m: Array
    depth_m: Array


def stands_in(opening: Opening, shape: Primitive, frames: Frames, skin_m: float) -> Inside:
    """How a shape of a body stands in an opening, with frames of the body in the frame of the mouth. What is
    less than `skin_m` under the mouth lies on it. Of a grid it is the hole nearest to the shape's lower end.
    """
    part = _points(shape, frames, -skin_m)
    axes = _nearest(opening, part.middle)
    away = np.linalg.norm(part.points[:, :, :2] - axes[:, None, :], axis=2)
    radius = np.maximum((away + part.out).max(axis=1), 0.0)
    below = part.low < -skin_m
    return Inside(np.where(below, radius, 0.0), np.where(below, -part.low, 0.0))


@dataclass(frozen=True, slots=True)
class _Part:
    """Points (n, m, 3) of a shape with `out` (n, m) to be added to their distance from an axis, -inf for
    those not under the mouth; the middle of its lower end (n, 2), and its lowest (n,).
    """

    points: Array
    out: Array
    middle: Array
    low: Array


def _points(primitive: Primitive, frames: Frames, mouth_z: float) -> _Part:
    shape = primitive.shape
    if isinstance(shape, Sphere):
        return _balls(primitive, frames, mouth_z, (0.0,), shape.radius_m)
    if isinstance(shape, Capsule):
        half = shape.height_m / 2
        ends = _balls(primitive, frames, mouth_z, (-half, half), shape.radius_m)
        tube = _hull(primitive, frames, mouth_z, *_prism(shape.radius_m, shape.height_m))
        lower = np.where((ends.low < tube.low)[:, None], ends.middle, tube.middle)
        return _Part(
            np.concatenate([ends.points, tube.points], axis=1),
            np.concatenate([ends.out, tube.out], axis=1),
            lower,
            np.minimum(ends.low, tube.low),
        )
    if isinstance(shape, Box):
        return _hull(primitive, frames, mouth_z, *_box(shape))
    return _hull(primitive, frames, mouth_z, *_prism(shape.radius_m, shape.height_m))


def _placed(primitive: Primitive, frames: Frames, points: Array) -> Array:
    """Points (m, 3) of the shape's frame (n, m, 3) in the frame of the mouth."""
    T = np.array(primitive.T_object_shape.matrix())
    local = points @ T[:3, :3].T + T[:3, 3]
    return np.einsum("nij,mj->nmi", frames[0], local) + frames[1][:, None, :]


def _balls(
    primitive: Primitive, frames: Frames, mouth_z: float, heights: tuple[float, ...], radius_m: float
) -> _Part:
    centers = _placed(primitive, frames, np.array([(0.0, 0.0, z) for z in heights]))
    over = np.clip(centers[:, :, 2] - mouth_z, 0.0, radius_m)
    out = np.where(over < radius_m, np.sqrt(radius_m**2 - over**2), -np.inf)
    lowest = np.argmin(centers[:, :, 2], axis=1)
    first = centers[np.arange(len(centers)), lowest]
    return _Part(centers, out, first[:, :2], first[:, 2] - radius_m)


def _hull(
    primitive: Primitive, frames: Frames, mouth_z: float, corners: Array, edges: NDArray[np.int64]
) -> _Part:
    """The corners of a convex body under the mouth, and where its edges pass it: what reaches out farthest is
    one of these.
    """
    placed = _placed(primitive, frames, corners)
    a, b = placed[:, edges[:, 0]], placed[:, edges[:, 1]]
    crosses = (a[:, :, 2] > mouth_z) != (b[:, :, 2] > mouth_z)
    rise = np.where(crosses, b[:, :, 2] - a[:, :, 2], 1.0)
    share = np.where(crosses, (mouth_z - a[:, :, 2]) / rise, 0.0)
    passing = a + share[:, :, None] * (b - a)
    out = np.concatenate(
        [np.where(placed[:, :, 2] <= mouth_z, 0.0, -np.inf), np.where(crosses, 0.0, -np.inf)], axis=1
    )
    low = placed[:, :, 2].min(axis=1)
    # The lower half of the corners: the lower end of anything that stands upright.
    half = np.argsort(placed[:, :, 2], axis=1, kind="stable")[:, : len(corners) // 2]
    middle = np.take_along_axis(placed[:, :, :2], half[:, :, None], axis=1).mean(axis=1)
    return _Part(np.concatenate([placed, passing], axis=1), out, middle, low)


def _prism(radius_m: float, height_m: float) -> tuple[Array, NDArray[np.int64]]:
    """Corners and edges of the prism around a cylinder."""
    angle = np.arange(_SIDES) * (2.0 * math.pi / _SIDES)
    wide = radius_m / math.cos(math.pi / _SIDES)
    ring = np.column_stack([wide * np.cos(angle), wide * np.sin(angle)])
    ends = [np.column_stack([ring, np.full(_SIDES, z)]) for z in (-height_m / 2, height_m / 2)]
    one = np.arange(_SIDES)
    following = (one + 1) % _SIDES
    edges = [(one, following), (one + _SIDES, following + _SIDES), (one, one + _SIDES)]
    return np.concatenate(ends), np.concatenate([np.column_stack(pair) for pair in edges])


def _box(shape: Box) -> tuple[Array, NDArray[np.int64]]:
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    pairs = [(i, j) for i in range(8) for j in range(i) if np.abs(signs[i] - signs[j]).sum() == 2]
    return signs * np.array(shape.size_m) / 2, np.array(pairs, dtype=np.int64)


def _nearest(opening: Opening, points: Array) -> Array:
    """The axis (n, 2) of the hole nearest to points (n, 2), in the frame of the first one's mouth."""
    axes = np.zeros_like(points)
    for k, (count, pitch) in enumerate(zip(opening.counts, opening.pitch_m, strict=True)):
        if count > 1:
            axes[:, k] = np.clip(np.round(points[:, k] / pitch), 0, count - 1) * pitch
    return axes
