"""Plans that came from elsewhere: a protocol's own stays as it is, and no text makes the checker raise."""

from __future__ import annotations

import json
import math
import random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import BENCH, LAB, check_json, plan_of, protocol
from tests.check.test_properties import DECIDED, PROTOCOLS, RICH
from tests.ir.forms.test_json_schema import changed
from tests.ir.forms.test_plan_read import without_places
from xei_lang.check.report import MAX_ERRORS
from xei_lang.diagnostics import Source
from xei_lang.ir.forms import plan_json
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.verify_plan import verify_plan

IN_THE_LAB = {"rich": (RICH, LAB), "decided": (DECIDED, LAB)}
WRITTEN = {**{name: (text, BENCH) for name, text in PROTOCOLS.items()}, **IN_THE_LAB}
SLOT = 'rack_2.slot("A1")'


def form(text: str, folder: Any = LAB) -> str:
    return dumps(plan_json.to_json(plan_of(text, folder), {"t.xei": Source("t.xei", text)}))


def steps(*calls: dict[str, Any], **rest: Any) -> str:
    return json.dumps({"version": 1, "skill_calls": calls, **rest})


def wait(name: str, **rest: Any) -> dict[str, Any]:
    return {"step_id": name, "skill": "wait", "args": {"duration": {"value": 1, "unit": "s"}}, **rest}


@pytest.mark.parametrize("name", WRITTEN)
def test_the_plan_of_a_protocol_is_taken_as_it_is(name: str) -> None:
    text, folder = WRITTEN[name]
    plan, said = check_json(form(text, folder), folder)
    assert said == ()
    assert plan is not None
    assert verify_plan(plan) == ()
    assert without_places(plan) == without_places(plan_of(text, folder))


@pytest.mark.parametrize("name", WRITTEN)
def test_what_a_step_leaves_out_is_what_the_protocol_makes(name: str) -> None:
    """The minimal form, with what no skill bank can tell: the order, and what kind of step uses a skill."""
    text, folder = WRITTEN[name]
    full = json.loads(form(text, folder))
    for call in full["skill_calls"]:
        for key in set(call) - {"step_id", "skill", "owner", "args", "line", "kind", "after", "needs"}:
            del call[key]
    plan, said = check_json(json.dumps({key: full[key] for key in full if key != "initial_state"}), folder)
    assert said == ()
    assert plan is not None
    assert verify_plan(plan) == ()
    for ours, theirs in zip(plan.steps, plan_of(text, folder).steps, strict=True):
        assert (ours.step_id, ours.kind, ours.owner, ours.after) == (
            theirs.step_id, theirs.kind, theirs.owner, theirs.after
        )  # fmt: skip
        assert [item.value for item in ours.args] == [item.value for item in theirs.args]
        if ours.kind == "skill":
            assert set(theirs.resources) == set(ours.resources)


def test_defaults_and_state_are_the_skill_banks() -> None:
    plan, said = check_json(
        steps(
            {"step_id": "a", "skill": "pick", "args": {"object": "tube_1", "arm": "left"}},
            {"step_id": "b", "skill": "insert", "args": {"object": "tube_1", "into": SLOT, "arm": "left"}},
            wait("c"),
        )
    )
    assert said == ()
    assert plan is not None
    text = protocol(f"pick(object=tube_1, arm=left)\ninsert(object=tube_1, into={SLOT}, arm=left)\nwait 1 s")
    protocols = plan_of(text)
    assert [step.state_before for step in plan.steps] == [step.state_before for step in protocols.steps]
    assert [step.resources for step in plan.steps] == [step.resources for step in protocols.steps]
    assert [step.duration_s for step in plan.steps] == [step.duration_s for step in protocols.steps]


def test_a_place_stands_for_what_is_in_it() -> None:
    plan, said = check_json(steps({"step_id": "a", "skill": "pick", "args": {"object": 'rack_1.slot("A1")'}}))
    assert said == ()
    assert plan is not None
    assert str(plan.steps[0].arg("object")) == "ObjectRef(name='tube_1')"
    _, (empty,) = check_json(steps({"step_id": "a", "skill": "pick", "args": {"object": SLOT}}))
    assert empty.code == "XEI0311"


def test_steps_come_in_an_order_that_after_allows() -> None:
    plan, said = check_json(steps(wait("c", after=["b"]), wait("b", after=["a"]), wait("a", after=[])))
    assert said == ()
    assert plan is not None
    assert [step.step_id for step in plan.steps] == ["a", "b", "c"]
    assert verify_plan(plan) == ()


@given(order=st.permutations(range(8)), seed=st.integers(0, 10**6))
def test_any_order_without_a_circle_is_taken(order: list[int], seed: int) -> None:
    """Steps that are each after some of those with a smaller number, in any order of the text."""
    chance = random.Random(seed)
    calls = [
        wait(f"s{number}", after=[f"s{earlier}" for earlier in range(number) if chance.random() < 0.3])
        for number in order
    ]
    plan, said = check_json(steps(*calls))
    assert said == ()
    assert plan is not None
    assert verify_plan(plan) == ()
    back = [wait("s0", after=["s7"]) if call["step_id"] == "s0" else call for call in calls]
    reached, frontier = set[str](), ["s7"]
    while frontier:
        name = frontier.pop()
        reached.add(name)
        frontier.extend(next(call for call in calls if call["step_id"] == name)["after"])
    _, said = check_json(steps(*back))
    assert [item.code for item in said] == ["XEI0211"] * ("s0" in reached)


def test_a_bound_without_an_upper_end() -> None:
    bound = {
        "from_step": "a",
        "from_end": "end",
        "to_step": "b",
        "to_end": "start",
        "lower_s": 1,
        "upper_s": None,
    }
    plan, said = check_json(steps(wait("a"), wait("b"), constraints=[bound]))
    assert said == ()
    assert plan is not None
    assert plan.constraints[0].upper_s == math.inf


def test_a_fix_stands_between_quotes() -> None:
    text = steps({"step_id": "a", "skill": "pikc", "args": {"object": "tube_1"}})
    _, (said,) = check_json(text)
    assert said.fix is not None
    (edit,) = said.fix.edits
    mended = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert check_json(mended)[1] == ()


@settings(max_examples=150)
@given(plan=changed())
def test_no_plan_makes_the_checker_raise(plan: Any) -> None:
    made, said = check_json(json.dumps(plan))
    assert (made is None) == any(item.severity == "error" for item in said)
    assert all(item.span is not None for item in said)
    if made is not None:
        assert verify_plan(made) == ()


WILD = [
    *(None, True, 0, -1, 1e300, 10**200, "", "x" * 5000, "\x1b[31m", [["tube_1"]] * 3),
    *('rack_1.slot("")', 'rack_1.row("A")', 'tube_1.slot("A1")', "table", "either", "1 mL"),
    *({"value": 1e300, "unit": "mL"}, {"value": 0, "unit": "degC"}, {"value": -1, "unit": "s"}),
    {"measured": "x", "lower": 0, "upper": {"value": 1, "unit": "mL"}},
]
ARGUMENTS = [
    *("object", "into", "on", "arm", "volume", "source", "target", "force", "for"),
    *("turns", "cool", "station", "duration", "text", "pace", "step"),
]


@settings(max_examples=200)
@given(data=st.data())
def test_no_argument_makes_the_checker_raise(data: st.DataObject) -> None:
    skill = data.draw(st.sampled_from(["pick", "insert", "place", "pour", "spin", "nav_to", "wait", "await"]))
    names = st.sampled_from([*ARGUMENTS, ""])
    args = data.draw(st.dictionaries(names, st.sampled_from(WILD), max_size=4))
    made, said = check_json(steps({"step_id": "a", "skill": skill, "args": args}))
    assert (made is None) == bool(said)
    assert all(len(item.message) < 20_000 for item in said)


LONG = f'rack_1.slot("{"A" * 90_000}")'
MANY = {
    "keys that stand twice": "{" + ",".join('"a":1' for _ in range(16_000)) + "}",
    "unknown keys": "{" + ",".join(f'"k{number}":1' for number in range(8_000)) + "}",
    "unknown steps": steps(*(wait(f"s{number}", after=["nobody"]) for number in range(1_200))),
    "needs and conditions": steps(
        wait("a", needs=[f"n{number}" for number in range(4_000)], when=["n1 < 2"] * 4_000)
    ),
    "what is no step": steps(*([1] * 30_000)),
    "one id": steps(*[wait("a")] * 1_200),
    "a long place": steps({"step_id": "a", "skill": "insert", "args": {"into": LONG, "object": LONG}}),
}


@pytest.mark.parametrize("name", MANY)
def test_many_mistakes_are_told_of_in_few_words(name: str) -> None:
    made, said = check_json(MANY[name])
    assert made is None
    assert said
    assert len(said) <= 2 * (MAX_ERRORS + 1)
    assert all(len(item.message) < 1_000 for item in said)
    assert len(said) <= MAX_ERRORS or "XEI0109" in {item.code for item in said}
