"""From statements to steps: order, paths, loops, choices, procedures, bounds."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import check, codes, ids, parser, plan_of, profile, protocol
from xei_lang.check import CheckOptions, check_module, profile_name
from xei_lang.diagnostics import Source
from xei_lang.ir.verify_plan import verify_plan
from xei_lang.quantity import quantity


def test_steps_follow_each_other_in_the_order_of_the_text() -> None:
    plan = plan_of(protocol("pick(object=tube_1)\nwait 5 s\nplace(object=tube_1, on=table)"))
    assert [(step.step_id, step.after) for step in plan.steps] == [
        ("pick#1", ()),
        ("wait#1", ("pick#1",)),
        ("place#1", ("wait#1",)),
    ]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("a: wait 1 s\nwait 1 s\nwait 1 s", ["a", "wait#1", "wait#2"]),
        ("for i in 1 .. 2 { a: wait 1 s }", ["a[1]", "a[2]"]),
        ("for i in 1 .. 2 { wait 1 s }", ["wait#1[1]", "wait#1[2]"]),
        ("repeat 2 times { for i in 1 .. 2 { a: wait 1 s } }", ["a[1][1]", "a[1][2]", "a[2][1]", "a[2][2]"]),
        ("wash: repeat 2 times { a: wait 1 s }", ["wash[1].a", "wash[2].a"]),
        ("repeat 2 times { wash: repeat 2 times { wait 1 s } }", [
            "wash[1][1].wait#1", "wash[1][2].wait#1", "wash[2][1].wait#1", "wash[2][2].wait#1"]),
        ("b: do { a: wait 1 s }\ndo { c: wait 1 s }", ["b.a", "c"]),
        ("for i in [1] { a: wait 1 s }\nfor i in [1] { a: wait 1 s }", ["a[1]", "for#2.a[1]"]),
        ("for i in 1 .. 2 { if i == 1 { a: wait 1 s } else { a: wait 2 s } }", ["a[1]", "a[2]"]),
    ],
)  # fmt: skip
def test_paths(body: str, expected: list[str]) -> None:
    assert ids(body) == expected


PROCEDURES = """
procedure fill(tube: liquid_container, v: Volume = 1 mL in 1 mL .. 5 mL) {
  take: pick(object=cup_1, arm=left)
  pour(source=cup_1, target=tube, volume=v)
}
"""


def test_a_procedure_is_inlined_under_the_path_of_its_call() -> None:
    body = "first: fill(tube=tube_1, v=2 mL)\nfill(tube=tube_2)\nfor t in [tube_3] { each: fill(tube=t) }"
    plan = plan_of(PROCEDURES + protocol(body + "\nwait 1 s after first.take\nwait 1 s after each[1].take"))
    assert [step.step_id for step in plan.steps][:6] == [
        "first.take", "first.pour#1", "fill#1.take", "fill#1.pour#1", "each[1].take", "each[1].pour#1",
    ]  # fmt: skip
    assert [step.arg("volume") for step in plan.steps if step.skill == "pour"] == [
        quantity(2, "mL"), quantity(1, "mL"), quantity(1, "mL"),
    ]  # fmt: skip
    assert [call.procedure for call in plan.steps[0].origin] == ["fill"]
    assert [constraint.from_step for constraint in plan.constraints] == ["first.take", "each[1].take"]


def test_a_procedure_that_nothing_calls_is_checked_for_all_that_it_may_be_given() -> None:
    body = "pour(source=tube, target=tube, volume=v)"
    wrong = f"procedure bad(tube: movable, v: Volume in 1 mL .. 90 mL) {{ {body} }}\n"
    found = [item.code for item in check(wrong + protocol("wait 1 s"))[1]]
    assert found == ["XEI0309", "XEI0308"]
    assert check(PROCEDURES)[1] == ()


def test_calls_that_lie_too_deep_in_each_other_are_refused() -> None:
    chain = (
        "".join(f"procedure p{n}() {{ p{n + 1}() }}\n" for n in range(60)) + "procedure p60() { wait 1 s }\n"
    )
    assert [item.code for item in check(chain + protocol("p0()"))[1]] == ["XEI0321"]


def test_a_skill_of_a_part_that_the_robot_lacks_is_refused() -> None:
    lab = profile()
    without = replace(lab, bank=replace(lab.bank, owners=("gripper",)))
    source = Source("t.xei", protocol("pick(object=tube_1)"))
    module, _ = parser().module(source)
    assert module is not None
    plan, found = check_module(module, source, without, CheckOptions())
    assert plan is None
    assert [item.code for item in found] == ["XEI0204"]


def test_the_profile_that_a_protocol_names() -> None:
    source = Source("t.xei", protocol("wait 1 s"))
    module, _ = parser().module(source)
    assert module is not None
    named = profile_name(module)
    assert named is not None
    assert (named[0], source.slice(named[1])) == ("lab", '"lab"')


def test_a_choice_that_is_open_is_checked_on_both_branches() -> None:
    body = """
      param n: Int = 2 in 1 .. 5
      if n > 3 { a: pick(object=tube_1, arm=left) } else { a: pick(object=tube_2, arm=left) }
      wait 1 s
    """
    open_plan = plan_of(protocol(body), open_bindings=True)
    assert [step.step_id for step in open_plan.steps] == ["a", "a~2", "wait#1"]
    assert [[item.text for item in step.when] for step in open_plan.steps] == [["n > 3"], ["not (n > 3)"], []]
    assert open_plan.steps[2].after == ("a", "a~2")
    facts = {(fact.variable, fact.subject) for fact in open_plan.steps[2].state_before}
    assert ("holding", "left") not in facts
    assert ("holding", "right") in facts
    assert [step.arg("object") for step in plan_of(protocol(body)).steps][:1] != [None]
    assert [step.step_id for step in plan_of(protocol(body), params={"n": "5"}).steps] == ["a", "wait#1"]


def test_open_objects_and_parameters_check_and_bound_ones_compile() -> None:
    body = """
      object tube: movable & insert_object
      param v: Volume in 1 mL .. 5 mL
      pick(object=tube)
      insert(object=tube, into=rack_2.slot("A1"))
      pour(source=cup_1, target=tube_1, volume=v * 2)
    """
    assert codes(body, open_bindings=True) == []
    plan = plan_of(protocol(body), bindings={"tube": "tube_2"}, params={"v": "1.5 mL"})
    assert plan.steps[2].arg("volume") == quantity(3, "mL")
    assert codes(body) == ["XEI0206", "XEI0208"]


def test_time_clauses_are_recorded_from_end_to_start() -> None:
    body = """
      a: wait 1 s within 2 s
      b: do { wait 1 s wait 2 s } within 1 min
      wait 1 s after a by 1 s .. 2 s
      wait 1 s within 5 s of b
      wait 1 s after b
    """
    found = plan_of(protocol(body)).constraints
    shown = [(c.from_step, c.from_end, c.to_step, c.to_end, c.lower_s, c.upper_s) for c in found]
    assert shown == [
        ("a", "start", "a", "end", 0.0, 2.0),
        ("b.wait#1", "start", "b.wait#2", "end", 0.0, 60.0),
        ("a", "end", "wait#1", "start", 1.0, 2.0),
        ("b.wait#2", "end", "wait#2", "start", 0.0, 5.0),
        ("b.wait#2", "end", "wait#3", "start", 0.0, math.inf),
    ]


def test_notes_gaps_and_questions_stand_in_their_places() -> None:
    body = """
      unmapped "spin" because "no skill"
      for i in 1 .. 2 { wait 1 s note "hot" }
      confirm "ice?"
      note "end"
    """
    plan = plan_of(protocol(body))
    gaps = [(gap.text, gap.reason, gap.after_step) for gap in plan.unmapped_requests]
    assert gaps == [("spin", "no skill", None)]
    notes = [(note.text, note.after_step) for note in plan.safety_notes]
    assert notes == [("hot", "wait#1[1]"), ("end", "confirm#1")]
    asked = plan.steps[2]
    assert (asked.kind, asked.owner, asked.resources) == ("confirm", "person", ("person",))


def test_resources_come_from_the_template() -> None:
    body = "pick(object=tube_1, arm=left)\nplace(object=tube_1, on=table)\nnav_to(station=bench)"
    assert [step.resources for step in plan_of(protocol(body)).steps] == [
        ("left_arm", "left_gripper"),
        ("either_arm", "either_gripper"),
        ("base", "left_arm", "right_arm"),
    ]


sizes = st.lists(st.integers(0, 4), min_size=1, max_size=3)


@given(sizes)
@settings(max_examples=40, deadline=None)
def test_nested_loops_make_the_product_of_their_turns(turns: list[int]) -> None:
    heads = "".join(f"for i{n} in 1 .. {count} {{\n" for n, count in enumerate(turns))
    plan = plan_of(protocol(f"{heads} a: wait 1 s {'}' * len(turns)}"))
    assert len(plan.steps) == math.prod(turns)
    assert verify_plan(plan) == ()


@pytest.mark.parametrize(
    "body",
    [
        "repeat 1000000000 times { wait 1 s }",
        "for i in 1 .. 1000000000 { wait 1 s }",
        "for i in 0 mL .. 5 mL step 0.000000001 nL { wait 1 s }",
        "for i in 1 .. 99999 { for j in 1 .. 99999 { for k in 1 .. 99999 { wait 1 s } } }",
        "let xs = [i for i in 1 .. 1000000000]\nwait 1 s",
        "let xs = [len([j for j in 1 .. 9999]) for i in 1 .. 9999]\nwait 1 s",
        "repeat 9999 times { repeat 9999 times { let x = 1 } }",
        "for i in 1 .. 9999 { let x = [j for j in 1 .. 9999] }",
    ],
)
def test_too_many_steps_are_refused_before_they_are_made(body: str) -> None:
    found = [code for code in codes(body, max_steps=10_000) if code != "XEI0501"]
    assert found == ["XEI0316"]


def test_the_bound_counts_what_turns_really_make() -> None:
    uneven = "for i in 1 .. 20 { if i == 1 { repeat 30 times { wait 1 s } } }\n"
    assert codes(uneven, max_steps=30) == []
    assert codes(uneven + "wait 1 s", max_steps=30) == ["XEI0316"]
    assert codes("repeat 30 times { wait 1 s }", max_steps=30) == []
    assert codes("wait 1 s\n" * 31, max_steps=30) == ["XEI0316"]


def test_one_mistake_in_a_loop_is_said_once() -> None:
    assert codes("for i in 1 .. 50 { pick(object=tube_9) pick(object=table) }") == ["XEI0202", "XEI0309"]


def test_numbers_do_not_grow_without_bound() -> None:
    squares = "let x0 = 12345\n" + "".join(f"let x{n + 1} = x{n} * x{n}\n" for n in range(60))
    assert codes(f"{squares} wait x60 * 1 s") == ["XEI0312"]
