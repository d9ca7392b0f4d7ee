"""goals.json follows its schema and says what the graph says; the text and DOT forms show every goal."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import xei_lang.ir.forms
from tests.lower.plans import bench, obj, plan, slot, station
from xei_lang.export.dot import to_dot
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.forms.goals_json import to_json
from xei_lang.ir.forms.goals_text import to_text
from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Detach, Instrument, MotionGoalGraph
from xei_lang.lower import lower
from xei_lang.quantity import parse_quantity

SCHEMA = json.loads((Path(xei_lang.ir.forms.__file__).parent / "goals.schema.json").read_text())


@pytest.fixture(scope="module")
def graph() -> MotionGoalGraph:
    """A graph with every kind of goal."""
    profile, world = bench()
    everything = plan(
        ("pick", {"object": obj("tube_1"), "arm": "either"}),
        ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "either"}),
        ("nav_to", {"station": station("bench_b")}),
        ("slide_to", {"height": parse_quantity("300 mm")}),
        ("set_do", {"output": "lamp", "value": True}),
        ("wait", {"duration": parse_quantity("2 min")}),
        ("confirm", {"text": 'is "it" there?'}),
    )
    made, problems = lower(everything, profile, world)
    assert made is not None, problems
    heated = replace(made.goals[-1], id="heat/1", kind="instrument", action=Instrument("heater", "on"))
    return replace(made, goals=(*made.goals, heated))


def document(graph: MotionGoalGraph) -> Any:
    return json.loads(dumps(to_json(graph)))


def test_goals_json_follows_its_schema(graph: MotionGoalGraph) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    value = document(graph)
    jsonschema.Draft202012Validator(SCHEMA).validate(value)
    assert {goal["kind"] for goal in value["goals"]} == set(
        SCHEMA["$defs"]["goal"]["properties"]["kind"]["enum"]
    )


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("version",), 2),
        (("goals", 0, "kind"), "fly"),
        (("goals", 0, "surprise"), 1),
        (("goals", 0, "action", "path"), "bent"),
        (("goals", 0, "epoch"), -1),
        (("families", 0, "members"), []),
        (("edges", 0), ["one"]),
    ],
)
def test_the_schema_refuses_what_is_wrong(graph: MotionGoalGraph, path: tuple[Any, ...], value: Any) -> None:
    changed = document(graph)
    inner = changed
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.Draft202012Validator(SCHEMA).validate(changed)


def test_goals_json_keeps_order_spans_and_numbers(graph: MotionGoalGraph) -> None:
    value = document(graph)
    assert [goal["id"] for goal in value["goals"]] == [goal.id for goal in graph.goals]
    assert [tuple(edge) for edge in value["edges"]] == list(graph.edges)
    assert value["goals"][1]["span"] == {"file": "test.xei", "start": 0, "end": 90}
    members = value["families"][0]["members"]
    assert [member["name"] for member in members] == [member.name for member in graph.families[0].members]
    assert members[0]["T_reference_tool"]["quaternion"] == list(
        graph.families[0].members[0].T_reference_tool.quaternion
    )


def test_every_goal_has_its_block_of_text(graph: MotionGoalGraph) -> None:
    text = to_text(graph)
    assert all(f"\n{goal.id}: " in text for goal in graph.goals)


def test_dot_reads_as_it_should(golden, graph: MotionGoalGraph) -> None:
    golden("lower/every_kind.dot", to_dot(graph))


def test_dot_escapes_what_a_person_wrote(graph: MotionGoalGraph) -> None:
    odd = replace(graph, goals=(replace(graph.goals[0], step_id='a "b" \\'),), edges=())
    assert 'label="a \\"b\\" \\\\";' in to_dot(odd)


def test_poses_are_said_in_millimetres_and_degrees() -> None:
    assert pose_text(Pose((0.56, -0.0451, -0.00001))) == "(560, -45.1, 0) mm"
    assert pose_text(Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, -1.5707963))) == "(0, 0, 0) mm yaw -90 deg"
    tilted = pose_text(Pose.from_rpy((0.0, 0.0, 0.0), (0.5235988, 0.0, 0.0)))
    assert tilted == "(0, 0, 0) mm rpy (30, 0, 0) deg"
    assert "rpy (0, 90, 0)" in pose_text(Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 1.5707963267948966, 0.0)))


def test_what_a_detach_fastens_is_said_and_only_then(graph: MotionGoalGraph) -> None:
    index, goal = next((k, goal) for k, goal in enumerate(graph.goals) if goal.kind == "detach")
    assert isinstance(goal.action, Detach)
    screwed = replace(goal, action=replace(goal.action, fastened_to="bottle_1"))
    fastened = replace(graph, goals=(*graph.goals[:index], screwed, *graph.goals[index + 1 :]))
    value = document(fastened)
    jsonschema.Draft202012Validator(SCHEMA).validate(value)
    assert value["goals"][index]["action"]["fastened_to"] == "bottle_1"
    assert "fastened_to" not in document(graph)["goals"][index]["action"]
    assert ", fastened to bottle_1" in to_text(fastened)
    assert "fastened" not in to_text(graph)
