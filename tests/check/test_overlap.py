"""`parallel` and `unordered`: a partial order, and states that do not depend on how it is resolved."""

from __future__ import annotations

from collections.abc import Callable

from hypothesis import given
from hypothesis import strategies as st

from tests.check.checking import check, codes, plan_of, protocol
from xei_lang.diagnostics import Source
from xei_lang.ir.forms import plan_json
from xei_lang.ir.forms.canonical import dumps
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, SkillPlan
from xei_lang.ir.verify_plan import verify_plan

BOTH_ARMS = """
  first: wait 1 s
  swap: parallel {
    {
      pick(object=tube_1)
      put: insert(object=tube_1, into=rack_2.slot("A1"))
    }
    {
      pick(object=tube_2)
      put: insert(object=tube_2, into=rack_2.slot("A2"))
    }
    { }
  } within 5 min
  for t in [tube_1, tube_3] unordered { take: pick(object=t)  place(object=t, on=table) }
  wait 1 s after swap.put
"""


def order(plan: SkillPlan) -> dict[str, tuple[str, ...]]:
    return {step.step_id: step.after for step in plan.steps}


def test_branches_follow_what_was_before_and_not_each_other() -> None:
    plan = plan_of(protocol(BOTH_ARMS))
    assert verify_plan(plan) == ()
    assert order(plan) == {
        "first": (),
        "swap.pick#1": ("first",),
        "swap.put": ("swap.pick#1",),
        "swap.pick#2": ("first",),
        "swap.2.put": ("swap.pick#2",),
        "take[1]": ("swap.put", "swap.2.put"),
        "place#1[1]": ("take[1]",),
        "take[2]": ("swap.put", "swap.2.put"),
        "place#1[2]": ("take[2]",),
        "wait#1": ("place#1[1]", "place#1[2]"),
    }
    assert [step.branch for step in plan.steps][:5] == ["", "swap.1", "swap.1", "swap.2", "swap.2"]
    assert [step.turn for step in plan.steps][5:8] == [(1,), (1,), (2,)]


def test_the_form_of_a_partial_order(golden: Callable[[str, str], None]) -> None:
    text = protocol(BOTH_ARMS)
    form = plan_json.to_json(plan_of(text), {"t.xei": Source("t.xei", text)})
    golden("check/parallel.plan.json", dumps(form))


def test_a_bound_on_a_block_holds_between_all_its_ends() -> None:
    plan = plan_of(protocol("both: parallel { { a: wait 1 s  wait 2 s } { b: wait 3 s } } within 1 min"))
    assert [(item.from_step, item.to_step) for item in plan.constraints] == [
        ("both.a", "both.wait#1"), ("both.a", "both.b"), ("both.b", "both.wait#1"), ("both.b", "both.b"),
    ]  # fmt: skip
    plan = plan_of(protocol("both: parallel { { a: wait 1 s } { b: wait 3 s } }\nwait 1 s after both"))
    assert [(item.from_step, item.to_step) for item in plan.constraints] == [
        ("both.a", "wait#1"), ("both.b", "wait#1"),
    ]  # fmt: skip


def test_what_another_branch_changes_is_not_known_meanwhile() -> None:
    body = """
      parallel {
        { pick(object=tube_1, arm=left)  place(object=tube_1, on=table, arm=left) }
        { wait 1 s }
      }
      wait 2 s
    """
    steps = plan_of(protocol(body)).steps
    known = [{(fact.variable, fact.subject): fact.value for fact in step.state_before} for step in steps]
    assert known[1]["holding", "left"] == ObjectRef("tube_1")
    assert ("holding", "left") not in known[2]
    assert ("at", "tube_1") not in known[2]
    assert known[2]["at", "tube_2"] == PlaceRef("rack_1", "slot", "A2")
    assert known[3]["at", "tube_1"] == PlaceRef("table", "surface", "")
    assert known[3]["holding", "left"] == "nothing"


def test_moving_what_something_stands_on_is_no_branch_of_its_own() -> None:
    body = "given at(tube_3) == {}\nparallel {{ {{ pick(object=tube_1) }} {{ pick(object=tube_3) }} }}"
    assert codes(body.format('rack_2.slot("A1")')) == []
    procedure = "procedure put(t: movable) { pick(object=t) place(object=t, on=table) }\n"
    text = procedure + protocol("parallel { { put(t=tube_1) } { put(t=tube_2) } { put(t=tube_1) } }")
    assert [item.code for item in check(text)[1]] == ["XEI0330"]


def test_branches_that_share_only_what_they_stand_on_are_independent() -> None:
    body = (
        "for t in rack_1.slots[1 .. 2] unordered { pick(object=t) place(object=t, on=table) }\n"
        'parallel { { pick(object=tube_3) place(object=tube_3, on=table.spot("cup")) } { confirm "ok?" } }'
    )
    assert codes(body) == []


TUBES = ("tube_1", "tube_2", "tube_3")
MOVES = st.permutations([f'rack_2.slot("{key}")' for key in ("A1", "A2", "B1", "B2")])


@given(MOVES, st.lists(st.sampled_from(TUBES), min_size=1, max_size=3, unique=True), st.booleans())
def test_independent_branches_end_as_if_one_followed_the_other(
    places: list[str], tubes: list[str], holds: bool
) -> None:
    def branch(index: int) -> str:
        tube = tubes[index]
        put = "" if holds and index == 0 else f"insert(object={tube}, into={places[index]})"
        return f"pick(object={tube})\n{put}\n"

    branches = [branch(index) for index in range(len(tubes))]
    overlapping = plan_of(
        protocol("parallel {" + "".join(f"{{ {body} }}" for body in branches) + "}\nend: wait 1 s")
    )
    backwards = "".join(f"{{ {body} }}" for body in reversed(branches))
    swapped = plan_of(protocol(f"parallel {{ {backwards} }}\nend: wait 1 s"))
    in_order = plan_of(protocol("\n".join(reversed(branches)) + "\nend: wait 1 s"))
    assert verify_plan(overlapping) == ()
    ends = [plan.steps[-1].state_before for plan in (overlapping, swapped, in_order)]
    assert ends[0] == ends[1] == ends[2]
    steps = [sorted(step.skill for step in plan.steps) for plan in (overlapping, in_order)]
    assert steps[0] == steps[1]
