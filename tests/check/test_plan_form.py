"""The plan's fixed form, on small protocols."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import jsonschema
import pytest

from tests.check.checking import LAB, ROOT, plan_of, protocol
from tests.check.test_properties import DECIDED, RICH
from xei_lang.diagnostics import Source
from xei_lang.ir.forms import plan_json
from xei_lang.ir.forms.canonical import dumps

SCHEMA = json.loads(Path(plan_json.__file__).with_name("plan.schema.json").read_text(encoding="utf-8"))


def form(text: str, folder: Path = LAB, **options: object) -> str:
    return dumps(plan_json.to_json(plan_of(text, folder, **options), {"t.xei": Source("t.xei", text)}))


def test_put_on_rack(golden: Callable[[str, str], None]) -> None:
    text = (ROOT / "protocols" / "put_on_rack.xei").read_text(encoding="utf-8")
    golden("check/put_on_rack.plan.json", form(text))


def test_every_part_of_the_form(golden: Callable[[str, str], None]) -> None:
    golden("check/rich.plan.json", form(RICH))


@pytest.mark.parametrize("text", [RICH, DECIDED, protocol("wait 1 s"), protocol("")])
def test_the_schema_describes_it(text: str) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(json.loads(form(text)), SCHEMA)


def test_the_same_protocol_gives_the_same_bytes() -> None:
    assert form(RICH) == form(RICH)


def test_values_are_written_as_a_reader_wants_them() -> None:
    text = protocol(
        "pour(source=cup_1, target=tube_1, volume=2500 uL)\nspin(object=tube_1, force=200 xg, for=1.5 min)\n"
        'place(object=tube_1, on=rack_2.slot("A1"))\nplace(object=cup_1, on=table)\nwait 1 s within 1 min'
    )
    plan = json.loads(form(text))
    pour, spin, slot, surface, wait = plan["skill_calls"]
    assert pour["args"] == {
        "source": "cup_1",
        "target": "tube_1",
        "volume": {"value": 2500, "unit": "uL"},
        "pace": "slow",
        "arm": "either",
    }
    assert pour["defaults"] == ["pace", "arm"]
    assert spin["args"]["for"] == {"value": 1.5, "unit": "min"}
    assert (spin["args"]["turns"], spin["args"]["cool"]) == (1, False)
    assert slot["args"]["on"] == 'rack_2.slot("A1")'
    assert surface["args"]["on"] == "table"
    assert (wait["skill"], wait["kind"], wait["line"]) == ("wait", "wait", 7)
    assert plan["constraints"][0]["upper_s"] == 60.0
