"""The outline of the base, from the robot's description."""

from __future__ import annotations

import math

import pytest

from tests.world.bench import bench
from xei_lang.profiles.open import robot_texts
from xei_lang.world.map.footprint import Footprint, base_footprint, convex_hull

URDF = robot_texts(bench())[0]
BOX = '<box size="0.43 0.62 0.22"/>'


def changed(geometry: str) -> Footprint:
    old = f'<collision name="base_link_0"><origin xyz="-0.155 0 0.14" rpy="0 0 0"/><geometry>{BOX}'
    assert old in URDF
    found = base_footprint(bench(), URDF.replace(old, old.replace(BOX, geometry)))
    assert isinstance(found, Footprint), found
    return found


def test_the_bench_stands_on_a_rectangle() -> None:
    """Two boxes behind each other; the column and the carriage stand inside of their outline."""
    found = base_footprint(bench(), URDF)
    assert isinstance(found, Footprint)
    corners = [(-0.37, -0.31), (-0.37, 0.31), (0.37, -0.31), (0.37, 0.31)]
    for corner, expected in zip(sorted(found.corners), corners, strict=True):
        assert corner == pytest.approx(expected)
    assert found.circumscribed_m == pytest.approx(math.hypot(0.37, 0.31))
    assert found.inscribed_m == pytest.approx(0.31)


def test_round_shapes_are_held_by_their_polygons() -> None:
    cylinder = changed('<cylinder radius="0.5" length="0.2"/>')
    assert -0.155 - 0.5 >= min(x for x, _ in cylinder.corners) > -0.155 - 0.503
    sphere = changed('<sphere radius="0.4"/>')
    assert 0.4 <= max(y for _, y in sphere.corners) < 0.403


def test_shapes_that_cannot_be_laid_on_the_floor_are_named() -> None:
    assert "base_link" in str(base_footprint(bench(), URDF.replace(BOX, '<mesh filename="base.stl"/>', 2)))
    bare = "".join(line for line in URDF.splitlines(keepends=True) if "<collision name=" not in line)
    assert "has no collision shape" in str(base_footprint(bench(), bare))


def test_what_moves_is_not_of_the_outline() -> None:
    wide = URDF.replace('<box size="0.25 0.15 0.018"/>', '<box size="3 3 0.018"/>')
    assert wide != URDF
    assert base_footprint(bench(), wide) == base_footprint(bench(), URDF)


def test_a_hull_goes_counter_clockwise_and_drops_what_lies_inside() -> None:
    assert convex_hull([(0, 0), (1, 0), (0.5, 0.2), (1, 1), (0, 1), (0.5, 0), (0, 0)]) == (
        (0, 0), (1, 0), (1, 1), (0, 1),
    )  # fmt: skip
