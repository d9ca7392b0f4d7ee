"""Solids in any pose: apart, touching or in each other, held against a library of collision checks."""

from __future__ import annotations

import math

import coal
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Shape, Sphere
from xei_lang.profiles.checks.convex import TOUCH_M, convex, convex_overlap_m

lengths = st.floats(0.01, 0.3)
angles = st.floats(-math.pi, math.pi)
near = st.floats(-0.3, 0.3)
shapes = st.one_of(
    st.builds(Box, st.tuples(lengths, lengths, lengths)),
    st.builds(Cylinder, lengths, lengths),
    st.builds(Sphere, lengths),
    st.builds(Capsule, lengths, lengths),
)
poses = st.builds(Pose.from_rpy, st.tuples(near, near, near), st.tuples(angles, angles, angles))


def distance_m(a: Shape, T_a: Pose, b: Shape, T_b: Pose) -> float:
    """As coal has it: below zero where they are in each other."""
    bodies = []
    for shape, pose in ((a, T_a), (b, T_b)):
        matrix = np.array(pose.matrix())
        bodies += [_body(shape), coal.Transform3s(matrix[:3, :3], matrix[:3, 3])]
    return coal.distance(*bodies, coal.DistanceRequest(), coal.DistanceResult())


def _body(shape: Shape) -> coal.ShapeBase:
    if isinstance(shape, Box):
        return coal.Box(*shape.size_m)
    if isinstance(shape, Cylinder):
        return coal.Cylinder(shape.radius_m, shape.height_m)
    if isinstance(shape, Capsule):
        return coal.Capsule(shape.radius_m, shape.height_m)
    return coal.Sphere(shape.radius_m)


@given(shapes, poses, shapes, poses)
def test_what_coal_finds_in_each_other_or_apart_is_found_so(a, T_a, b, T_b):
    apart_m = distance_m(a, T_a, b, T_b)
    depth_m = convex_overlap_m(convex(a, T_a), convex(b, T_b))
    if apart_m > 1e-6:
        assert depth_m <= 0.0
    elif apart_m < -2 * TOUCH_M:
        assert depth_m > TOUCH_M
    assert (depth_m > 0.0) == (convex_overlap_m(convex(b, T_b), convex(a, T_a)) > 0.0)


@given(st.tuples(lengths, lengths, lengths), poses, st.tuples(lengths, lengths, lengths), poses)
def test_the_depth_of_boxes_is_exact(size, T_a, other, T_b):
    a, b = Box(size), Box(other)
    apart_m = distance_m(a, T_a, b, T_b)
    if apart_m < -2 * TOUCH_M:
        assert convex_overlap_m(convex(a, T_a), convex(b, T_b)) == pytest.approx(-apart_m, abs=1e-5)


@given(shapes, poses)
def test_solids_that_touch_are_not_in_each_other(a, T_a):
    """Beside it along any direction, with the gap that a table leaves below what stands on it: none."""
    first = convex(a, T_a)
    for axis in (*first.axes, (0.0, 0.0, 1.0)):
        x, y, z = (c + (first.reach_m(axis) + 0.05) * d for c, d in zip(first.centre_m, axis, strict=True))
        ball = convex(Sphere(0.05), Pose((x, y, z)))
        assert convex_overlap_m(first, ball) <= 0.0


@given(shapes, poses, shapes, poses, angles, st.floats(-1.0, 1.0))
def test_what_any_plane_parts_is_apart(a, T_a, b, T_b, turn, height):
    """Two solids at both sides of a plane that is none of their faces."""
    flat = math.sqrt(1.0 - height * height)
    normal = (flat * math.cos(turn), flat * math.sin(turn), height)
    one, other = convex(a, T_a), convex(b, T_b)
    at, low = one.support(normal), other.support((-normal[0], -normal[1], -normal[2]))
    moved = tuple(T_b.position_m[k] + at[k] - low[k] + 1e-5 * normal[k] for k in range(3))
    assert convex_overlap_m(one, convex(b, Pose(moved, T_b.quaternion))) <= 0.0
