"""Instruments: what a plan says of a start and its end, and which protocols end all that they start."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.check.checking import BENCH, check, codes, plan_of, protocol
from xei_lang.ir.skill_plan import SkillPlan, Step, TimeConstraint
from xei_lang.ir.verify_plan import verify_plan

WARM = "start warm: heat(block=block_1, to=37 degC, for=10 min)"
INTO = 'insert(object=tube_1, into=block_1.slot("A1"))'


def steps(body: str) -> dict[str, Step]:
    plan = plan_of(protocol(body))
    assert verify_plan(plan) == ()
    return {step.step_id: step for step in plan.steps}


def test_a_start_takes_no_time_and_its_await_what_remains() -> None:
    found = steps(f"{WARM}\n wait 1 min\n await warm within 10 min")
    start, end = found["warm"], found["await#1"]
    assert (start.kind, start.skill, start.owner) == ("start", "heat", "instrument")
    assert start.resources == end.resources == ("block_1",)
    assert start.duration_s == (0.0, 0.0)
    assert end.after == ("wait#1",)
    assert end.arg("step") == "warm"
    assert end.duration_s == (540.0, 540.0)


def test_an_await_ends_no_sooner_than_the_work_and_within_its_bound() -> None:
    plan = plan_of(protocol(f"{WARM}\n await warm within 11 min"))
    work, bound = plan.constraints
    span = work.span
    assert work == TimeConstraint("warm", "end", "await#1", "end", 600.0, math.inf, span)
    assert (bound.from_step, bound.to_step, bound.upper_s) == ("await#1", "await#1", 660.0)


def test_a_pause_is_two_steps_around_its_block() -> None:
    found = steps(f"pick(object=tube_1)\n {WARM}\n open: pause warm {{ put: {INTO} }}\n await warm")
    assert [step.kind for step in found.values()] == ["skill", "start", "pause", "skill", "resume", "await"]
    assert list(found)[2:5] == ["open", "open.put", "open.resume"]
    assert found["open.resume"].after == ("open.put",)
    assert found["await#1"].duration_s == (600.0, 600.0)


@pytest.mark.parametrize("kind", ["stop", "leave"])
def test_other_ends_take_no_time(kind: str) -> None:
    found = steps(f"{WARM}\n wait 1 s\n {kind} warm")
    assert found[f"{kind}#1"].kind == kind
    assert found[f"{kind}#1"].duration_s == (0.0, 0.0)


def test_called_without_start_it_is_a_step_of_its_own_length() -> None:
    step = steps("heat(block=block_1, to=37 degC, for=10 min)")["heat#1"]
    assert (step.kind, step.duration_s, step.resources) == ("skill", (600.0, 600.0), ("block_1",))


def test_each_turn_has_its_own_work() -> None:
    body = "for t in [tube_1, tube_2] { start s: shake(object=t)  wait 1 s  await s }"
    assert [step.arg("step") for step in steps(body).values() if step.kind == "await"] == ["s[1]", "s[2]"]


def test_what_a_loop_or_a_procedure_started_is_ended_by_its_path() -> None:
    assert codes("for t in [tube_1] { start s: shake(object=t) }\n await s[1]") == []
    text = protocol("begin: warm()\n await begin.hot")
    text += "procedure warm() {\n start hot: heat(block=block_1, to=40 degC, for=1 min)\n}\n"
    assert [step.arg("step") for step in plan_of(text).steps][1:] == ["begin.hot"]


def test_a_procedure_that_nothing_calls_may_leave_the_end_to_its_caller() -> None:
    text = protocol("wait 1 s")
    assert check(text + f"procedure warm() {{\n {WARM}\n}}\n")[1] == ()
    assert [d.code for d in check(text + "procedure warm() {\n await me\n}\n")[1]] == ["XEI0211"]


def test_a_work_outlives_the_branch_that_started_it() -> None:
    found = steps(f"parallel {{ {{ {WARM} }} {{ wait 20 min }} }}\n await warm")
    assert found["await#1"].after == ("warm", "wait#1")
    assert found["await#1"].duration_s == (0.0, 600.0)


@pytest.mark.parametrize(
    ("body", "found"),
    [
        (f"{WARM}\n pick(object=tube_1)\n {INTO}\n await warm", ["XEI0345"]),
        (f"{WARM}\n pick(object=tube_1)\n pause warm {{ {INTO} }}\n await warm", []),
        (f"pick(object=tube_1)\n {INTO}\n {WARM}\n pick(object=tube_1)\n await warm", ["XEI0345"]),
        (f"{WARM}\n await warm\n pick(object=tube_1)\n {INTO}", []),
        (f"{WARM}\n stop warm\n pick(object=tube_1)\n {INTO}", []),
        (f"{WARM}\n leave warm\n pick(object=tube_1)\n {INTO}", ["XEI0345"]),
        ("start s: shake(object=tube_1)\n pick(object=tube_1)\n await s", []),
        (f"{WARM}\n pick(object=tube_1)\n place(object=tube_1, on=table)\n await warm", []),
        (f"{WARM}\n pick(object=cup_1)\n place(object=cup_1, on=block_1)\n await warm", ["XEI0345"]),
        (f"{WARM}\n start s: shake(object=tube_1)\n await s\n await warm", []),
        (f"{WARM}\n parallel {{ {{ await warm }} {{ pick(object=tube_1)  {INTO} }} }}", ["XEI0345"]),
        (f"parallel {{ {{ {WARM}  await warm }} {{ pick(object=tube_1)  {INTO} }} }}", ["XEI0330"]),
        (f"parallel {{ {{ pause warm {{ wait 1 s }} }} {{ wait 1 s }} }}\n {WARM}\n await warm", ["XEI0343"]),
        (f"{WARM}\n pause warm {{ pause warm {{ wait 1 s }} }}\n await warm", ["XEI0347"]),
    ],
)
def test_what_is_held_is_not_touched(body: str, found: list[str]) -> None:
    assert codes(body) == found


def test_asking_the_instrument_touches_nothing() -> None:
    text = (
        'protocol p {\n  profile "openarm_bench"\n'
        "  start warm: heat(block=heater_block, to=37 degC, for=10 min)\n"
        "  measure t: Temperature = read_temperature(device=heater_block)\n  await warm\n}\n"
    )
    assert [d.code for d in check(text, BENCH)[1] if d.code.startswith("XEI034")] == []


# Every way through a protocol, against the checker.


@dataclass(frozen=True)
class Choice:
    then: tuple[object, ...]
    otherwise: tuple[object, ...]


ENDS = st.tuples(st.sampled_from(["await", "stop", "leave"]), st.sampled_from("aaab"))
LEAF = st.one_of(st.tuples(st.just("start"), st.sampled_from("aab")), ENDS)
BLOCK = st.recursive(
    st.lists(LEAF, max_size=3).map(tuple),
    lambda inner: st.lists(st.one_of(LEAF, st.builds(Choice, inner, inner)), max_size=4).map(tuple),
    max_leaves=8,
)
TUBES = {"a": "tube_1", "b": "tube_2"}


def text_of(block: tuple[object, ...], params: list[str]) -> str:
    lines: list[str] = []
    for item in block:
        if isinstance(item, Choice):
            name = f"p{len(params)}"
            params.append(name)
            then, otherwise = text_of(item.then, params), text_of(item.otherwise, params)
            lines.append(f"if {name} {{\n{then}\n}} else {{\n{otherwise}\n}}")
        else:
            word, label = item  # type: ignore[misc]
            lines.append(
                f"start {label}: shake(object={TUBES[label]})" if word == "start" else f"{word} {label}"
            )
    return "\n".join(lines)


def ways(block: tuple[object, ...]) -> list[tuple[tuple[str, str], ...]]:
    parts = [
        [*ways(item.then), *ways(item.otherwise)] if isinstance(item, Choice) else [(item,)] for item in block
    ]
    return [tuple(step for part in way for step in part) for way in product(*parts)]


def is_sound(way: tuple[tuple[str, str], ...]) -> bool:
    running: set[str] = set()
    for word, label in way:
        if word == "start":
            running.add(label)
        elif label in running:
            running.remove(label)
        else:
            return False
    return not running


@example((Choice((("start", "a"),), ()), ("await", "a")))
@example((("start", "a"), Choice((("await", "a"),), ()), ("await", "a")))
@example((("start", "a"), Choice((("await", "a"),), (("stop", "a"),))))
@settings(max_examples=200)
@given(BLOCK)
def test_accepted_is_what_ends_each_start_once_on_every_way(block: tuple[object, ...]) -> None:
    params: list[str] = []
    body = text_of(block, params)
    if any(body.count(f"start {label}:") > 1 for label in "ab"):
        return
    text = protocol("\n".join(f"param {name}: Bool" for name in params) + "\n" + body)
    plan, found = check(text, open_bindings=True)
    sound = all(is_sound(way) for way in ways(block))
    assert (plan is not None) == sound, [item.message for item in found]
    assert plan is None or verify_plan(plan) == ()


# What can remain of a work, against plans that are carried out.

PIECES = st.recursive(
    st.sampled_from(
        ["wait 3 s", "wait 40 s", "spin(object=tube_3, force=200 xg, for=5 s)", "nav_to(station=bench)"]
    ),
    lambda inner: st.one_of(
        st.tuples(inner, inner).map("\n".join),
        inner.map(lambda piece: f"pause warm {{ {piece} }}" if "pause" not in piece else piece),
        st.tuples(inner, inner).map(lambda two: f"if late {{ {two[0]} }} else {{ {two[1]} }}"),
        st.tuples(inner, inner).map(
            lambda two: (
                f"parallel {{ {{ {two[0]} }} {{ {two[1]} }} }}"
                if not any(word in two[0] + two[1] for word in ("spin", "nav_to", "pause"))
                else "\n".join(two)
            )
        ),
    ),
    max_leaves=6,
)


def carried_out(plan: SkillPlan, fraction: float, late: bool) -> tuple[float, tuple[float, float]]:
    """How long the last step has to wait when each step takes this fraction of its range, and its bounds."""
    ends: dict[str, float] = {}
    worked, since = 0.0, 0.0
    for step in plan.steps:
        begin = max((ends[name] for name in step.after), default=0.0)
        happens = all(("not" in str(getattr(c, "text", c))) != late for c in step.when)
        if step.kind == "pause" and happens:
            worked, since = worked + begin - since, math.nan
        elif step.kind in ("start", "resume") and happens:
            since = begin
        elif step.kind == "await":
            return max(0.0, 60.0 - worked - (begin - since)), step.duration_s
        low, high = step.duration_s
        ends[step.step_id] = begin + (low + fraction * (high - low) if happens else 0.0)
    raise AssertionError("nothing is awaited")


@given(PIECES, st.floats(0.0, 1.0), st.booleans())
def test_what_remains_lies_between_its_bounds(piece: str, fraction: float, late: bool) -> None:
    body = f"param late: Bool\nstart warm: heat(block=block_1, to=37 degC, for=1 min)\n{piece}\nawait warm"
    plan, found = check(protocol(body), open_bindings=True)
    assert plan is not None, [item.message for item in found]
    waited, (low, high) = carried_out(plan, fraction, late)
    assert low - 1e-9 <= waited <= high + 1e-9
