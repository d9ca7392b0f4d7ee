"""The room in the air is over the highest thing below it, whatever stands where."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, moved, obj
from tests.lower.works import step_of, work_of
from xei_lang.ir.geometry import Pose
from xei_lang.lower.operations.in_air import room_in_air
from xei_lang.lower.walk import Scene

POSES = st.builds(
    lambda x, y, z, roll, yaw: Pose.from_rpy((x, y, z), (roll, -roll, yaw)),
    st.floats(0.2, 0.8),
    st.floats(-0.4, 0.4),
    st.sampled_from([0.75, 0.75, 0.9, 1.2]),
    st.sampled_from([0.0, 0.0, 0.2]),
    st.floats(-math.pi, math.pi),
)
MOVED = ("rack_1", "rack_2", "beaker_1", "bottle_1", "tip_box_1", "waste_bin")


def highest(scene: Scene, x: float, y: float, radius_m: float) -> float:
    """The top of each thing whose outline is nearer than the radius, one by one, from the base's frame."""
    profile, top = bench()[0], 0.0
    T_base_world = scene.epoch.T_world_base.inverse()
    for name, standing in scene.standing.items():
        known = profile.object(name)
        assert known is not None
        T_base_object = T_base_world @ standing.T_world_object
        length, width, height = known.size_m
        point = (x, y, T_base_object.position_m[2])
        beside_x, beside_y, _ = T_base_object.inverse().apply(point)
        away = math.hypot(max(0.0, abs(beside_x) - length / 2), max(0.0, abs(beside_y) - width / 2))
        if away < radius_m:
            top = max(top, T_base_object.apply((0.0, 0.0, height))[2])
    return top


@given(
    st.lists(st.tuples(st.sampled_from(MOVED), POSES), max_size=5),
    st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(-math.pi, math.pi)),
    st.floats(0.02, 0.2),
)
@settings(max_examples=50, deadline=None)
def test_it_is_over_the_highest_thing_below(
    things: list[tuple[str, Pose]], stand: tuple[float, float, float], radius_m: float
) -> None:
    profile, world = bench()
    for name, pose in things:
        world = moved(world, name, pose)
    scene = Scene.of(world, profile)
    T_world_base = scene.epoch.T_world_base @ Pose.from_rpy((*stand[:2], 0.0), (0.0, 0.0, stand[2]))
    scene = replace(scene, epoch=replace(scene.epoch, T_world_base=T_world_base))
    tube = obj("tube_1")
    work = work_of(step_of("shake", {"object": tube, "arm": "left"}), tube, "tube_1", scene)
    (x, y, z), _, clearance = room_in_air(work, ("left",), radius_m)
    around_m = radius_m + clearance.si("Length")
    assert math.isclose(z, highest(scene, x, y, around_m) + around_m, abs_tol=1e-9)
