"""Lowering of whole plans: the goals, their order, epochs, contacts, arms and provenance."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.lower.plans import bench, obj, plan, put_on_rack, slot, spot, station, surface, with_skill
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.forms.goals_text import to_text
from xei_lang.ir.goals import (
    Attach,
    Detach,
    Grip,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    SlideMove,
    Wait,
)
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.quantity import parse_quantity


def lowered(of: SkillPlan) -> MotionGoalGraph:
    profile, world = bench()
    graph, problems = lower(of, profile, world)
    assert graph is not None, problems
    assert problems == ()
    assert verify_goals(graph) == ()
    return graph


def goal(graph: MotionGoalGraph, goal_id: str) -> MotionGoal:
    return next(item for item in graph.goals if item.id == goal_id)


def target(graph: MotionGoalGraph, goal_id: str) -> ToolTarget:
    action = goal(graph, goal_id).action
    assert isinstance(action, MoveTo)
    assert isinstance(action.target, ToolTarget)
    return action.target


def parameters(of: MotionGoal) -> dict[str, tuple[str, str]]:
    return {item.name: (item.value, item.source) for item in of.parameters}


def test_put_on_rack_reads_as_it_should(golden) -> None:
    golden("lower/put_on_rack.txt", to_text(lowered(put_on_rack())))


def test_two_stations_reads_as_it_should(golden) -> None:
    fetch = plan(
        ("nav_to", {"station": station("bench_b")}),
        ("slide_to", {"height": parse_quantity("250 mm")}),
        ("pick", {"object": obj("beaker_2"), "arm": "either"}),
        ("nav_to", {"station": station("bench_a")}),
        ("place", {"object": obj("beaker_2"), "on": spot("table", "beaker"), "arm": "either"}),
    )
    golden("lower/two_stations.txt", to_text(lowered(fetch)))


def test_move_object_to_a_surface_reads_as_it_should(golden) -> None:
    call = {"object": obj("beaker_1"), "to": surface("table"), "arm": "either"}
    golden("lower/move_object.txt", to_text(lowered(plan(("move_object", call)))))


def test_the_same_plan_gives_the_same_graph() -> None:
    assert lowered(put_on_rack()) == lowered(put_on_rack())


def test_scene_origin_comes_before_everything() -> None:
    graph = lowered(put_on_rack())
    first = graph.goals[0]
    assert first.step_id == "scene_origin"
    assert isinstance(first.action, MoveTo)
    assert isinstance(first.action.target, JointTarget)
    assert first.action.target.name == "ready"
    assert len(first.action.target.joints) == 14
    ancestors = {"pick#1/1"}
    for before, after in reversed(graph.edges):
        if after in ancestors:
            ancestors.add(before)
    assert first.id in ancestors


@pytest.mark.parametrize(
    ("height", "kinds"), [(0.0, ["slide_move", "move_to"]), (0.6, ["move_to", "slide_move"])]
)
def test_the_slide_moves_first_where_it_goes_up(height: float, kinds: list[str]) -> None:
    profile, world = bench()
    joints = tuple((name, height if name == "slide_joint" else value) for name, value in world.robot.joints)
    world = replace(world, robot=replace(world.robot, joints=joints))
    graph, _ = lower(put_on_rack(), profile, world)
    assert graph is not None
    assert [item.kind for item in graph.goals if item.step_id == "scene_origin"] == kinds


def test_goals_of_a_step_are_a_chain_and_steps_keep_their_partial_order() -> None:
    both = plan(
        ("slide_to", {"height": parse_quantity("200 mm")}),
        ("open_gripper", {"arm": "left", "width": parse_quantity("20 mm")}),
        ("set_do", {"output": "lamp", "value": True}),
    )
    first, second, third = both.steps
    forked = replace(both, steps=(first, replace(second, after=()), replace(third, after=("slide_to#1",))))
    edges = set(lowered(forked).edges)
    assert ("slide_to#1/1", "open_gripper#1/1") not in edges
    assert ("scene_origin/1", "open_gripper#1/1") in edges
    assert ("slide_to#1/1", "set_do#1/1") in edges


def test_contacts_are_only_what_must_touch() -> None:
    graph = lowered(put_on_rack())

    def pairs(goal_id: str) -> set[str]:
        return {" ".join(pair) for pair in goal(graph, goal_id).allowed_contacts}

    hand = {f"tube_1 openarm_left_{part}" for part in ("hand", "left_finger", "right_finger")}
    assert pairs("pick#1/2") == set()
    assert pairs("pick#1/3") == set()
    assert pairs("pick#1/4") == hand
    assert pairs("pick#1/6") == hand | {"tube_1 rack_1"}
    assert pairs("insert#1/1") == hand
    assert pairs("insert#1/2") == hand | {"tube_1 rack_2"}
    assert pairs("insert#1/3") == hand | {"tube_1 rack_2"}
    assert pairs("insert#1/5") == set()


def test_only_a_linear_move_may_touch_the_support() -> None:
    profile, world = bench()
    spec = profile.bank.skill("pick")
    assert spec is not None
    lift = spec.template[-1]
    free = tuple((name, "free" if name == "path" else value) for name, value in lift.fields)
    template = (*spec.template[:-1], replace(lift, fields=free))
    graph, problems = lower(put_on_rack(), with_skill(profile, replace(spec, template=template)), world)
    assert graph is not None, problems
    assert ("tube_1", "rack_1") not in goal(graph, "pick#1/6").allowed_contacts


def test_parameters_say_where_they_come_from() -> None:
    graph = lowered(put_on_rack())
    assert parameters(goal(graph, "pick#1/1"))["open_width"] == ("33 mm", "computed")
    assert parameters(goal(graph, "pick#1/2"))["standoff"] == ("80 mm", "skill")
    assert parameters(goal(graph, "insert#1/2"))["insertion_depth"] == ("65 mm", "computed")
    beaker = lowered(
        plan(("move_object", {"object": obj("beaker_1"), "to": surface("table"), "arm": "right"}))
    )
    release = goal(beaker, "move_object#1/9")
    assert parameters(release)["release_width"] == ("84 mm", "usage_profile")
    written = next(item for item in release.parameters if item.name == "release_width")
    assert written.span is not None
    assert written.span.file.endswith("usage_profile.yaml")
    assert parameters(goal(beaker, "move_object#1/1"))["arm"] == ("right", "call")
    opened = lowered(plan(("open_gripper", {"arm": "left", "width": parse_quantity("20 mm")})))
    assert parameters(goal(opened, "open_gripper#1/1"))["width"] == ("20 mm", "call")


def test_either_looks_ahead_to_where_the_object_is_set_down() -> None:
    alone = lowered(plan(("pick", {"object": obj("tube_1"), "arm": "either"})))
    action = goal(alone, "pick#1/1").action
    assert isinstance(action, Grip)
    assert action.arm == "right"
    ahead = goal(lowered(put_on_rack()), "pick#1/1").action
    assert isinstance(ahead, Grip)
    assert ahead.arm == "left"


def test_either_obeys_the_arm_that_a_later_step_names() -> None:
    graph = lowered(
        plan(
            ("pick", {"object": obj("tube_1"), "arm": "either"}),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "right"}),
        )
    )
    action = goal(graph, "pick#1/5").action
    assert isinstance(action, Attach)
    assert action.arm == "right"
    why = next(item for item in goal(graph, "pick#1/1").parameters if item.name == "arm")
    assert why.rule == "`insert#1` sets it down with it"


def test_either_takes_the_free_hand() -> None:
    graph = lowered(
        plan(
            ("pick", {"object": obj("beaker_1"), "arm": "left"}),
            ("pick", {"object": obj("tube_2"), "arm": "either"}),
        )
    )
    action = goal(graph, "pick#2/5").action
    assert isinstance(action, Attach)
    assert action.arm == "right"


def test_a_drive_starts_an_epoch_and_carries_what_is_held() -> None:
    graph = lowered(
        plan(
            ("pick", {"object": obj("tube_1"), "arm": "right"}),
            ("nav_to", {"station": station("bench_b")}),
            ("place", {"object": obj("tube_1"), "on": spot("table_b", "spare"), "arm": "either"}),
            ("pick", {"object": obj("beaker_2"), "arm": "right"}),
        )
    )
    kinds = [item.kind for item in graph.goals if item.step_id == "nav_to#1"]
    assert kinds == ["move_to", "move_to", "nav_to_pose", "perceive", "move_to"]
    drive = goal(graph, "nav_to#1/3")
    assert isinstance(drive.action, NavToPose)
    assert drive.epoch == 0
    assert [item.epoch for item in graph.goals if item.step_id == "place#1"] == [1] * 5
    assert not goal(graph, "nav_to#1/4").provisional
    assert all(item.provisional for item in graph.goals if item.step_id in ("place#1", "pick#2"))
    profile, world = bench()
    T_base_beaker = graph.epochs[1].T_world_base.inverse() @ world.T_world_object("beaker_2")
    assert target(graph, "pick#2/3").T_base_reference.position_m == pytest.approx(T_base_beaker.position_m)
    table = profile.object("table_b")
    assert table is not None
    spare = next(item for item in table.spots if item.name == "spare").T_object_spot
    expected = graph.epochs[1].T_world_base.inverse() @ world.T_world_object("table_b") @ spare
    assert target(graph, "place#1/2").T_base_reference.position_m == pytest.approx(expected.position_m)


def test_arrival_brings_the_slide_to_the_stations_height_and_the_arms_to_ready() -> None:
    graph = lowered(plan(("nav_to", {"station": station("bench_b")})))
    slide, arms = graph.goals[-2:]
    assert slide.action == SlideMove(0.25)
    assert isinstance(arms.action, MoveTo)
    assert isinstance(arms.action.target, JointTarget)
    assert arms.action.target.name == "ready"


def test_an_object_is_picked_from_where_it_was_set_down() -> None:
    graph = lowered(
        plan(
            ("pick", {"object": obj("tube_1"), "arm": "left"}),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "left"}),
            ("pick", {"object": obj("tube_1"), "arm": "left"}),
        )
    )
    left = goal(graph, "insert#1/4").action
    assert isinstance(left, Detach)
    assert target(graph, "pick#2/3").T_base_reference == left.T_base_object
    assert len(graph.families) == 2


def test_a_slot_that_was_emptied_is_free() -> None:
    lowered(
        plan(
            ("pick", {"object": obj("tube_1"), "arm": "right"}),
            ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "right"}),
            ("pick", {"object": obj("tube_2"), "arm": "right"}),
            ("insert", {"object": obj("tube_2"), "into": slot("rack_1", "A1"), "arm": "right"}),
        )
    )


def test_a_surface_gives_room_beside_what_stands_on_it() -> None:
    profile, world = bench()
    graph = lowered(
        plan(("move_object", {"object": obj("beaker_1"), "to": surface("table"), "arm": "either"}))
    )
    left = next(item.action for item in graph.goals if isinstance(item.action, Detach))
    x, y, z = left.T_base_object.position_m
    assert z == pytest.approx(0.75)
    beaker = profile.object("beaker_1")
    assert beaker is not None
    for other in world.objects:
        known = profile.object(other.name)
        if known is None or other.name in ("table", "table_b", "floor", "beaker_1"):
            continue
        ox, oy, oz = world.T_world_object(other.name).position_m
        if oz < 1.0:
            assert max(abs(x - ox), abs(y - oy)) > beaker.size_m[0] / 2 + min(known.size_m[:2]) / 2


def test_waits_and_questions_are_goals() -> None:
    graph = lowered(
        plan(("wait", {"duration": parse_quantity("10 min")}), ("confirm", {"text": "Ice is in the bucket"}))
    )
    assert graph.goals[-2].action == Wait(600.0)
    assert graph.goals[-2].min_duration_s == 600.0
    assert graph.goals[-1].resources == ("person",)


def test_the_duration_of_a_skill_bounds_none_of_its_goals() -> None:
    """It is that of the whole step, which is timed later (XEI0810)."""
    graph = lowered(put_on_rack())
    assert {item.max_duration_s for item in graph.goals if item.step_id == "pick#1"} == {math.inf}
