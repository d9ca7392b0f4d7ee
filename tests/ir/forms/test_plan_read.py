"""A plan that was written as JSON and read again is the same plan."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.diagnostics import Source, Span
from xei_lang.ir.forms import plan_json
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.forms.json_reader import read_json
from xei_lang.ir.forms.plan_read import plan_from_json
from xei_lang.ir.skill_plan import (
    Argument,
    Call,
    Condition,
    Fact,
    ObjectRef,
    PlaceRef,
    PoseIn,
    RunValue,
    SafetyNote,
    SkillPlan,
    StationRef,
    Step,
    TimeConstraint,
    UnmappedRequest,
    Value,
)
from xei_lang.quantity import TYPE_DIMENSIONS, UNITS, quantity

SCHEMA = json.loads(Path(plan_json.__file__).with_name("plan.schema.json").read_text(encoding="utf-8"))
HERE = Span("", 0, 0)
NAMES = st.from_regex(r"[a-z][a-z_]{0,5}[0-9]?", fullmatch=True).filter(
    lambda name: name not in ("left", "right", "either", "nothing")
)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=12)
FRACTIONS = st.fractions(-(10**6), 10**6, max_denominator=10**4)
PLACES = st.one_of(
    st.builds(PlaceRef, NAMES, st.sampled_from(["slot", "spot"]), TEXTS.filter(bool)),
    st.builds(lambda name: PlaceRef(name, "surface", ""), NAMES),
)
FLOATS = st.floats(allow_nan=False, allow_infinity=False)


def quantities(type_: str) -> st.SearchStrategy[Value]:
    units = [symbol for symbol, unit in UNITS.items() if unit.dimension in TYPE_DIMENSIONS[type_]]
    return st.builds(quantity, FRACTIONS, st.sampled_from(units))


def triples(type_: str) -> st.SearchStrategy[Value]:
    return st.tuples(*[quantities(type_)] * 3)


TYPES: dict[str, st.SearchStrategy[Value]] = {
    "object": st.builds(ObjectRef, NAMES),
    "Place": PLACES,
    "Station": st.builds(StationRef, NAMES),
    "Pose": st.builds(PoseIn, NAMES, triples("Length"), triples("Angle")),
    "Arm": st.sampled_from(["left", "right", "either"]),
    "choice": NAMES,
    "String": TEXTS,
    "Bool": st.booleans(),
    "Int": st.integers(-(10**20), 10**20),
    "Float": FLOATS,
    "List[Place]": st.lists(PLACES, max_size=3).map(tuple),
    "List[List[Int]]": st.lists(st.lists(st.integers(), max_size=2).map(tuple), max_size=2).map(tuple),
    **{type_: quantities(type_) for type_ in TYPE_DIMENSIONS},
}
SKILL = {f"a{index}": type_ for index, type_ in enumerate(TYPES)}
"""The arguments of the one skill of these plans, by name: one of each type."""
FACTS = st.one_of(
    st.builds(Fact, st.just("holding"), NAMES, st.one_of(st.just("nothing"), st.builds(ObjectRef, NAMES))),
    st.builds(Fact, st.just("at"), NAMES, st.one_of(st.sampled_from(["left", "either"]), PLACES)),
    st.builds(Fact, st.sampled_from(["cap", "volume"]), NAMES, st.one_of(NAMES, quantities("Volume"))),
)
SECONDS = st.floats(0, 1e6)


def known(facts: list[Fact]) -> tuple[Fact, ...]:
    """Sorted; only of what is held several things can be known."""
    found = {
        (fact.variable, fact.subject, fact.value if fact.variable == "holding" else ""): fact
        for fact in facts
    }
    return tuple(sorted(found.values(), key=lambda fact: (fact.variable, fact.subject)))


@st.composite
def steps(draw: st.DrawFn, index: int, before: tuple[str, ...]) -> Step:
    kind: Any = draw(st.sampled_from(["skill", "skill", "measure", "wait", "confirm", "pause"]))
    names = draw(st.lists(st.sampled_from(sorted(SKILL)), unique=True, max_size=5))
    has_skill = kind in ("skill", "measure")
    args = [
        Argument(
            name, draw(TYPES[SKILL[name]]), SKILL[name], draw(st.sampled_from(["call", "default"])), HERE
        )
        for name in (names if has_skill else ())
    ]
    needs = before[:1]
    if has_skill and needs and draw(st.booleans()):
        args.append(Argument("how_much", RunValue(f"{needs[0]} * 2", needs, 0, 2), "Float", "call", HERE))
    if kind == "wait":
        args.append(Argument("duration", draw(quantities("Time")), "Time", "call", HERE))
    if kind == "confirm":
        args.append(Argument("text", draw(TEXTS), "String", "call", HERE))
    low = draw(SECONDS)
    conditions = [Condition(f"{name} < 3", (name,), HERE) for name in needs]
    return Step(
        f"step[{index}].a#1",
        kind,
        HERE,
        "mix" if has_skill else "",
        draw(st.sampled_from(["arm", ""])),
        tuple(args),
        (low, draw(st.one_of(st.just(math.inf), SECONDS.map(lambda more: low + more)))),
        tuple(draw(st.lists(st.sampled_from(before), unique=True, max_size=2))) if before else (),
        draw(TEXTS),
        tuple(draw(st.lists(st.integers(1, 9), max_size=2))),
        tuple(draw(st.lists(st.sampled_from([*conditions, Condition("od > 1", (), HERE)]), max_size=2))),
        tuple(sorted(draw(st.sets(NAMES, max_size=3)))),
        known(draw(st.lists(FACTS, max_size=4))),
        tuple(Call(name, HERE) for name in draw(st.lists(NAMES, max_size=2))),
        tuple(conditions),
        needs,
    )


@st.composite
def plans(draw: st.DrawFn) -> SkillPlan:
    found: list[Step] = []
    for index in range(draw(st.integers(0, 4))):
        found.append(draw(steps(index, tuple(step.step_id for step in found))))
    ids = [step.step_id for step in found]
    after = st.sampled_from([*ids, None])
    ends = st.sampled_from(["start", "end"])
    step, upper = st.sampled_from(ids or [""]), st.one_of(st.just(math.inf), SECONDS)
    bounds = st.builds(TimeConstraint, step, ends, step, ends, SECONDS, upper, st.just(HERE))
    return SkillPlan(
        draw(NAMES),
        draw(NAMES),
        tuple(found),
        known(draw(st.lists(FACTS, max_size=6))),
        tuple(draw(st.lists(bounds, max_size=2))) if ids else (),
        tuple(draw(st.lists(st.builds(UnmappedRequest, TEXTS, TEXTS, after, st.just(HERE)), max_size=2))),
        tuple(draw(st.lists(st.builds(SafetyNote, TEXTS, after, st.just(HERE)), max_size=2))),
    )


def without_places(value: Any) -> Any:
    """The plan with all its spans the same."""
    if isinstance(value, Span):
        return HERE
    if isinstance(value, tuple):
        return tuple(without_places(item) for item in value)
    names = getattr(value, "__dataclass_fields__", {})
    if not names or type(value).__module__ != SkillPlan.__module__:
        return value
    return replace(value, **{name: without_places(getattr(value, name)) for name in names})


def type_of(skill: str, argument: str) -> str | None:
    return {**SKILL, "how_much": "Float"}.get(argument) if skill == "mix" else None


def read(text: str) -> SkillPlan:
    node, said = read_json(Source("plan.json", text))
    assert node is not None
    assert said == ()
    plan, said = plan_from_json(node, type_of)
    assert said == ()
    return plan


@settings(max_examples=150)
@given(plan=plans())
def test_what_is_written_is_read_as_it_was(plan: SkillPlan) -> None:
    text = dumps(plan_json.to_json(plan, {}))
    jsonschema.Draft202012Validator(SCHEMA).validate(json.loads(text))
    again = read(text)
    assert without_places(again) == plan
    units = [item.value.unit for step in plan.steps for item in step.args if hasattr(item.value, "unit")]
    read_units = [
        item.value.unit for step in again.steps for item in step.args if hasattr(item.value, "unit")
    ]
    assert units == read_units
    assert dumps(plan_json.to_json(again, {})) == text


def test_a_quantity_is_exact_where_decimals_are_not() -> None:
    third = quantity(Fraction(10, 3), "mL")
    form = plan_json.value_form(third)
    assert form == {"value": 10 / 3, "unit": "mL", "exact": "10/3"}
    assert plan_json.value_form(quantity(Fraction(1, 10), "mL")) == {"value": 0.1, "unit": "mL"}


@pytest.mark.parametrize(
    "value",
    ['{"value": 3.3, "unit": "mL", "exact": "10/3"}', '{"value": 1, "unit": "mL", "exact": "1/0"}',
     '{"value": 1, "unit": "mL", "exact": "one"}', '{"value": 1, "unit": "Ml"}',
     '{"value": 1, "unit": "parsec"}',
     '"2 ml"', '"2"', '""', '"1e9 mL"'],
)  # fmt: skip
def test_a_value_that_is_none_is_said(value: str) -> None:
    volume = next(name for name, type_ in SKILL.items() if type_ == "Volume")
    step = f'{{"step_id": "s", "skill": "mix", "args": {{"{volume}": {value}}}}}'
    text = f'{{"version": 1, "skill_calls": [{step}]}}'
    node, _ = read_json(Source("plan.json", text))
    assert node is not None
    _, (said,) = plan_from_json(node, type_of)
    assert said.code == "XEI0111"
    assert said.span is not None
    assert text[said.span.start : said.span.end] in value


def test_the_least_that_a_plan_says() -> None:
    text = (
        '{"version": 1, "skill_calls": [{"step_id": "a", "skill": "mix"},'
        '{"step_id": "b", "skill": "wait", "args": {"duration": {"value": 2, "unit": "min"}}},'
        '{"step_id": "c", "skill": "confirm", "after": []}]}'
    )
    first, second, third = read(text).steps
    assert (first.kind, first.skill, first.after, first.duration_s) == ("skill", "mix", (), (0.0, math.inf))
    assert (second.kind, second.skill, second.after, second.duration_s) == (
        "wait",
        "",
        ("a",),
        (120.0, 120.0),
    )
    assert (third.kind, third.after) == ("confirm", ())
    assert text[first.span.start : first.span.end] == '{"step_id": "a", "skill": "mix"}'
