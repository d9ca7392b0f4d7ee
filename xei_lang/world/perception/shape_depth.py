"""The depth image that an object of primitives would give: rays on boxes, cylinders, spheres, capsules.

Each ray is `origin + t * direction`. Slab and quadric intersections as in Ericson, Real-Time Collision
Detection (2005), 5.3, over all rays at once.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Primitive, Shape, Sphere
from xei_lang.world.perception.optics import Array, matrix_of


def first_hits(origin_m: Array, directions: Array, primitives: Sequence[Primitive]) -> Array:
    """How far along each ray, in units of its direction, the first surface of the object is; inf for none.

    `origin_m` (3,) and `directions` (n, 3) are in the object's frame. A ray that begins inside of a primitive
    does not hit that one.
    """
    nearest = np.full(len(directions), np.inf)
    for primitive in primitives:
        inverse = np.linalg.inv(matrix_of(primitive.T_object_shape))
        start = inverse[:3, :3] @ origin_m + inverse[:3, 3]
        nearest = np.minimum(nearest, _hits(start, directions @ inverse[:3, :3].T, primitive.shape))
    return nearest


def _hits(start: Array, ways: Array, shape: Shape) -> Array:
    if isinstance(shape, Box):
        near, far = _slabs(start, ways, 0.5 * np.array(shape.size_m))
    elif isinstance(shape, Sphere):
        near, far = _ball(start, ways, shape.radius_m)
    elif isinstance(shape, Cylinder):
        near, far = _tube(start, ways, shape.radius_m, 0.5 * shape.height_m)
    else:
        return _capsule(start, ways, shape)
    return np.where((near > 0.0) & (near <= far), near, np.inf)


def _capsule(start: Array, ways: Array, shape: Capsule) -> Array:
    half = 0.5 * shape.height_m
    found = _hits(start, ways, Cylinder(shape.radius_m, shape.height_m))
    for end in (-half, half):
        found = np.minimum(found, _hits(start - np.array((0.0, 0.0, end)), ways, Sphere(shape.radius_m)))
    return found


def _slabs(start: Array, ways: Array, half: Array) -> tuple[Array, Array]:
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (-half - start) / ways, (half - start) / ways
    # A ray in a face's plane gives 0/0; it counts as inside of that slab.
    near = np.nan_to_num(np.minimum(first, second), nan=-np.inf, posinf=np.inf, neginf=-np.inf)
    far = np.nan_to_num(np.maximum(first, second), nan=np.inf, posinf=np.inf, neginf=-np.inf)
    return near.max(axis=1), far.min(axis=1)


def _ball(start: Array, ways: Array, radius: float) -> tuple[Array, Array]:
    return _roots((ways**2).sum(axis=1), ways @ start, float(start @ start) - radius**2)


def _tube(start: Array, ways: Array, radius: float, half: float) -> tuple[Array, Array]:
    flat, at = ways[:, :2], start[:2]
    around = _roots((flat**2).sum(axis=1), flat @ at, float(at @ at) - radius**2)
    ends = _slabs(start[2:], ways[:, 2:], np.array([half]))
    return np.maximum(around[0], ends[0]), np.minimum(around[1], ends[1])


def _roots(a: Array, b: Array, c: float) -> tuple[Array, Array]:
    """Where a t^2 + 2 b t + c <= 0 begins and ends for each ray; an empty stretch is (inf, -inf)."""
    inside = b**2 - a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(np.maximum(inside, 0.0))
        near, far = (-b - root) / a, (-b + root) / a
    along = a < 1e-15
    near = np.where(along, -np.inf if c <= 0.0 else np.inf, near)
    far = np.where(along, np.inf if c <= 0.0 else -np.inf, far)
    missed = ~along & (inside < 0.0)
    return np.where(missed, np.inf, near), np.where(missed, -np.inf, far)
