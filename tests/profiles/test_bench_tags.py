"""The bench leaves the head camera's sight of the tags free that it finds each table by."""

from __future__ import annotations

import pytest

from tests.lower.plans import bench
from xei_lang.ir.geometry import Pose, Vec3

STEPS = 400


def camera_at(station: str) -> Vec3:
    """Where the head camera is in the world, the base at a station and the slide at its height there."""
    profile, world = bench()
    origin = next(item for item in profile.calibration.stations if item.name == station)
    slide_m = dict(world.robot.joints)["slide_joint"]
    T_base_camera = world.robot.T_world_base.inverse() @ world.T_world_frame("camera")
    raised = Pose((0.0, 0.0, origin.slide_m - slide_m)) @ T_base_camera
    return (origin.T_world_base @ raised).position_m


def hidden_by(eye: Vec3, point: Vec3) -> set[str]:
    """The objects whose bounding box the line from the eye to the point passes; surfaces carry the tags."""
    profile, world = bench()
    found: set[str] = set()
    for item in profile.objects:
        if item.system:
            continue
        T_object_world = world.T_world_object(item.name).inverse()
        for step in range(1, STEPS):
            t = step / STEPS
            x, y, z = T_object_world.apply(tuple(a + t * (b - a) for a, b in zip(eye, point, strict=True)))
            width, depth, height = item.size_m
            if abs(x) <= width / 2 and abs(y) <= depth / 2 and 0.0 <= z <= height:
                found.add(item.name)
    return found


@pytest.mark.parametrize(("station", "tags"), [("bench_a", range(4, 8)), ("bench_b", range(8, 12))])
def test_nothing_stands_between_the_camera_and_a_tag(station: str, tags: range) -> None:
    profile, world = bench()
    eye = camera_at(station)
    layout = profile.calibration.apriltags
    assert len(tags) > layout.minimum_tags
    for tag in layout.tags:
        if tag.id not in tags:
            continue
        T_world_tag = world.T_world_frame(tag.frame) @ tag.T_frame_tag
        half = tag.size_m / 2
        for corner in ((-half, -half, 0.0), (-half, half, 0.0), (half, -half, 0.0), (half, half, 0.0)):
            assert hidden_by(eye, T_world_tag.apply(corner)) == set(), f"tag {tag.id}"
