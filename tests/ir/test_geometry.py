"""Poses are a group, act on points as one, and agree with their matrices."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.geometry import IDENTITY, Pose

coordinates = st.floats(-5.0, 5.0)
vectors = st.tuples(coordinates, coordinates, coordinates)
angles = st.floats(-math.pi, math.pi)
poses = st.builds(Pose.from_rpy, vectors, st.tuples(angles, angles, angles))
NEAR = 1e-9


def same(a: Pose, b: Pose) -> bool:
    """Equal up to rounding; q and -q are one rotation."""
    dot = abs(sum(x * y for x, y in zip(a.quaternion, b.quaternion, strict=True)))
    apart = max(abs(x - y) for x, y in zip(a.position_m, b.position_m, strict=True))
    return apart < NEAR and abs(dot - 1.0) < NEAR


def near(a, b) -> bool:
    return max(abs(x - y) for x, y in zip(a, b, strict=True)) < NEAR


def product(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)) for i in range(4))


@given(poses, poses, poses)
def test_products_associate(a, b, c):
    assert same((a @ b) @ c, a @ (b @ c))


@given(poses)
def test_the_identity_changes_nothing(a):
    assert same(a @ IDENTITY, a)
    assert same(IDENTITY @ a, a)


@given(poses)
def test_a_pose_and_its_inverse_cancel(a):
    assert same(a @ a.inverse(), IDENTITY)
    assert same(a.inverse() @ a, IDENTITY)
    assert same(a.inverse().inverse(), a)


@given(poses, poses)
def test_the_inverse_of_a_product_turns_it_round(a, b):
    assert same((a @ b).inverse(), b.inverse() @ a.inverse())


@given(poses, poses, vectors)
def test_a_product_acts_as_one_after_the_other(a, b, point):
    assert near((a @ b).apply(point), a.apply(b.apply(point)))


@given(poses, poses)
def test_matrices_multiply_as_poses_do(a, b):
    expected = product(a.matrix(), b.matrix())
    assert all(near(row, wanted) for row, wanted in zip((a @ b).matrix(), expected, strict=True))


@given(poses, vectors)
def test_a_matrix_moves_points_as_its_pose_does(a, point):
    moved = tuple(sum(row[k] * (*point, 1.0)[k] for k in range(4)) for row in a.matrix()[:3])
    assert near(a.apply(point), moved)


@given(poses)
def test_axes_are_orthonormal_right_handed_and_make_the_pose_again(a):
    x, y, z = a.axes()
    cross = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    assert near(cross, z)
    assert all(math.isclose(sum(v * v for v in axis), 1.0, abs_tol=NEAR) for axis in (x, y, z))
    assert same(Pose.from_axes(a.position_m, x, y, z), a)


@given(poses)
def test_quaternions_are_unit_and_have_one_sign(a):
    assert math.isclose(math.hypot(*a.quaternion), 1.0, abs_tol=NEAR)
    assert a.quaternion[3] >= 0.0


@pytest.mark.parametrize(
    ("rpy", "axis", "turned"),
    [
        ((math.pi / 2, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        ((0.0, math.pi / 2, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
        ((0.0, 0.0, math.pi / 2), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
        ((math.pi / 2, 0.0, math.pi / 2), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
        ((math.pi, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)),
    ],
)
def test_roll_pitch_yaw_turn_about_fixed_axes(rpy, axis, turned):
    assert near(Pose.from_rpy((0.0, 0.0, 0.0), rpy).rotate(axis), turned)


@given(poses, vectors)
def test_locating_a_point_is_the_way_back(a, point):
    assert near(a.locate(point), a.inverse().apply(point))
    assert near(a.apply(a.locate(point)), point)


@given(poses)
def test_a_rotation_has_one_quaternion_of_unit_norm(a):
    x, y, z, w = (a @ a).quaternion
    assert math.hypot(x, y, z, w) == pytest.approx(1.0, abs=1e-12)
    assert w >= 0.0
    assert "-0.0" not in repr((IDENTITY @ Pose((0.0, 0.0, 0.0), (-0.0, 0.0, -0.0, -1.0))).quaternion)
