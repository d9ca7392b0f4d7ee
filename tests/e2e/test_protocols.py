"""Every protocol of the project, from text to verified motion and a dry run."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

from tests.e2e.made import PROTOCOLS, compiled
from xei_lang.cli.deliver import Compiled
from xei_lang.ir.forms.trace_json import to_line
from xei_lang.ir.trace import TraceEvent
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.pipeline import Handoffs
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.record import verify_chain
from xei_lang.runtime.run import run

FORMS = Path(__file__).resolve().parents[2] / "xei_lang" / "ir" / "forms"

every_protocol = pytest.mark.parametrize("path", PROTOCOLS, ids=[path.stem for path in PROTOCOLS])


def made_of(path: Path) -> Handoffs:
    _, outcome = compiled(path)
    assert outcome.stopped_at is None, outcome.diagnostics
    return outcome.made


def test_there_are_protocols() -> None:
    assert {path.stem for path in PROTOCOLS} >= {
        "pipette_sample",
        "pour_and_wipe",
        "put_on_rack",
        "rack_six_tubes",
        "start_incubator",
        "two_stations",
    }


@every_protocol
def test_it_compiles_to_motion_that_the_verifier_accepts(path: Path) -> None:
    made = made_of(path)
    assert made.timed is not None and made.verified is not None
    assert made.verified.configurations > 1000 * 0.9 * made.timed.duration_s * 0.3
    moved = [goal for goal in made.timed.goals if goal.knots is not None]
    assert len(moved) >= 5


@every_protocol
def test_its_steps_take_what_their_skills_declare(path: Path) -> None:
    _, outcome = compiled(path)
    assert [item.message for item in outcome.diagnostics if item.code == "XEI0810"] == []


@every_protocol
def test_every_representation_is_sound_between_its_passes(path: Path) -> None:
    made = made_of(path)
    assert made.plan is not None and made.graph is not None
    assert verify_plan(made.plan) == ()
    assert verify_goals(made.graph) == ()


@every_protocol
def test_every_form_keeps_its_schema(path: Path) -> None:
    request, _ = compiled(path)
    made = made_of(path)
    contents = Compiled.of(request.source, made).bundle_contents()
    for name in ("plan", "goals", "timed"):
        content = contents[f"{name}.json"]
        assert isinstance(content, bytes)
        schema = json.loads((FORMS / f"{name}.schema.json").read_text(encoding="utf-8"))
        jsonschema.validate(json.loads(content), schema)


@every_protocol
def test_the_objects_end_where_the_protocol_puts_them(path: Path) -> None:
    made = made_of(path)
    assert made.timed is not None and made.graph is not None
    put = [goal for goal in made.timed.goals if goal.kind == "detach"]
    assert len(put) == sum(goal.kind == "attach" for goal in made.timed.goals)
    riding = {item.name for item in made.profile.objects if item.thread} if made.profile else set[str]()
    assert all(len([item for item in goal.placed if item.object not in riding]) <= 1 for goal in put)
    assert all(goal.placed for goal in put)


@every_protocol
def test_a_dry_run_succeeds_and_leaves_a_whole_trace(path: Path) -> None:
    request, _ = compiled(path)
    made = made_of(path)
    assert made.graph is not None
    events: list[TraceEvent] = []
    given = Compiled.of(request.source, made).run_inputs()
    result = run(given, "dry-run", Answers(), events.append)
    assert result.status == "succeeded", result.diagnostics
    assert result.goals_done == len(made.graph.goals)
    assert [event.stage for event in events[:3]] == ["scene_setup", "world_state", "planning"]
    assert {event.stage for event in events[3:-1]} == {"precheck", "execution", "feedback"}
    assert events[-1].stage == "end"
    assert verify_chain([to_line(event) for event in events]) == ()


def test_the_scene_origin_is_reached_before_anything_else() -> None:
    for path in PROTOCOLS:
        made = made_of(path)
        assert made.timed is not None
        assert made.timed.goals[0].step_id == "scene_origin"


def test_a_drive_starts_a_new_epoch_and_grounds_again() -> None:
    made = made_of(next(path for path in PROTOCOLS if path.stem == "two_stations"))
    assert made.graph is not None
    kinds = [goal.kind for goal in made.graph.goals]
    drives = [index for index, kind in enumerate(kinds) if kind == "nav_to_pose"]
    assert len(drives) >= 2
    assert all(kinds[index + 1] == "perceive" for index in drives)
    assert len(made.graph.epochs) == len(drives) + 1
