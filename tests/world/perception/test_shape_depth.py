"""Rays on primitives: distances against the surfaces' own equations, over random shapes and rays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive, Sphere
from xei_lang.world.perception.optics import matrix_of
from xei_lang.world.perception.shape_depth import first_hits

SHAPES = (Box((0.2, 0.1, 0.3)), Cylinder(0.07, 0.2), Sphere(0.1), Capsule(0.05, 0.12))


def outside(shape, points: np.ndarray) -> np.ndarray:
    """How far points (n, 3) are outside of a shape, m; negative inside."""
    if isinstance(shape, Box):
        over = np.abs(points) - 0.5 * np.array(shape.size_m)
        return np.linalg.norm(np.maximum(over, 0), axis=1) + np.minimum(over.max(axis=1), 0)
    if isinstance(shape, Sphere):
        return np.linalg.norm(points, axis=1) - shape.radius_m
    if isinstance(shape, Capsule):
        z = np.clip(points[:, 2], -shape.height_m / 2, shape.height_m / 2)
        return np.linalg.norm(points - np.stack([0 * z, 0 * z, z], axis=1), axis=1) - shape.radius_m
    over = np.stack([np.hypot(points[:, 0], points[:, 1]) - shape.radius_m,
                     np.abs(points[:, 2]) - shape.height_m / 2], axis=1)  # fmt: skip
    return np.linalg.norm(np.maximum(over, 0), axis=1) + np.minimum(over.max(axis=1), 0)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
@given(seed=st.integers(0, 1000))
def test_a_hit_lies_on_the_surface_and_nothing_lies_before_it(shape, seed):
    random = np.random.default_rng(seed)
    T = Pose.from_rpy(tuple(random.uniform(-0.2, 0.2, 3)), tuple(random.uniform(-3, 3, 3)))
    origin = random.normal(size=3)
    origin *= random.uniform(0.8, 2.0) / np.linalg.norm(origin)
    directions = random.uniform(-0.25, 0.25, (40, 3)) - origin
    hits = first_hits(origin, directions, (Primitive(shape, T),))
    inverse = np.linalg.inv(matrix_of(T))
    start, ways = inverse[:3, :3] @ origin + inverse[:3, 3], directions @ inverse[:3, :3].T
    steps = np.linspace(0.0, 3.0, 400)
    for hit, way in zip(hits, ways, strict=True):
        along = outside(shape, start + steps[:, None] * way)
        if np.isfinite(hit):
            assert abs(outside(shape, (start + hit * way)[None])[0]) < 1e-9
            assert (along[steps < hit - 1e-6] > -1e-9).all()
        else:
            assert (along > -1e-9).all()


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: type(shape).__name__)
def test_rays_along_the_axes_hit_or_miss_as_they_should(shape):
    primitive = Primitive(shape, Pose())
    for axis in range(3):
        way = np.zeros((1, 3))
        way[0, axis] = 1.0
        start = -2.0 * way[0]
        (hit,) = first_hits(start, way, (primitive,))
        assert abs(outside(shape, (start + hit * way[0])[None])[0]) < 1e-12
        beside = start.copy()
        beside[(axis + 1) % 3] = 1.0
        assert np.isinf(first_hits(beside, way, (primitive,))[0])
        assert np.isinf(first_hits(start, -way, (primitive,))[0])


def test_the_nearest_of_several_primitives_is_hit():
    parts = (Primitive(Sphere(0.1), Pose((0, 0, 1.0))), Primitive(Sphere(0.1), Pose((0, 0, 0.5))))
    assert np.isclose(first_hits(np.zeros(3), np.array([[0.0, 0.0, 1.0]]), parts)[0], 0.4)
