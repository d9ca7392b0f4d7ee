"""TimedPlan's fixed form: it follows its schema, reads back as the same plan, and refuses other versions."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib.resources import files

import jsonschema
import pytest

from tests.motion.verify.scene import pick_and_place, tour
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.forms.timed_json import from_json, to_json
from xei_lang.ir.forms.timed_text import to_text
from xei_lang.ir.timed import Margin

SCHEMA = json.loads(files("xei_lang.ir.forms").joinpath("timed.schema.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("make", [pick_and_place, tour])
def test_a_plan_reads_back_as_itself(make) -> None:
    margin = Margin("clearance", 0.005, "table / tube_1", "g06", 0.97)
    plan = replace(make()[0], margins=(margin,), solvers=(("left", "s-r-s"),))
    value = json.loads(dumps(to_json(plan)))
    jsonschema.validate(value, SCHEMA)
    assert from_json(value) == plan


def test_the_form_has_the_keys_of_the_command_line_document() -> None:
    value = to_json(pick_and_place()[0])
    assert {"version", "start", "limits", "goals", "duration_s", "margins"} <= value.keys()
    goal = value["goals"][0]
    keys = {
        "id",
        "step_id",
        "kind",
        "resource",
        "epoch",
        "start_s",
        "end_s",
        "joints",
        "times_s",
        "positions",
        "velocities",
        "accelerations",
        "knots",
        "attached",
        "allowed_contacts",
    }
    assert keys <= goal.keys()


def test_another_version_is_refused() -> None:
    with pytest.raises(ValueError, match="version 2"):
        from_json({**to_json(tour()[0]), "version": 2})


def test_the_text_has_a_line_for_every_goal() -> None:
    plan = pick_and_place()[0]
    text = to_text(plan)
    assert all(f"  {goal.id}  " in text for goal in plan.goals)
    assert "holding tube_1" in text
    assert "leaves tube_1" in text
