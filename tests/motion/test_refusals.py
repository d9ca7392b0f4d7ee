"""What motion planning refuses, and that its words are true: bodies by their names, bounds as bounds."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tests.motion.sequence.bench import DESCRIPTION, bench, goals, obj, plan, planned, slot, spot
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import JointTarget, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.tool_paths import Turn
from xei_lang.ir.world import World
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.robot import load_robot
from xei_lang.motion.sequence import group, sound, winnow
from xei_lang.motion.sequence.space import Touch
from xei_lang.profiles.model import Profile

PUT = plan(
    ("pick", {"object": obj("tube_1"), "arm": "right"}),
    ("insert", {"object": obj("tube_1"), "into": slot("rack_1", "B2"), "arm": "right"}),
)


def standing(world: World, name: str, x_m: float, y_m: float, z_m: float) -> World:
    """The world with an object put at a place of the table's frame."""
    there = Pose((x_m, y_m, z_m))
    changed = (
        replace(item, frame_id="table", T_frame_object=there) if item.name == name else item
        for item in world.objects
    )
    return replace(world, objects=tuple(changed))


def refused(graph: MotionGoalGraph) -> Diagnostic:
    profile, world = bench()
    timed, problems = plan_motion(graph, world, profile, DESCRIPTION, 1)
    assert timed is None
    assert len(problems) == 1
    return problems[0]


def with_action(graph: MotionGoalGraph, index: int, action: MoveTo) -> MotionGoalGraph:
    changed: list[MotionGoal] = [*graph.goals]
    changed[index] = replace(changed[index], action=action)
    return replace(graph, goals=tuple(changed))


def first_linear(graph: MotionGoalGraph) -> tuple[int, MoveTo]:
    return next(
        (index, goal.action)
        for index, goal in enumerate(graph.goals)
        if isinstance(goal.action, MoveTo) and goal.action.path == "linear"
    )


def test_a_way_that_is_walled_off_between_two_places_names_the_wall() -> None:
    profile, world = bench()
    # The top of the second table hovers over the first one, from its front edge on: the tube stands below it.
    world = standing(world, "table_b", 0.3, 0.0, 0.42 - 0.85)
    world = standing(world, "beaker_2", 0.6, 0.5, 0.42)
    steps = plan(("move_object", {"object": obj("tube_3"), "to": spot("table_b", "spare"), "arm": "right"}))
    timed, problems = planned(steps, profile, world)
    assert timed is None
    said = problems[0]
    assert said.code == "XEI0803"
    assert said.message.startswith("the way of the right arm is blocked: `")
    robot = load_robot(DESCRIPTION.urdf_text, DESCRIPTION.srdf_text)
    bodies = said.message.split("`")[1::2]
    links = {str(frame.name) for frame in robot.model.frames}
    assert all(world.find(name) is not None or name in links for name in bodies)
    assert "table_b" in bodies
    assert said.notes[0] == "they meet on the straight way, and no way around them was found"
    assert said.help[0].startswith("without `table_b` there is a way")


def test_a_path_that_is_not_described_or_leads_elsewhere_is_refused() -> None:
    profile, world = bench()
    graph = goals(PUT, profile, world)
    index, move = first_linear(graph)
    said = refused(with_action(graph, index, replace(move, path="arc")))
    assert said.code == "XEI0806"
    assert said.message == "the way of the right arm cannot be planned: its path `arc` is not described"
    turn = Turn((0.5, 0.0, 1.0), (0.0, 0.0, 1.0), 0.5)
    last = len(graph.goals) - 1
    action = graph.goals[last].action
    assert isinstance(action, MoveTo)
    said = refused(with_action(graph, last, replace(action, path="arc", along=turn)))
    assert said.message.startswith("the way of the right arm cannot be planned: its path ")


def test_a_linear_move_needs_something_to_start_from() -> None:
    profile, world = bench()
    graph = goals(PUT, profile, world)
    index, move = first_linear(graph)
    other = replace(move, arm="left")
    said = refused(with_action(graph, index, other))
    assert said.code == "XEI0806"
    assert said.message == "a linear move has nothing to start from"


def test_a_configuration_outside_the_range_names_the_joint_and_the_range() -> None:
    profile, world = bench()
    graph = goals(PUT, profile, world)
    target = JointTarget("ready", (("openarm_right_joint4", 9.0),))
    index = next(i for i, goal in enumerate(graph.goals) if isinstance(goal.action, MoveTo))
    said = refused(with_action(graph, index, MoveTo(target)))
    limit = next(row for row in profile.calibration.limits if row.joint == "openarm_right_joint4")
    assert said.code == "XEI0807"
    assert said.message == "`openarm_right_joint4` cannot stand at 9.000 rad"
    assert f".. {limit.upper:.3f} rad" in said.label


def on_table(world: World, name: str, x_m: float, y_m: float) -> World:
    """The world with an object put on the table."""
    changed = standing(world, name, x_m, y_m, 0.0)
    loose = (replace(item, place="") if item.name == name else item for item in changed.objects)
    return replace(changed, objects=tuple(loose))


def blocked_place() -> tuple[Profile, World]:
    """A bottle at hand, and a plate where it is to be set down: too low for any hand to meet it."""
    profile, world = bench()
    world = on_table(on_table(world, "wipe_1", 0.08, 0.60), "bottle_1", 0.08, 0.45)
    return profile, on_table(world, "cap_rest_1", 0.08, 0.33)


SET_DOWN = plan(
    ("pick", {"object": obj("bottle_1"), "arm": "left"}),
    ("place", {"object": obj("bottle_1"), "on": spot("table", "beaker"), "arm": "left"}),
)


def test_a_place_where_the_object_itself_does_not_fit_is_refused_before_any_grasp_is_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried: list[int] = []

    def looked_at(*_args: Any) -> None:
        tried.append(1)

    monkeypatch.setattr(sound, "first_touch", looked_at)
    timed, problems = planned(SET_DOWN, *blocked_place())
    assert timed is None
    assert tried == []
    assert problems[0].code == "XEI0802"
    assert problems[0].span == SET_DOWN.steps[1].span
    assert problems[0].message == (
        'no grasp brings the left hand to `table.spot("beaker")` with `bottle_1`:'
        " `bottle_1` itself would touch `cap_rest_1`"
    )


def test_a_search_in_which_every_candidate_falls_ends_after_a_count(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[int] = []
    whole = sound.first_touch

    def counted(*args: Any) -> Touch | None:
        looked.append(1)
        return whole(*args)

    # As if what stood in the way were a thing that each grasp meets by itself.
    def fits(*_args: Any) -> None:
        return None

    monkeypatch.setattr(group, "object_touch", fits)
    monkeypatch.setattr(sound, "first_touch", counted)
    monkeypatch.setattr(winnow, "MAX_STRIKES", 40)
    timed, problems = planned(SET_DOWN, *blocked_place())
    assert timed is None
    assert problems[0].code == "XEI0802"
    assert problems[0].span == SET_DOWN.steps[1].span
    assert any(note.startswith("the search ended when") for note in problems[0].notes)
    efforts, chains = 2, 2
    assert len(looked) <= efforts * chains * (40 + 1)
