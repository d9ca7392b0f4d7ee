"""What a run decides: readings as intervals, conditions in the ids of measuring steps, the end by `stop`."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import check, codes, ids, plan_of, protocol
from xei_lang.check.state import State
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import RunValue, SkillPlan, Step
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.quantity import quantity

OD = "measure od: Float = read(object=tube_1) in 0.05 .. 2"


def steps_of(body: str) -> dict[str, Step]:
    plan = plan_of(protocol(body))
    assert verify_plan(plan) == ()
    return {step.step_id: step for step in plan.steps}


def conditions(step: Step) -> list[str]:
    return [condition.text for condition in step.when]


def test_a_measuring_step_has_its_limits_as_arguments() -> None:
    step = steps_of(f"{OD}\nwait 1 s")["od"]
    assert (step.kind, step.skill, step.owner) == ("measure", "read", "instrument")
    assert (step.arg("reading.lower"), step.arg("reading.upper")) == (0.05, 2.0)
    by_default = steps_of("measure od: Float = read(object=tube_1)")["od"]
    assert (by_default.arg("reading.lower"), by_default.arg("reading.upper")) == (0.0, 4.0)
    assert {item.source for item in by_default.args if "." in item.name} == {"default"}
    one_end = "measure m: Mass = weigh(object=tube_1) in 1 g .. 2 g"
    assert steps_of(one_end)["m"].arg("reading.upper") == quantity(2, "g")


def test_an_argument_that_is_measured_says_how_and_between_what() -> None:
    step = steps_of(f"{OD}\nlet v = 1 mL + od * 2 mL\npour(source=cup_1, target=tube_1, volume=v)")["pour#1"]
    assert step.arg("volume") == RunValue(
        "1 mL + (od * 2 mL)", ("od",), quantity(Fraction("1.1"), "mL"), quantity(5, "mL")
    )
    assert step.needs == ("od",)


@pytest.mark.parametrize(
    ("expression", "formula", "low", "high"),
    [
        ("-od", "-od", -2.0, -0.05),
        ("min(od, 1)", "min(od, 1)", 0.05, 1.0),
        ("max(od, 1) - 1", "(max(od, 1)) - 1", 0.0, 1.0),
        ("ceil(od)", "ceil(od)", 1.0, 2.0),
        ("od * (1 / 3)", "od * (1 / 3)", 0.05 / 3, 2 / 3),
    ],
)
def test_formulas(expression: str, formula: str, low: float, high: float) -> None:
    step = steps_of(f"{OD}\nlet x = {expression}\nwait (3 + x) * 1 s")["wait#1"]
    value = step.arg("duration")
    assert isinstance(value, RunValue)
    assert f"(3 + {formula if ' ' not in formula else f'({formula})'}) * 1 s" == value.formula
    assert step.duration_s == pytest.approx((3 + low, 3 + high))


def test_formulas_do_not_grow_without_end() -> None:
    doubled = "\n".join(f"let x{i + 1} = x{i} + x{i}" for i in range(30))
    assert codes(f"{OD}\nlet x0 = od\n{doubled}\nwait x30 * 1 s") == ["XEI0312"]
    longer = "\n".join(f"let b{i + 1} = b{i} and b{i}" for i in range(30))
    assert codes(f"{OD}\nlet b0 = od > 1\n{longer}\nif b30 {{ wait 1 s }}") == ["XEI0312"]


def test_both_branches_happen_under_their_condition() -> None:
    otherwise = "else if not (od > 0.3) { wait 2 s } else { wait 3 s }"
    steps = steps_of(f"{OD}\nif od > 0.6 and true {{ wait 1 s }} {otherwise}\nwait 4 s")
    assert [conditions(steps[f"wait#{n}"]) for n in (1, 2, 3, 4)] == [
        ["od > 0.6"],
        ["not (od > 0.6)", "not (od > 0.3)"],
        ["not (od > 0.6)", "not (not (od > 0.3))"],
        [],
    ]
    assert steps["wait#2"].needs == ("od",)
    assert set(steps["wait#4"].after) == {"wait#1", "wait#2", "wait#3"}


def test_limits_can_decide_a_choice() -> None:
    assert ids(f'{OD}\nif od < 3 {{ wait 1 s }} else {{ confirm "?" }}') == ["od", "wait#1"]


def test_what_a_condition_is_let_be_keeps_its_formula() -> None:
    steps = steps_of(f"{OD}\nlet dense = od > 1\nif dense {{ wait 1 s }}\nrequire dense")
    assert conditions(steps["wait#1"]) == ["od > 1"]
    assert (steps["require#1"].arg("condition"), steps["require#1"].needs) == ("od > 1", ("od",))


def test_turns_carry_the_conditions_of_those_before() -> None:
    body = f'wash: repeat 3 times until od < 0.1 {{ wait 1 s  {OD} }} else {{ confirm "?" }}\nwait 2 s'
    steps = steps_of(body)
    assert list(steps) == [
        "wash[1].wait#1", "wash[1].od", "wash[2].wait#1", "wash[2].od", "wash[3].wait#1", "wash[3].od",
        "wash.confirm#1", "wait#1",
    ]  # fmt: skip
    told = [f"not (wash[{n}].od < 0.1)" for n in (1, 2, 3)]
    assert [conditions(step) for step in steps.values()] == [
        [], [], told[:1], told[:1], told[:2], told[:2], told, [],
    ]  # fmt: skip


@given(st.integers(1, 12), st.integers(1, 4), st.booleans())
@settings(deadline=None)
def test_a_plan_is_as_large_as_its_turns(turns: int, waits: int, has_else: bool) -> None:
    otherwise = 'else { stop "x" }' if has_else else ""
    body = f"repeat {turns} times until od < 0.1 {{ {'wait 1 s ' * waits} {OD} }} {otherwise}"
    plan = plan_of(protocol(body))
    assert len(plan.steps) == turns * (waits + 1) + has_else
    assert max(len(step.when) for step in plan.steps) == turns - 1 + has_else
    assert verify_plan(plan) == ()


def test_too_many_turns_are_refused_before_they_are_made() -> None:
    body = f"repeat 100000 times until od < 0.1 {{ {OD} }}"
    assert codes(body) == ["XEI0316"]
    assert codes(f"repeat 30 times until od < 0.1 {{ {OD} }}", max_steps=20) == ["XEI0316"]


def test_a_branch_that_ends_says_nothing_of_what_follows() -> None:
    ended = (
        f'{OD}\nif od > 1 {{ pick(object=tube_1, arm=left)  stop "dense" }}\nrequire holding(left) == nothing'
    )
    assert ids(ended) == ["od", "pick#1", "stop#1"]
    both = f'{OD}\nif od > 1 {{ stop "a" }} else {{ stop "b" }}\nwait 1 s'
    assert codes(both) == ["XEI0505"]
    assert ids(both) == ["od", "stop#1", "stop#2"]
    assert steps_of(both)["stop#1"].arg("message") == "a"


def test_a_stop_that_a_parameter_decides() -> None:
    body = 'param n: Int = 1\nif n > 3 { stop "too many" }\nwait 1 s'
    assert ids(body) == ["wait#1"]
    assert ids(body, params={"n": "4"}) == ["stop#1"]
    assert codes(body, params={"n": "4"}) == ["XEI0505"]


def test_notes_and_gaps_behind_a_stop_are_kept() -> None:
    plan = plan_of(protocol('stop "x"\nnote "hot"\nunmapped "spin"'))
    assert [note.text for note in plan.safety_notes] == ["hot"]
    assert [gap.text for gap in plan.unmapped_requests] == ["spin"]


def test_a_stop_in_a_branch_that_may_overlap_ends_all() -> None:
    assert codes('parallel { { stop "x" } { wait 1 s } }\nwait 2 s') == ["XEI0505"]


FACTS = st.lists(st.tuples(st.sampled_from("xyz"), st.sampled_from("abc"), st.integers(0, 3)), max_size=6)


@given(FACTS, FACTS)
def test_joining_an_ended_branch_leaves_the_other(first: list[tuple], second: list[tuple]) -> None:
    states = []
    for facts in (first, second):
        state = State(("left", "right"))
        state.set_all(facts)
        states.append(state)
    one, two = states
    assert one.join(two).facts() == two.join(one).facts()
    assert set(one.join(two).facts()) == set(one.facts()) & set(two.facts())
    one.ended = Span("t.xei", 0, 1)
    assert one.join(two).facts() == two.join(one).facts() == two.facts()
    assert one.join(two).ended is None
    two.ended = Span("t.xei", 2, 3)
    assert one.join(two).ended is not None


def test_what_is_proved_all_along_is_not_carried() -> None:
    steps = steps_of("keep cap(tube_1) == closed { wait 1 s  pick(object=tube_1, arm=left) }")
    assert [step.keep for step in steps.values()] == [(), ()]


def test_what_is_not_known_is_carried_by_the_steps_around() -> None:
    body = "keep temperature(tube_1) <= 8 degC { wait 1 s  do { wait 2 s } }\nwait 3 s"
    steps = steps_of(body)
    carried = {name: [item.text for item in step.keep] for name, step in steps.items()}
    assert carried == {
        "wait#1": ["temperature(tube_1) <= 8 degC"],
        "wait#2": ["temperature(tube_1) <= 8 degC"],
        "wait#3": [],
    }
    read = steps_of(f"{OD}\nkeep od < 1 {{ wait 1 s }}")["wait#1"]
    assert ([item.text for item in read.keep], read.needs) == (["od < 1"], ("od",))


def test_a_kept_condition_counts_inside_of_procedures_too() -> None:
    take = "procedure take() { pick(object=tube_1, arm=left) }"
    text = f"{take}\n{protocol('keep holding(left) == nothing { take() }')}"
    found = check(text)[1]
    assert [item.code for item in found] == ["XEI0355"]
    assert text[found[0].span.start : found[0].span.end] == "pick(object=tube_1, arm=left)"  # type: ignore[union-attr]


# A program over readings is a list of statements; `run` does what it says, and so must the plan.

_READ = "measure od: Float = read(object=tube_1) in 0 .. 4"
LEVELS = st.sampled_from(["0.5", "1", "1.5", "2.5"])
CONDITIONS = st.builds(lambda op, level: f"od {op} {level}", st.sampled_from(["<", ">", "<=", ">="]), LEVELS)


@dataclass
class Text:
    """A program as text; every wait has a time of its own, by which it is known again."""

    waits: int = 0
    lines: list[str] = field(default_factory=list)

    def wait(self) -> str:
        self.waits += 1
        return f"wait {self.waits} s"


def _program(draw: st.DrawFn, text: Text, depth: int) -> list:
    made: list = []
    for _ in range(draw(st.integers(0, 3))):
        kind = draw(st.sampled_from(["wait", "wait", "if", "repeat", "stop"] if depth else ["wait"]))
        if kind == "wait":
            made.append(("wait", text.wait()))
        elif kind == "if":
            so, otherwise = _program(draw, text, depth - 1), _program(draw, text, depth - 1)
            made.append(("if", draw(CONDITIONS), so, otherwise))
        elif kind == "repeat":
            body, otherwise = _program(draw, text, 0), _program(draw, text, depth - 1)
            made.append(("repeat", draw(st.integers(1, 4)), draw(CONDITIONS), body, otherwise))
        else:
            made.append(("stop",))
            break
    return made


def _written(program: list) -> str:
    parts = []
    for statement in program:
        match statement:
            case ("wait", text):
                parts.append(text)
            case ("if", condition, so, otherwise):
                parts.append(f"if {condition} {{ {_written(so)} }} else {{ {_written(otherwise)} }}")
            case ("repeat", turns, condition, body, otherwise):
                inside = f"{_READ} {_written(body)}"
                parts.append(
                    f"repeat {turns} times until {condition} {{ {inside} }} else {{ {_written(otherwise)} }}"
                )
            case _:
                parts.append('stop "end"')
    return "\n".join(parts)


class Stopped(Exception):
    pass


def _run(program: list, od: float, readings: list[float], did: list[str]) -> None:
    for statement in program:
        match statement:
            case ("wait", text):
                did.append(text.removeprefix("wait "))
            case ("if", condition, so, otherwise):
                _run(so if eval(condition, {"od": od}) else otherwise, od, readings, did)
            case ("repeat", turns, condition, body, otherwise):
                for _ in range(turns):
                    inner = readings.pop(0)
                    _run(body, inner, readings, did)
                    if eval(condition, {"od": inner}):
                        break
                else:
                    _run(otherwise, od, readings, did)
            case _:
                did.append("stop")
                raise Stopped


def _run_plan(plan: SkillPlan, readings: list[float]) -> list[str]:
    known: dict[str, float] = {}
    did: list[str] = []
    for step in plan.steps:
        if not all(_holds(condition.text, condition.needs, known) for condition in step.when):
            continue
        if step.kind == "measure":
            known[step.step_id] = readings.pop(0)
        elif step.kind == "stop":
            return [*did, "stop"]
        else:
            did.append(str(step.arg("duration")))
    return did


def _holds(text: str, needs: tuple[str, ...], known: dict[str, float]) -> bool:
    if not set(needs) <= known.keys():
        return False
    for name in sorted(needs, key=len, reverse=True):
        text = re.sub(rf"(?<![\w.\]#]){re.escape(name)}(?![\w\[.#])", repr(known[name]), text)
    return bool(eval(text, {}))


@given(st.data(), st.lists(st.sampled_from([0.0, 0.7, 1.2, 2.0, 3.0]), min_size=40, max_size=40))
@settings(max_examples=150, deadline=None)
def test_a_plan_does_what_the_protocol_says_whatever_is_read(
    data: st.DataObject, readings: list[float]
) -> None:
    program = _program(data.draw, Text(), 2)
    plan, found = check(protocol(f"{_READ}\n{_written(program)}"))
    assert plan is not None, found
    assert verify_plan(plan) == ()
    left, did = list(readings), []
    with suppress(Stopped):
        _run(program, left.pop(0), left, did)
    assert _run_plan(plan, list(readings)) == did


@pytest.mark.parametrize(
    ("first", "second", "third", "count"),
    [
        ("left", "right", "", 1),
        ("left", "", "right", 1),
        ("left", "right", "right", 1),
        ("left", "left", "right", 1),
        ("left", "left", "left", 0),
        ("stop", "left", "right", 1),
        ("stop", "left", "left", 0),
    ],
)
def test_ways_of_one_choice_with_different_hands_are_one_mistake(
    first: str, second: str, third: str, count: int
) -> None:
    ways = [
        'stop "enough"' if way == "stop" else f"pick(object=tube_1, arm={way})" if way else "wait 1 s"
        for way in (first, second, third)
    ]
    body = (
        "measure od: Float = read(object=tube_2)\n"
        f"if od < 1 {{ {ways[0]} }} else if od < 2 {{ {ways[1]} }} else {{ {ways[2]} }}\nwait 1 s"
    )
    assert codes(body) == ["XEI0353"] * count
