"""The free room that is found is the one that trying every point of the grid finds."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, moved
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.operations.surface import free_room
from xei_lang.lower.robot import shoulder_xy
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import LabObject

POSES = st.builds(
    lambda x, y, z, roll, yaw: Pose.from_rpy((x, y, z), (roll, -roll, yaw)),
    st.floats(0.4, 1.1),
    st.floats(-0.6, 0.6),
    st.sampled_from([0.75, 0.75, 0.9]),
    st.sampled_from([0.0, 0.0, 0.2]),
    st.floats(-math.pi, math.pi),
)
MOVED = ("rack_1", "rack_2", "beaker_1", "bottle_1", "tip_box_1", "wipe_1")


def tried(scene: Scene, arm: Side, surface: str, known: LabObject) -> Pose | None:
    """Every point of the grid, with every object, as the docstring of `free_room` has it."""
    profile, radius = bench()[0], math.hypot(known.size_m[0], known.size_m[1]) / 2
    host = profile.object(surface)
    assert host is not None
    shoulder_x, shoulder_y = shoulder_xy(profile, arm)
    found: list[tuple[float, float, float]] = []
    for x in steps(host.size_m[0] / 2 - radius):
        for y in steps(host.size_m[1] / 2 - radius):
            bx, by, _ = scene.T_base_object(surface).apply((x, y, host.size_m[2]))
            away = math.hypot(bx - shoulder_x - 0.30, by - shoulder_y)
            T_world_point = scene.standing[surface].T_world_object @ Pose((x, y, host.size_m[2]))
            if all(
                clear(other.T_world_object, profile.object(name), T_world_point, radius, known.size_m[2])
                for name, other in scene.standing.items()
                if name not in (surface, known.name)
            ):
                found.append((round(away, 6), x, y))
    return Pose((*min(found)[1:], host.size_m[2])) if found else None


def clear(pose: Pose, thing: LabObject | None, T_world_point: Pose, radius: float, height: float) -> bool:
    assert thing is not None
    x, y, z = pose.inverse().apply(T_world_point.position_m)
    length, width, top = thing.size_m
    beside = math.hypot(max(0.0, abs(x) - length / 2), max(0.0, abs(y) - width / 2))
    return not -height < z < top - 1e-3 or beside >= radius + 0.05


def steps(room: float) -> list[float]:
    if room < 0.0:
        return []
    count = int(max(0.0, room - 0.02) / 0.05 + 1e-9)
    return [k * 0.05 for k in range(-count, count + 1)]


@given(
    st.lists(st.tuples(st.sampled_from(MOVED), POSES), max_size=4),
    st.tuples(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.floats(-math.pi, math.pi)),
    st.sampled_from(["left", "right"]),
    st.sampled_from(["table", "table", "table_b"]),
    st.floats(0.01, 0.3),
)
@settings(max_examples=25, deadline=None)
def test_it_is_the_nearest_free_point_of_the_whole_surface(
    things: list[tuple[str, Pose]], turned: tuple[float, float, float], arm: Side, surface: str, size_m: float
) -> None:
    profile, world = bench()
    known = profile.object("beaker_1")
    assert known is not None
    known = replace(known, size_m=(size_m, size_m / 2, known.size_m[2]))
    for name, pose in things:
        world = moved(world, name, pose)
    T_world_table = world.T_world_object("table")
    world = moved(world, "table", T_world_table @ Pose.from_rpy((0.0, 0.0, 0.0), turned))
    scene = Scene.of(world, profile)
    assert free_room(profile, scene, arm, surface, known) == tried(scene, arm, surface, known)
