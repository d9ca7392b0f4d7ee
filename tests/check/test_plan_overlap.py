"""Plans from elsewhere whose steps may overlap: what they use together, what instruments hold."""

from __future__ import annotations

import json
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.check.checking import check_json, protocol
from tests.check.test_plan_file import form

WARM = "warm: heat(block=block_1, to=37 degC, for=10 min)"
ON_IT = 'insert(object=tube_1, into=block_1.slot("A1"))'
OWN = {
    "branches of a choice": """
        measure od: Float = read(object=tube_2)
        if od < 0.3 { pick(object=tube_1, arm=left) }
        else if od < 0.6 { pick(object=tube_1, arm=left)
          note "again" }
        else { pick(object=tube_1, arm=left) }
        insert(object=tube_1, into=rack_2.slot("A1"), arm=left)""",
    "branches that share nothing": """
        parallel { { pick(object=tube_1, arm=left) } { pick(object=tube_2, arm=right) } }
        wait 1 s""",
    "a pause": f"""
        pick(object=tube_1)
        start {WARM}
        pause warm {{ {ON_IT} }}
        await warm""",
    "an end in each branch": f"""
        pick(object=tube_1)
        measure od: Float = read(object=tube_2)
        start {WARM}
        if od < 0.3 {{ await warm
          {ON_IT} }} else {{ stop warm
          {ON_IT} }}
        wait 1 s""",
}


@pytest.mark.parametrize("name", OWN)
def test_what_a_protocol_may_do_its_plan_may(name: str) -> None:
    assert check_json(form(protocol(OWN[name])))[1] == ()


def plan(*calls: dict[str, Any]) -> str:
    return json.dumps({"version": 1, "skill_calls": calls})


def step(name: str, skill: str, after: list[str], **args: Any) -> dict[str, Any]:
    return {"step_id": name, "skill": skill, "after": after, "args": args}


@st.composite
def picks(draw: st.DrawFn) -> list[dict[str, Any]]:
    """Steps that each take one of three things, after some of those before them, perhaps on a condition."""
    calls: list[dict[str, Any]] = []
    for number in range(draw(st.integers(2, 9))):
        after = draw(st.sets(st.integers(0, number - 1))) if number else set[int]()
        thing = draw(st.sampled_from(["tube_1", "tube_2", "tube_3"]))
        when = draw(st.sampled_from([[], [], ["od < 2"], ["not (od < 2)"]]))
        found = step(f"s{number}", "pick", [f"s{other}" for other in sorted(after)], object=thing)
        calls.append({**found, "when": when})
    return calls


@given(calls=picks())
def test_each_overlap_is_found_and_nothing_else(calls: list[dict[str, Any]]) -> None:
    before: dict[str, set[str]] = {}
    for call in calls:
        before[call["step_id"]] = set(call["after"]).union(*(before[name] for name in call["after"]))
    clashing = {
        one["args"]["object"]
        for one, two in combinations(calls, 2)
        if one["args"] == two["args"] and one["step_id"] not in before[two["step_id"]]
        if not one["when"] or not two["when"] or one["when"] == two["when"]
    }
    said = check_json(plan(*calls))[1]
    assert {item.code for item in said} <= {"XEI0330"}
    assert {item.message.split("`")[1] for item in said} == clashing


WARMING = {
    **step("warm", "heat", ["take"], block="block_1", to="37 degC", **{"for": "10 min"}),
    "kind": "start",
}
TAKE = step("take", "pick", [], object="tube_1")
PUT = {"object": "tube_1", "into": 'block_1.slot("A1")'}


@pytest.mark.parametrize(
    ("end", "after", "codes"),
    [
        ("await", ["end"], []),
        ("stop", ["end"], []),
        ("leave", ["end"], ["XEI0345"]),
        ("await", ["warm"], ["XEI0345"]),
        ("await", ["take"], ["XEI0330"]),
    ],
)
def test_what_is_held_is_free_after_the_end(end: str, after: list[str], codes: list[str]) -> None:
    text = plan(TAKE, WARMING, step("end", end, ["warm"], step="warm"), step("put", "insert", after, **PUT))
    assert [item.code for item in check_json(text)[1]] == codes


@pytest.mark.parametrize(("after", "codes"), [("off", []), ("on", ["XEI0345"])])
def test_a_pause_lets_go_until_it_is_resumed(after: str, codes: list[str]) -> None:
    text = plan(
        TAKE,
        WARMING,
        step("off", "pause", ["warm"], step="warm"),
        *([step("put", "insert", ["off"], **PUT)] if after == "off" else []),
        step("on", "resume", ["put" if after == "off" else "off"], step="warm"),
        *([step("put", "insert", ["on"], **PUT)] if after == "on" else []),
        step("end", "await", ["put" if after == "on" else "on"], step="warm"),
    )
    assert [item.code for item in check_json(text)[1]] == codes


def test_both_steps_are_shown_where_they_stand_in_the_json() -> None:
    one, two = step("one", "pick", [], object="tube_1"), step("two", "pick", [], object="tube_1")
    text = plan(one, two)
    (said,) = check_json(text)[1]
    assert said.span is not None
    (label,) = said.labels
    starts = [text.index('"tube_1"'), text.rindex('"tube_1"')]
    assert [label.span.start, said.span.start] == starts


def test_a_reference_that_leads_nowhere_is_the_one_mistake() -> None:
    one, two = step("one", "pick", [], object="tube_1"), step("two", "pick", ["onne"], object="tube_1")
    assert [item.code for item in check_json(plan(one, two))[1]] == ["XEI0211"]
