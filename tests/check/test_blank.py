"""Texts that name something, or are told to people, say something."""

from __future__ import annotations

import pytest

from tests.check.checking import BENCH, check, check_json


def told(body: str) -> list[str]:
    text = f'protocol p {{\n  profile "openarm_bench"\n  {body}\n  wait 1 s\n}}\n'
    return [found.code for found in check(text, BENCH, open_bindings=True)[1] if found.code != "XEI0505"]


@pytest.mark.parametrize(
    "body",
    [
        "set_do(output={}, value=true)",
        "start job: incubate(device=incubator, program={})\n  await job",
        "run_by_output(device=incubator, output={}, time=5 s)",
        "confirm {}",
        "note {}",
        "unmapped {}",
        "if true {{ stop {} }}",
    ],
)
def test_an_empty_text_is_refused(body: str) -> None:
    assert told(body.format('"7"')) == []
    assert told(body.format('""')) == ["XEI0327"]
    assert told(body.format('" "')) == ["XEI0327"]


def test_texts_that_only_a_protocol_uses_may_be_empty() -> None:
    assert told('let suffix = ""\n  set_do(output="fan", value=suffix == "")') == []


def test_an_empty_text_in_a_plan_is_refused() -> None:
    step = '{"step_id": "confirm#1", "skill": "confirm", "kind": "confirm", "args": {"text": "%s"}}'
    plan = '{"version": 1, "skill_calls": [' + step + "]}"
    assert [found.code for found in check_json(plan % "Ready?", BENCH)[1]] == []
    assert [found.code for found in check_json(plan % " ", BENCH)[1]] == ["XEI0327"]
