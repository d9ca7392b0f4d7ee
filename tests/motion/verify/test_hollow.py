"""How shapes stand in holes, against points strewn densely over their surfaces."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive, Shape, Sphere
from xei_lang.ir.world import Opening
from xei_lang.motion.verify.hollow import stands_in

SKIN_M = 2e-4
HOLE = Opening(Pose(), 0.01, 0.05)

Array = np.ndarray


def ring(radius_m: float, z: float, count: int = 1500) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    return np.column_stack([radius_m * np.cos(angle), radius_m * np.sin(angle), np.full(count, z)])


def ball(radius_m: float, z: float) -> Array:
    rings = [
        ring(radius_m * math.sin(turn), z + radius_m * math.cos(turn), 240)
        for turn in np.linspace(0.0, math.pi, 121)
    ]
    return np.concatenate(rings)


def strewn(shape: Shape) -> Array:
    """Points (m, 3) of a shape's surface in its own frame, close to each other."""
    if isinstance(shape, Sphere):
        return ball(shape.radius_m, 0.0)
    if isinstance(shape, Box):
        steps = [np.linspace(-size / 2, size / 2, 41) for size in shape.size_m]
        grid = np.stack(np.meshgrid(*steps), axis=-1).reshape(-1, 3)
        return grid[(np.abs(np.abs(grid) - np.array(shape.size_m) / 2) < 1e-12).any(axis=1)]
    half = shape.height_m / 2
    wall = np.concatenate([ring(shape.radius_m, z, 240) for z in np.linspace(-half, half, 161)])
    if isinstance(shape, Capsule):
        return np.concatenate([wall, ball(shape.radius_m, -half), ball(shape.radius_m, half)])
    return np.concatenate([wall, ring(shape.radius_m, -half), ring(shape.radius_m, half)])


def reference(shape: Shape, pose: Pose) -> tuple[float, float]:
    """The farthest from the axis and the deepest of the points under the mouth; nothing where none is."""
    T = np.array(pose.matrix())
    points = strewn(shape) @ T[:3, :3].T + T[:3, 3]
    under = points[points[:, 2] < -SKIN_M]
    if len(under) == 0:
        return 0.0, 0.0
    return float(np.linalg.norm(under[:, :2], axis=1).max()), float(-under[:, 2].min())


def found(shape: Shape, pose: Pose, opening: Opening = HOLE) -> tuple[float, float]:
    T = np.array(pose.matrix())
    inside = stands_in(opening, Primitive(shape), (T[None, :3, :3], T[None, :3, 3]), SKIN_M)
    return float(inside.radius_m[0]), float(inside.depth_m[0])


size = st.floats(0.002, 0.04)
shapes = st.one_of(
    st.builds(Cylinder, size, size),
    st.builds(Capsule, size, size),
    st.builds(Sphere, size),
    st.builds(Box, st.tuples(size, size, size)),
)
near = st.floats(-0.03, 0.03)
turn = st.floats(-math.pi, math.pi)
poses = st.builds(Pose.from_rpy, st.tuples(near, near, near), st.tuples(turn, turn, turn))


@settings(max_examples=60, deadline=None)
@given(shapes, poses)
def test_nothing_of_a_shape_is_missed_and_little_is_added(shape: Shape, pose: Pose) -> None:
    radius, depth = found(shape, pose)
    wanted_radius, wanted_depth = reference(shape, pose)
    extent = 0.04 * math.sqrt(3.0)
    assert depth >= wanted_depth - 1e-9
    # Between two rows of points a surface may reach a little deeper, or a little farther out.
    assert depth <= max(wanted_depth, SKIN_M) + 0.003 * extent + SKIN_M
    assert radius >= wanted_radius - 1e-9
    if wanted_depth > 0.003:
        assert radius <= wanted_radius + 0.03 * extent


@given(st.floats(0.001, 0.02), st.floats(0.01, 0.2), near, near, st.floats(0.001, 0.009))
def test_an_upright_cylinder_is_measured_exactly(
    radius_m: float, height_m: float, x: float, y: float, depth_m: float
) -> None:
    radius, depth = found(Cylinder(radius_m, height_m), Pose((x, y, height_m / 2 - depth_m)))
    exact = math.hypot(x, y) + radius_m
    assert depth == pytest.approx(depth_m)
    assert exact - 1e-5 <= radius <= math.hypot(x, y) + 1.0022 * radius_m


def test_what_lies_on_the_mouth_is_not_in_it() -> None:
    assert found(Cylinder(0.03, 0.1), Pose((0.0, 0.0, 0.05 - 0.5 * SKIN_M))) == (0.0, 0.0)


def test_of_a_grid_the_hole_is_meant_that_a_shape_is_in() -> None:
    grid = Opening(Pose(), 0.01, 0.05, (4, 3), (0.06, 0.05))
    radius, depth = found(Cylinder(0.008, 0.1), Pose((0.121, 0.1, 0.03)), grid)
    assert radius == pytest.approx(0.009, abs=2e-5)
    assert depth == pytest.approx(0.02)
    outside, _ = found(Cylinder(0.008, 0.1), Pose((0.24, 0.1, 0.03)), grid)
    assert outside == pytest.approx(0.068, abs=2e-5)
