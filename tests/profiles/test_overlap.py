"""The plane test of upright solids against a dense sampling of their volumes."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from xei_lang.profiles.checks.overlap import Upright, overlap_m

positions = st.floats(-0.3, 0.3)


@st.composite
def solids(draw: st.DrawFn) -> Upright:
    x, y, z = draw(positions), draw(positions), draw(positions)
    height = draw(st.floats(0.02, 0.3))
    if draw(st.booleans()):
        return Upright(x, y, z, z + height, 0.0, (0.0, 0.0), draw(st.floats(0.02, 0.2)))
    half = (draw(st.floats(0.02, 0.2)), draw(st.floats(0.02, 0.2)))
    return Upright(x, y, z, z + height, draw(st.floats(-math.pi, math.pi)), half, 0.0)


def inside(solid: Upright, x: float, y: float) -> bool:
    dx, dy = x - solid.x_m, y - solid.y_m
    c, s = math.cos(solid.yaw_rad), math.sin(solid.yaw_rad)
    u, v = abs(dx * c + dy * s), abs(dy * c - dx * s)
    return math.hypot(max(u - solid.half_m[0], 0.0), max(v - solid.half_m[1], 0.0)) <= solid.radius_m


def samples(solid: Upright):
    reach = math.hypot(*solid.half_m) + solid.radius_m
    for i in range(-12, 13):
        for j in range(-12, 13):
            x, y = solid.x_m + reach * i / 12, solid.y_m + reach * j / 12
            if inside(solid, x, y):
                yield x, y


@given(solids(), solids())
def test_a_shared_point_means_overlap(a, b):
    vertical = min(a.upper_m, b.upper_m) >= max(a.lower_m, b.lower_m)
    shared = vertical and any(inside(b, x, y) for x, y in samples(a))
    if shared:
        assert overlap_m(a, b) >= -1e-9
    assert math.isclose(overlap_m(a, b), overlap_m(b, a), abs_tol=1e-12)


@given(solids(), solids())
def test_parting_along_z_or_far_apart_is_no_overlap(a, b):
    lifted = Upright(b.x_m, b.y_m, a.upper_m, a.upper_m + 0.1, b.yaw_rad, b.half_m, b.radius_m)
    assert overlap_m(a, lifted) <= 1e-12
    moved = Upright(b.x_m + 3.0, b.y_m, b.lower_m, b.upper_m, b.yaw_rad, b.half_m, b.radius_m)
    assert overlap_m(a, moved) < 0.0


@given(solids())
def test_a_solid_overlaps_itself(a):
    assert overlap_m(a, a) > 0.0


def test_a_disc_beside_a_corner_is_apart_although_both_axes_overlap():
    box = Upright(0.0, 0.0, 0.0, 1.0, 0.0, (0.1, 0.1), 0.0)
    disc = Upright(0.16, 0.16, 0.0, 1.0, 0.0, (0.0, 0.0), 0.08)
    assert overlap_m(box, disc) < 0.0
    assert overlap_m(box, Upright(0.15, 0.15, 0.0, 1.0, 0.0, (0.0, 0.0), 0.08)) > 0.0
