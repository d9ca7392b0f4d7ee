"""Where an object would be seen in a picture, and at which depth at each pixel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Box, Capsule, Pose, Primitive, Sphere
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Array, Optics, matrix_of
from xei_lang.world.perception.shape_depth import first_hits

_MAX_RAYS = 40_000
"""More are thinned out: a table fills half of a picture, and says no more by each of its pixels."""
_NEAR_M = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class Silhouette:
    """Pixels (n, 2), row before column, that lie on the object, and the depths in m expected there.

    They stand on a grid of every `step`-th pixel; `is_cut` where the object goes on past the picture's edge.
    """

    pixels: NDArray[np.intp]
    depths_m: Array
    step: int
    is_cut: bool


def silhouette(primitives: Sequence[Primitive], T_camera_object: Pose, optics: Optics) -> Silhouette | None:
    """The object at a pose in the camera's body frame; None where no pixel shows it."""
    T = matrix_of(T_CAMERA_OPTICAL.inverse() @ T_camera_object)
    window = _window(primitives, T, optics)
    if window is None:
        return None
    (left, top, right, bottom), is_cut = window
    step = max(1, int(np.ceil(np.sqrt((right - left) * (bottom - top) / _MAX_RAYS))))
    rows, columns = np.mgrid[top:bottom:step, left:right:step]
    pixels = np.stack([rows.reshape(-1), columns.reshape(-1)], axis=1)
    rays = optics.rays(pixels[:, ::-1].astype(np.float64))
    ways = np.concatenate([rays, np.ones((len(rays), 1))], axis=1)
    inverse = matrix_of(T_camera_object.inverse() @ T_CAMERA_OPTICAL)
    # Directions have z = 1 in the optical frame, so the way along them is the depth.
    depths = first_hits(inverse[:3, 3], ways @ inverse[:3, :3].T, primitives)
    on = np.isfinite(depths)
    return Silhouette(pixels[on], depths[on], step, is_cut) if on.any() else None


def _window(
    primitives: Sequence[Primitive], T_optical_object: Array, optics: Optics
) -> tuple[tuple[int, int, int, int], bool] | None:
    """Columns and rows that may show the object, the end excluded, and whether it reaches past them."""
    width, height = optics.size_px
    corners = np.concatenate([_corners(part) for part in primitives])
    seen = corners @ T_optical_object[:3, :3].T + T_optical_object[:3, 3]
    if (seen[:, 2] < _NEAR_M).all():
        return None
    if (seen[:, 2] < _NEAR_M).any():
        return (0, 0, width, height), True
    pixels, _ = optics.project(seen)
    low, high = np.floor(pixels.min(axis=0)), np.ceil(pixels.max(axis=0)) + 1.0
    if not np.isfinite(pixels).all():
        return (0, 0, width, height), True
    cut = bool((low < 0).any() or high[0] > width or high[1] > height)
    left, top = (int(max(value, 0.0)) for value in low)
    right, bottom = int(min(high[0], width)), int(min(high[1], height))
    return ((left, top, right, bottom), cut) if left < right and top < bottom else None


def _corners(part: Primitive) -> Array:
    """The eight corners of a box around a primitive, in the object's frame."""
    half = half_size(part)
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    T = matrix_of(part.T_object_shape)
    return (signs * half) @ T[:3, :3].T + T[:3, 3]


def half_size(part: Primitive) -> Array:
    """Half the edges, m, of the box around a primitive along its own axes."""
    shape = part.shape
    if isinstance(shape, Box):
        return 0.5 * np.array(shape.size_m)
    if isinstance(shape, Sphere):
        return np.full(3, shape.radius_m)
    rounded = shape.radius_m if isinstance(shape, Capsule) else 0.0
    return np.array((shape.radius_m, shape.radius_m, 0.5 * shape.height_m + rounded))
