from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from xei_lang.ir.forms import world_json
from xei_lang.ir.forms.world_text import to_text
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive
from xei_lang.ir.world import Frame, RobotState, World, WorldObject

TURNED = Pose.from_rpy((0.0, -2.7, 0.85), (0.0, 0.0, -math.pi / 2))


def _world() -> World:
    robot = RobotState((("slide_joint", 0.15), ("openarm_left_joint1", -0.0)), "bench_a", Pose())
    frames = (
        Frame("table", "world", Pose((0.5, 0.0, 0.75)), "placeholder", 0.003, math.radians(0.5)),
        Frame("table_b", "world", TURNED, "estimated", 0.0, 0.0),
    )
    tube = WorldObject(
        name="tube_1",
        T_frame_object=Pose((0.155, -0.1, 0.005)),
        frame_id="table",
        confidence=0.8,
        roles=("movable", "insert_object"),
        skills=("pick", "insert"),
        size_m=(0.017, 0.017, 0.118),
        geometry=(Primitive(Cylinder(0.0085, 0.118)),),
        mass_kg=0.0065,
        place='rack_1.slot("A1")',
        movable=True,
        states=(("cap", "closed"),),
        metadata=(("asset.mesh", "missing"),),
        provenance=(("pose", "usage_profile prior"), ("roles", "usage_profile"), ("size", "usage_profile")),
    )
    top, leg = Primitive(Box((0.7, 1.4, 0.04))), Primitive(Box((0.05, 0.05, 0.71)))
    table = WorldObject("table", Pose(), "table", 1.0, (), (), (0.7, 1.4, 0.75), (top, leg), 0.0)
    return World(frames, (table, tube), robot, ("usage_profile", "object_registry"))


def test_a_world_in_words(golden: Callable[[str, str], None]) -> None:
    golden("ir/world.txt", to_text(_world()))


def test_a_world_of_nothing_still_says_where_the_robot_is() -> None:
    text = to_text(World((), (), RobotState((), "bench_a", Pose())))
    assert text == "robot at bench_a: base (0, 0, 0) mm\n\nasked, in this order: nothing\n"


def test_what_an_object_rides_on_is_said_and_only_then() -> None:
    world = _world()
    tube = replace(world.objects[1], fastened_to="table")
    riding = replace(world, objects=(world.objects[0], tube))
    assert ', in rack_1.slot("A1"), fastened to table' in to_text(riding)
    assert "fastened" not in to_text(world)
    objects = world_json.to_json(riding)["objects"]
    assert isinstance(objects, list)
    assert [isinstance(item, dict) and item.get("fastened_to") for item in objects] == [None, "table"]
