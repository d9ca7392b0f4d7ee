"""Properties of grasp families and places, over sizes and poses; hand and fingers as the robot's own
description has them.
"""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import product

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.hands import hand_boxes, links_in_tool
from tests.lower.plans import bench, moved, obj, plan, put_on_rack, with_object
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Box, Cylinder, Pose, Vec3
from xei_lang.ir.goals import Grip, MotionGoalGraph, MoveTo
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.profiles.model import Profile

GAP_M = 0.088
SIZES = st.floats(0.004, 0.086)
SHAPES = st.one_of(
    st.builds(Cylinder, st.floats(0.002, 0.043), st.floats(0.06, 0.25)),
    st.builds(lambda x, y, z: Box((x, y, z)), SIZES, SIZES, st.floats(0.06, 0.25)),
)
POSES = st.builds(
    lambda x, y, yaw: Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)),
    st.floats(0.5, 0.9),
    st.floats(-0.4, 0.4),
    st.floats(-math.pi, math.pi),
)


def standing(shape: Box | Cylinder) -> Profile:
    """The bench with `wipe_1` in this shape."""
    profile = bench()[0]
    found = profile.object("wipe_1")
    assert found is not None
    size = (
        shape.size_m if isinstance(shape, Box) else (2 * shape.radius_m, 2 * shape.radius_m, shape.height_m)
    )
    return with_object(profile, "wipe_1", replace(found, shape=shape, size_m=size))


def picked(shape: Box | Cylinder, pose: Pose) -> MotionGoalGraph:
    pick = plan(("pick", {"object": obj("wipe_1"), "arm": "either"}))
    graph, problems = lower(pick, standing(shape), moved(bench()[1], "wipe_1", pose))
    assert graph is not None, problems
    return graph


def aims(graph: MotionGoalGraph) -> list[ToolTarget]:
    actions = [goal.action for goal in graph.goals]
    return [
        item.target for item in actions if isinstance(item, MoveTo) and isinstance(item.target, ToolTarget)
    ]


def inside(shape: Box | Cylinder, point: Vec3, grown_m: float = 0.0) -> bool:
    x, y, z = point
    if isinstance(shape, Box):
        across = abs(x) < shape.size_m[0] / 2 + grown_m and abs(y) < shape.size_m[1] / 2 + grown_m
        return across and -grown_m < z < shape.size_m[2] + grown_m
    return math.hypot(x, y) < shape.radius_m + grown_m and -grown_m < z < shape.height_m + grown_m


def half_width(shape: Box | Cylinder, member: ToolPose) -> float:
    """Half of what is between the jaws, along the closing direction through the object's axis."""
    if isinstance(shape, Cylinder):
        return shape.radius_m
    x, y, _ = member.T_reference_tool.axes()[1]
    assert max(abs(x), abs(y)) > 1.0 - 1e-9, "the jaws do not lie flat on two faces"
    return shape.size_m[0] / 2 if abs(x) > abs(y) else shape.size_m[1] / 2


@given(SHAPES, POSES)
@settings(max_examples=60, deadline=None)
def test_the_approach_starts_outside_the_object_and_backs_off_along_itself(
    shape: Box | Cylinder, pose: Pose
) -> None:
    graph = picked(shape, pose)
    before, there = aims(graph)[:2]
    standoff_m = -before.offset_tool_m[2]
    assert standoff_m > 0.0
    assert before.offset_tool_m[:2] == (0.0, 0.0)
    assert before.offset_base_m == there.offset_base_m == there.offset_tool_m == (0.0, 0.0, 0.0)
    assert before.T_base_reference == there.T_base_reference
    for member in graph.families[0].members:
        for ahead_m in (0.0, 0.0155):
            point = member.T_reference_tool.apply((0.0, 0.0, ahead_m - standoff_m))
            assert not inside(shape, point, 0.005), member.name


@given(SHAPES, POSES)
@settings(max_examples=60, deadline=None)
def test_the_jaws_close_across_the_middle_and_fit(shape: Box | Cylinder, pose: Pose) -> None:
    graph = picked(shape, pose)
    opened, closed = (goal.action for goal in graph.goals if isinstance(goal.action, Grip))
    assert isinstance(opened, Grip)
    assert isinstance(closed, Grip)
    assert closed.opening_m < opened.opening_m <= GAP_M
    for member in graph.families[0].members:
        _, y, z = member.T_reference_tool.axes()
        assert abs(y[2]) < 1e-9
        point = member.T_reference_tool.position_m
        assert abs(sum(a * b for a, b in zip(y, point, strict=True)) - y[2] * point[2]) < 1e-9
        width = 2 * half_width(shape, member)
        assert abs(closed.opening_m - width) <= 1e-6
        assert opened.opening_m - width >= 2 * 0.001 - 4e-6
        assert 0.0 < point[2] < (shape.size_m[2] if isinstance(shape, Box) else shape.height_m)
        assert pose.rotate(z)[2] < 0.06


@given(SHAPES, POSES)
@settings(max_examples=60, deadline=None)
def test_hand_and_fingers_stay_above_the_table(shape: Box | Cylinder, pose: Pose) -> None:
    graph = picked(shape, pose)
    opened = next(goal.action for goal in graph.goals if isinstance(goal.action, Grip))
    for member in graph.families[0].members[::7]:
        assert lowest(member, opened.opening_m) >= 0.002 - 1e-6, member.name


def test_hand_and_fingers_stay_above_the_rack_that_a_tube_stands_in() -> None:
    profile, world = bench()
    graph, problems = lower(put_on_rack(), profile, world)
    assert graph is not None, problems
    members = graph.families[0].members
    assert len(members) > 100
    for member in members:
        assert lowest(member, 0.033) >= 0.065 + 0.002 - 1e-6, member.name
    kinds = {member.name.partition(",")[0] for member in members}
    assert kinds == {"from the side", "30 deg down", "45 deg down", "60 deg down", "straight down"}


def test_side_and_oblique_grasps_come_before_straight_down() -> None:
    members = family_of_tube().members
    costs = [member.cost for member in members]
    assert costs == sorted(costs)
    first_down = next(k for k, member in enumerate(members) if member.name.startswith("straight down"))
    assert first_down > len(members) / 3


WORDS = re.compile(
    r"(from the side|straight down|(\d+) deg down), azimuth (\d+) deg(, rolled)?, (\d+\.\d) mm under the top"
)


@given(SHAPES, POSES)
@settings(max_examples=40, deadline=None)
def test_members_are_what_their_names_say_in_the_order_of_cost_and_name(
    shape: Box | Cylinder, pose: Pose
) -> None:
    members = picked(shape, pose).families[0].members
    top = shape.size_m[2] if isinstance(shape, Box) else shape.height_m
    assert list(members) == sorted(members, key=lambda member: (member.cost, member.name))
    assert len({member.name for member in members}) == len(members)
    for member in members:
        words = WORDS.fullmatch(member.name)
        assert words is not None
        kind, degrees, azimuth, rolled, under = words.groups()
        down = math.radians({"from the side": 0, "straight down": 90}.get(kind) or float(degrees or 0))
        heading = math.radians(float(azimuth))
        _, y, z = member.T_reference_tool.axes()
        level = math.cos(down)
        expected = (level * math.cos(heading), level * math.sin(heading), -math.sin(down))
        assert max(abs(a - b) for a, b in zip(z, expected, strict=True)) < 1e-9
        opening = (-math.sin(heading), math.cos(heading), 0.0)
        sign = -1.0 if rolled else 1.0
        assert max(abs(a - sign * b) for a, b in zip(y, opening, strict=True)) < 1e-9
        assert abs(top - member.T_reference_tool.position_m[2] - float(under) / 1000) <= 5.1e-5
        assert 0.0 <= member.cost == round(member.cost, 6)
        pose_again = Pose(member.T_reference_tool.position_m, member.T_reference_tool.quaternion)
        assert member == ToolPose(member.name, pose_again, member.cost)


def test_a_round_object_may_be_turned_and_a_box_not() -> None:
    assert family_of_tube().symmetric
    assert not picked(Box((0.04, 0.05, 0.1)), Pose((0.6, 0.0, 0.75))).families[0].symmetric


@given(
    st.floats(-0.15, 0.15),
    st.floats(-0.15, 0.15),
    st.floats(-math.pi, math.pi),
    st.floats(0.03, 0.065),
)
@settings(max_examples=40, deadline=None)
def test_places_are_reached_and_left_along_the_axis_of_the_slot(
    roll: float, pitch: float, yaw: float, depth_m: float
) -> None:
    profile, world = bench()
    rack = profile.object("rack_2")
    assert rack is not None
    assert rack.slots is not None
    changed = replace(rack, slots=replace(rack.slots, depth_m=depth_m))
    T_world_rack = Pose.from_rpy((0.62, 0.135, 0.75), (roll, pitch, yaw))
    graph, problems = lower(
        put_on_rack(), with_object(profile, "rack_2", changed), moved(world, "rack_2", T_world_rack)
    )
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    above, place, retreat = aims(graph)[-3:]
    axis = T_world_rack.axes()[2]
    height = math.sqrt(sum(value * value for value in above.offset_base_m))
    assert height > depth_m
    for value, part in zip(above.offset_base_m, axis, strict=True):
        assert abs(value - part * height) < 1e-9
    assert above.T_base_reference == place.T_base_reference == retreat.T_base_reference
    assert place.offset_base_m == place.offset_tool_m == (0.0, 0.0, 0.0)
    assert retreat.offset_tool_m[2] < 0.0
    corner = (35 / 1000 - 0.125, 35 / 1000 - 0.095, 0.07)
    inserted = [
        a - b for a, b in zip(T_world_rack.apply(corner), place.T_base_reference.position_m, strict=True)
    ]
    for value, part in zip(inserted, axis, strict=True):
        assert abs(value - part * depth_m) < 2e-6


def family_of_tube() -> Family:
    profile, world = bench()
    graph, problems = lower(put_on_rack(), profile, world)
    assert graph is not None, problems
    return graph.families[0]


def lowest(member: ToolPose, gap_m: float) -> float:
    """The lowest corner of hand and fingers, opened to a gap, in the object's frame."""
    origins = links_in_tool(gap_m)
    heights: list[float] = []
    for link, center, size in hand_boxes():
        for signs in product((-0.5, 0.5), repeat=3):
            corner = [
                o + c + s * sign for o, c, s, sign in zip(origins[link], center, size, signs, strict=True)
            ]
            heights.append(member.T_reference_tool.apply((corner[0], corner[1], corner[2]))[2])
    return min(heights)
