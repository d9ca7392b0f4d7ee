"""Lookups between frames: algebra of the values, and tolerances that hold for every error of the links."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.geometry import IDENTITY, Pose, Vec3
from xei_lang.ir.world import Frame, RobotState, World
from xei_lang.world.transforms import lookup, verify_transform

LENGTH = st.floats(-2.0, 2.0, allow_subnormal=False)
ANGLE = st.floats(-math.pi, math.pi)
VECTORS = st.tuples(LENGTH, LENGTH, LENGTH)
POSES = st.builds(Pose.from_rpy, VECTORS, st.tuples(ANGLE, ANGLE, ANGLE))
NAMES = ("base", "slide", "camera", "table", "rack", "tag")
PARENTS = dict(zip(NAMES, ("world", "base", "slide", "world", "table", "table"), strict=True))


def world_of(frames: list[Frame]) -> World:
    return World(tuple(frames), (), RobotState((), "here", IDENTITY))


@st.composite
def worlds(draw: st.DrawFn) -> World:
    frames = []
    for name in NAMES:
        tolerances = draw(st.floats(0.0, 0.01)), draw(st.floats(0.0, 0.1))
        status = draw(st.sampled_from(("measured", "estimated", "placeholder")))
        frames.append(Frame(name, PARENTS[name], draw(POSES), status, *tolerances))
    return world_of(frames)


def assert_same(one: Pose, other: Pose) -> None:
    assert one.position_m == pytest.approx(other.position_m, abs=1e-9)
    dot = abs(sum(a * b for a, b in zip(one.quaternion, other.quaternion, strict=True)))
    assert dot == pytest.approx(1.0, abs=1e-9)


@given(worlds(), st.sampled_from((*NAMES, "world")), st.sampled_from((*NAMES, "world")))
def test_there_and_back_is_nothing(world: World, one: str, other: str) -> None:
    there, back = lookup(world, one, other), lookup(world, other, one)
    assert_same(there.T_target_source @ back.T_target_source, IDENTITY)
    assert there.path == back.path[::-1]
    assert there.status == back.status


@given(worlds(), st.sampled_from(NAMES), st.sampled_from(NAMES))
def test_a_lookup_agrees_with_both_poses_in_the_world(world: World, one: str, other: str) -> None:
    T_one_other = world.T_world_frame(one).inverse() @ world.T_world_frame(other)
    assert_same(lookup(world, one, other).T_target_source, T_one_other)


def test_the_way_goes_over_the_nearest_common_frame_only() -> None:
    world = world_of([Frame(name, PARENTS[name], IDENTITY, "measured", 0.001, 0.0) for name in NAMES])
    found = lookup(world, "rack", "tag")
    assert found.path == ("rack", "table", "tag")
    assert found.position_tolerance_m == pytest.approx(0.002)
    assert lookup(world, "camera", "rack").path == ("camera", "slide", "base", "world", "table", "rack")
    assert lookup(world, "table", "table").path == ("table",)


def test_a_turned_link_moves_what_is_far_from_it() -> None:
    table = Frame("table", "world", IDENTITY, "measured", 0.003, math.radians(0.5))
    found = lookup(world_of([table]), "world", "table", (0.4, 0.0, 0.0))
    assert found.position_tolerance_m == pytest.approx(0.003 + 0.4 * math.radians(0.5))


@st.composite
def errors(draw: st.DrawFn) -> tuple[float, Vec3, Vec3]:
    return draw(st.floats(0.0, 1.0)), draw(VECTORS), draw(VECTORS)


def _moved(frame: Frame, share: float, way: Vec3, axis: Vec3) -> Frame:
    """The frame with an error within its tolerances: a share of both, along a way and about an axis."""
    norm = math.hypot(*way) or 1.0
    length = frame.position_tolerance_m * share
    x, y, z = frame.T_parent_frame.position_m
    position = (x + way[0] / norm * length, y + way[1] / norm * length, z + way[2] / norm * length)
    size = math.hypot(*axis)
    half = frame.rotation_tolerance_rad * share / 2 if size > 1e-6 else 0.0
    s = math.sin(half) / (size or 1.0)
    turn = Pose((0.0, 0.0, 0.0), (axis[0] * s, axis[1] * s, axis[2] * s, math.cos(half)))
    return replace(frame, T_parent_frame=Pose(position, frame.T_parent_frame.quaternion) @ turn)


@given(
    worlds(), st.sampled_from((*NAMES, "world")), st.sampled_from(NAMES), VECTORS,
    st.lists(errors(), min_size=len(NAMES), max_size=len(NAMES)),
)  # fmt: skip
def test_no_error_within_the_links_moves_a_point_by_more_than_the_tolerance(
    world: World, target: str, source: str, point: Vec3, moves: list[tuple[float, Vec3, Vec3]]
) -> None:
    wrong = world_of([_moved(frame, *move) for frame, move in zip(world.frames, moves, strict=True)])
    stated = lookup(world, target, source, point)
    actual = lookup(wrong, target, source).T_target_source.apply(point)
    # The bound is of first order: levers are those of the stated frames, what errors do to each other is
    # over.
    turns = sum(frame.rotation_tolerance_rad for frame in stated.links)
    second_order = turns * (sum(frame.position_tolerance_m for frame in stated.links) + 7.0 * turns)
    shift = math.dist(actual, stated.T_target_source.apply(point))
    assert shift <= stated.position_tolerance_m + second_order + 1e-9


@given(POSES, st.floats(0.0, 0.02), st.floats(0.0, 0.2))
def test_a_measurement_is_held_against_the_tolerance(pose: Pose, far_m: float, turned_rad: float) -> None:
    frame = Frame("table", "world", pose, "estimated", 0.01, 0.1)
    measured = pose @ Pose.from_rpy((far_m, 0.0, 0.0), (0.0, 0.0, turned_rad))
    found = verify_transform(frame, measured)
    assert found.position_m == pytest.approx(far_m, abs=1e-9)
    assert found.rotation_rad == pytest.approx(turned_rad, abs=1e-6)
    if abs(far_m - 0.01) > 1e-6 and abs(turned_rad - 0.1) > 1e-6:
        assert found.within == (far_m < 0.01 and turned_rad < 0.1)


def test_an_unknown_frame_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        lookup(world_of([]), "world", "table")
