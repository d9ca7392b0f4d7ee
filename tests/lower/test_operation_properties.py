"""Operation parameters over random sizes and poses: where things are set down, where a tap and a swipe touch,
and which source of a parameter wins.

Approach, jaws and slots are held in test_grasp_family.py, pours in operations/test_points.py.
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, moved, obj, plan, spot, with_object, with_skill
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Box, Cylinder, Pose, Vec3
from xei_lang.ir.goals import Grip, MotionGoalGraph, MoveTo
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.lower.hand import hand_of
from xei_lang.profiles.model import Element, LabObject, OperationDefault, Profile
from xei_lang.quantity import Quantity, parse_quantity

GAP_M = 0.088
FINGERTIP_M = 0.0155
SHAPES = st.one_of(
    st.builds(Cylinder, st.floats(0.004, 0.042), st.floats(0.06, 0.22)),
    st.builds(
        lambda x, y, z: Box((x, y, z)), st.floats(0.01, 0.08), st.floats(0.01, 0.08), st.floats(0.06, 0.2)
    ),
)
SIDES = st.sampled_from(["left", "right"])


def found(profile: Profile, name: str) -> LabObject:
    item = profile.object(name)
    assert item is not None
    return item


def lowered(profile: Profile, world, *calls) -> MotionGoalGraph:
    graph, problems = lower(plan(*calls), profile, world)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def targets(graph: MotionGoalGraph, step: str) -> list[ToolTarget]:
    actions = [goal.action for goal in graph.goals if goal.step_id == step]
    return [a.target for a in actions if isinstance(a, MoveTo) and isinstance(a.target, ToolTarget)]


@given(SHAPES, st.floats(0.03, 0.12), st.floats(-0.4, -0.25), st.floats(0.0, 0.2), SIDES)
@settings(max_examples=40, deadline=None)
def test_what_is_picked_fits_the_jaws_and_is_set_down_on_its_spot(
    shape: Box | Cylinder, x: float, y: float, height: float, arm: str
) -> None:
    profile, world = bench()
    size = shape.size_m if isinstance(shape, Box) else (2 * shape.radius_m,) * 2 + (shape.height_m,)
    profile = with_object(profile, "wipe_1", replace(found(profile, "wipe_1"), shape=shape, size_m=size))
    table = found(profile, "table")
    front = next(item for item in table.spots if item.name == "front")
    there = replace(front, T_object_spot=Pose((x - 0.35, y, 0.75 + height)))
    profile = with_object(profile, "table", replace(table, spots=(there,)))
    calls = (
        ("pick", {"object": obj("wipe_1"), "arm": arm}),
        ("place", {"object": obj("wipe_1"), "on": spot("table", there.name), "arm": arm}),
    )
    graph = lowered(profile, world, *calls)
    above, place, retreat = targets(graph, "place#1")
    T_world_base = world.robot.T_world_base
    placed = T_world_base @ place.T_base_reference
    assert placed.position_m == pytest.approx((0.5 + x, y, 0.75 + height), abs=1e-9)
    assert placed.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert place.offset_base_m == place.offset_tool_m == (0.0, 0.0, 0.0)
    assert above.offset_base_m[:2] == (0.0, 0.0)
    assert above.offset_base_m[2] > 0.0
    assert retreat.offset_tool_m[2] <= -FINGERTIP_M

    opening, closing, release = [goal.action for goal in graph.goals if isinstance(goal.action, Grip)]
    width = closing.opening_m
    assert width in (pytest.approx(size[0], abs=1e-6), pytest.approx(size[1], abs=1e-6))
    assert hand_of(profile).max_gap_m == pytest.approx(GAP_M)
    for grip in (opening, release):
        assert width < grip.opening_m <= GAP_M + 1e-6
    for member in graph.families[0].members:
        assert math.hypot(*member.T_reference_tool.position_m[:2]) < 1e-9, "the mid-plane holds the axis"


SCREENS = st.builds(
    lambda x, y, z, yaw: Pose.from_rpy((x, y, z), (0.0, 0.0, yaw)),
    st.floats(0.65, 0.85),
    st.floats(-0.4, 0.4),
    st.floats(0.78, 1.1),
    st.floats(-0.7, 0.7),
)
ELEMENTS = st.tuples(st.floats(0.012, 0.048), st.floats(0.012, 0.068))


def with_element(profile: Profile, center: tuple[float, float]) -> Profile:
    screen = found(profile, "incubator_screen")
    element = Element("spot", center, (0.02, 0.02), screen.span)
    return with_object(profile, "incubator_screen", replace(screen, elements=(element,)))


def tips(graph: MotionGoalGraph, target: ToolTarget) -> list[Vec3]:
    """Where the fingertips are, in the base frame, for each way of holding the hand."""
    members = next(family.members for family in graph.families if family.id == target.family)
    back = Pose(target.offset_tool_m)
    return [
        (target.T_base_reference @ member.T_reference_tool @ back).apply((0.0, 0.0, FINGERTIP_M))
        for member in members
    ]


@given(SCREENS, ELEMENTS, SIDES)
@settings(max_examples=40, deadline=None)
def test_a_tap_hits_its_element_from_in_front_of_the_screen(
    T_world_screen: Pose, center: tuple[float, float], arm: str
) -> None:
    profile, world = bench()
    profile, world = with_element(profile, center), moved(world, "incubator_screen", T_world_screen)
    args = {"screen": obj("incubator_screen"), "element": "spot", "arm": arm}
    graph = lowered(profile, world, ("tap", args))
    above, tap, away = targets(graph, "tap#1")
    T_screen_base = (world.robot.T_world_base.inverse() @ T_world_screen).inverse()
    _, width, _ = found(profile, "incubator_screen").size_m
    hits = [T_screen_base.apply(tip) for tip in tips(graph, tap)]
    assert hits
    for x, y, z in hits:
        assert x == pytest.approx(-0.003, abs=1e-9), "on the face"
        assert (width / 2 - y, z) == pytest.approx(center, abs=1e-9)
    for tip in (*tips(graph, above), *tips(graph, away)):
        assert T_screen_base.apply(tip)[0] < -0.003 - 0.01, "in front of the face"


@given(SCREENS, st.floats(0.005, 0.03), st.sampled_from(["left", "right", "up", "down"]))
@settings(max_examples=40, deadline=None)
def test_a_swipe_goes_its_distance_along_the_face(
    T_world_screen: Pose, length_m: float, direction: str
) -> None:
    profile, world = bench()
    profile, world = with_element(profile, (0.05, 0.04)), moved(world, "incubator_screen", T_world_screen)
    distance = parse_quantity(f"{length_m * 1000:.3f} mm")
    args = {
        "screen": obj("incubator_screen"),
        "element": "spot",
        "direction": direction,
        "distance": distance,
    }
    graph = lowered(profile, world, ("swipe", {**args, "arm": "left"}))
    _, start, end, _ = targets(graph, "swipe#1")
    T_screen_base = (world.robot.T_world_base.inverse() @ T_world_screen).inverse()
    way = {"left": (1, 0), "right": (-1, 0), "up": (0, 1), "down": (0, -1)}[direction]
    for first, last in zip(tips(graph, start), tips(graph, end), strict=True):
        a, b = T_screen_base.apply(first), T_screen_base.apply(last)
        moved_by = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        expected = (0.0, way[0] * distance.si, way[1] * distance.si)
        assert moved_by == pytest.approx(expected, abs=1e-9)


def written(values: dict[str, Quantity], span) -> tuple[OperationDefault, ...]:
    return tuple(OperationDefault(name, value, span) for name, value in values.items())


@given(
    st.booleans(), st.booleans(), st.booleans(), st.integers(20, 29), st.integers(30, 39), st.integers(40, 49)
)
@settings(max_examples=40, deadline=None)
def test_the_last_source_that_speaks_wins_and_is_named(
    in_skill: bool, in_profile: bool, in_call: bool, skill_mm: int, profile_mm: int, call_mm: int
) -> None:
    """Skill default < computed < usage profile < call; the jaws' opening is always computed as well."""
    profile, world = bench()
    pick, tube = profile.bank.skill("pick"), found(profile, "tube_1")
    assert pick is not None
    others = tuple(item for item in pick.parameters if item.name != "open_width")
    own = written({"open_width": parse_quantity(f"{skill_mm} mm")} if in_skill else {}, pick.span)
    profile = with_skill(profile, replace(pick, parameters=(*others, *own)))
    grasp = written({"open_width": parse_quantity(f"{profile_mm} mm")} if in_profile else {}, tube.span)
    profile = with_object(profile, "tube_1", replace(tube, grasp=grasp))
    said = {"open_width": parse_quantity(f"{call_mm} mm")} if in_call else {}
    graph = lowered(profile, world, ("pick", {"object": obj("tube_1"), "arm": "left", **said}))
    goal = next(goal for goal in graph.goals if goal.id == "pick#1/1")
    told = next(item for item in goal.parameters if item.name == "open_width")
    expected = (
        (f"{call_mm} mm", "call") if in_call
        else (f"{profile_mm} mm", "usage_profile") if in_profile
        else ("33 mm", "computed")
    )  # fmt: skip
    assert (told.value, told.source) == expected
    assert isinstance(goal.action, Grip)
    assert goal.action.opening_m == pytest.approx(parse_quantity(told.value).si)
    assert (told.span is None) == (told.source == "computed")


@given(st.integers(1, 60), st.booleans())
@settings(max_examples=20, deadline=None)
def test_a_skills_default_stands_where_nothing_is_computed(percent: int, in_profile: bool) -> None:
    profile, world = bench()
    pick, tube = profile.bank.skill("pick"), found(profile, "tube_1")
    assert pick is not None
    others = tuple(item for item in pick.parameters if item.name != "approach_speed")
    own = written({"approach_speed": parse_quantity(f"{percent} %")}, pick.span)
    profile = with_skill(profile, replace(pick, parameters=(*others, *own)))
    grasp = written({"approach_speed": parse_quantity("70 %")} if in_profile else {}, tube.span)
    profile = with_object(profile, "tube_1", replace(tube, grasp=grasp))
    graph = lowered(profile, world, ("pick", {"object": obj("tube_1"), "arm": "left"}))
    goal = next(goal for goal in graph.goals if goal.id == "pick#1/3")
    told = next(item for item in goal.parameters if item.name == "approach_speed")
    assert told.source == ("usage_profile" if in_profile else "skill")
    assert isinstance(goal.action, MoveTo)
    assert goal.action.speed_fraction == pytest.approx(0.7 if in_profile else percent / 100)
