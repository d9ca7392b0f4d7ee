from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.profiles.assets.bodies import ball, beaker, box, cylinder, sampled
from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import IDENTITY, Box, Cylinder, Pose, Sphere
from xei_lang.profiles.assets.fit import extent_of, fit, without_strays
from xei_lang.profiles.assets.measure import SLACK, Stated, disagreement, measured
from xei_lang.profiles.assets.points import Points
from xei_lang.profiles.assets.told import Named, size_of
from xei_lang.profiles.assets.units import SCALES, likely_unit, matching_unit

SPAN = Span("usage_profile.yaml", 0, 1)
length_mm = st.floats(8.0, 300.0)
turns = st.floats(-math.pi, math.pi)
places = st.tuples(*[st.floats(-500.0, 500.0)] * 3)


@st.composite
def bodies(draw):
    """Triangles in mm that stand on the frame, and the shape that they make."""
    kind = draw(st.sampled_from(["box", "cylinder", "sphere"]))
    a, b, c = draw(length_mm), draw(length_mm), draw(length_mm)
    if kind == "box":
        return box(a, b, c), Box((a / 1e3, b / 1e3, c / 1e3))
    if kind == "cylinder":
        return cylinder(a, b), Cylinder(a / 2e3, b / 1e3)
    return ball(a), Sphere(a / 2e3)


def in_file(points_mm, units, T_object_file):
    """Points of an object's frame as a file in this unit and this place has them."""
    back = T_object_file.inverse()
    rotation = np.array([row[:3] for row in back.matrix()[:3]])
    return (points_mm / 1e3 @ rotation.T + np.array(back.position_m)) / SCALES[units]


def named(what, units, T_object_file=IDENTITY):
    return Named("thing", what, "assets/thing", units, T_object_file, SPAN, SPAN, gives_shape=True)


@given(bodies(), st.sampled_from(list(SCALES)), places, st.tuples(turns, turns, turns))
def test_a_mesh_gives_the_shape_that_it_was_made_from(body, units, place_mm, rpy):
    triangles, shape = body
    T = Pose.from_rpy(tuple(value / 1e3 for value in place_mm), rpy)
    points = in_file(triangles.reshape(-1, 3), units, T)
    found = []
    one = measured(named("mesh", units, T), Points(points, True), None, found)
    assert not found
    made = fit(one.extent, None)
    assert type(made) is type(shape)
    np.testing.assert_allclose(size_of(made), size_of(shape), atol=2e-6)
    assert not list(disagreement(named("mesh", units), one, Stated(shape, SPAN)))


@settings(max_examples=40)
@given(bodies(), st.sampled_from(["m", "mm"]), places, turns, st.integers(0, 9), st.floats(0.0, 0.3))
def test_a_noisy_point_cloud_gives_nearly_that_shape(body, units, place_mm, yaw, seed, noise_mm):
    triangles, shape = body
    random = np.random.default_rng(seed)
    points = sampled(triangles, 4000, seed) + random.normal(0.0, noise_mm, (4000, 3))
    strays = random.uniform(-900.0, 900.0, (40, 3))
    T = Pose.from_rpy(tuple(value / 1e3 for value in place_mm), (0.4, -1.1, yaw))
    everything = in_file(np.vstack([points, strays]), units, T)
    found = []
    one = measured(named("point_cloud", units, T), Points(everything), None, found)
    assert not found
    kind = {Box: "box", Cylinder: "cylinder", Sphere: "sphere"}[type(shape)]
    sizes = zip(size_of(fit(one.extent, kind)), size_of(shape), strict=True)
    for size, wanted in sizes:
        assert abs(size - wanted) <= max(SLACK["point_cloud"].least_m, 0.02 * wanted)


@given(bodies(), turns)
def test_a_fitted_shape_holds_every_vertex_of_a_mesh(body, yaw):
    triangles, _ = body
    turn = np.array([[math.cos(yaw), -math.sin(yaw), 0], [math.sin(yaw), math.cos(yaw), 0], [0, 0, 1]])
    points = triangles.reshape(-1, 3) / 1e3 @ turn.T
    made = fit(extent_of(points, is_noisy=False), None)
    x, y, z = np.abs(points - (0, 0, size_of(made)[2] / 2)).T
    slack = 2e-6
    if isinstance(made, Box):
        assert (np.stack([x, y, z], 1) <= np.array(made.size_m) / 2 + slack).all()
    elif isinstance(made, Cylinder):
        assert (np.hypot(x, y) <= made.radius_m + slack).all()
        assert z.max() <= made.height_m / 2 + slack
    else:
        assert np.sqrt(x * x + y * y + z * z).max() <= made.radius_m * 1.03


def test_a_kind_that_is_asked_for_is_fitted():
    extent = extent_of(cylinder(40.0, 100.0).reshape(-1, 3) / 1e3, is_noisy=False)
    assert fit(extent, None) == Cylinder(0.02, 0.1)
    assert fit(extent, "box") == Box((0.04, 0.04, 0.1))


def test_a_hollow_vessel_is_the_cylinder_around_it():
    assert fit(extent_of(beaker(70.0, 95.0, 2.0).reshape(-1, 3) / 1e3, is_noisy=False), None) == Cylinder(
        0.035, 0.095
    )


def test_points_without_neighbours_are_left_out_and_copies_of_points_are_one():
    points = sampled(cylinder(40.0, 100.0), 2000, seed=1)
    with_stray = np.vstack([points, [(500.0, 0.0, 0.0)]])
    assert np.abs(without_strays(with_stray)).max() < 101.0
    assert len(without_strays(np.vstack([points] * 12))) > 1900
    assert len(without_strays(sampled(cylinder(40.0, 100.0), 120_000, seed=1))) <= 50_000


@given(st.floats(0.002, 3.0))
def test_a_unit_is_guessed_where_only_one_makes_a_size_of_a_lab(size_m):
    if 0.005 < size_m < 1.9:
        assert likely_unit(size_m * 1000) == "mm"
        assert likely_unit(size_m) == "m"
    for units, scale in SCALES.items():
        assert matching_unit(size_m / scale, size_m) == units
    assert matching_unit(size_m * 2.0, size_m) == ""


def test_nothing_in_a_lab_is_as_long_as_that():
    assert likely_unit(1e6) == likely_unit(1e-6) == ""
