"""Volumes along the walk: nothing is lost on the way, and branches that differ leave nothing known."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.check.checking import codes, plan_of, protocol
from xei_lang.check import arithmetic
from xei_lang.check.values import POISON, Interval
from xei_lang.check.volumes import NEVER_SAID, Amount, Volumes
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.quantity import Quantity, quantity

THINGS = ("cup_1", "tube_1", "tube_2", "tube_3")
HERE = Label(Span("t.xei", 0, 1), "here")


def holds(plan: SkillPlan, step: str) -> dict[str, str]:
    """What is known of volumes before a step."""
    facts = next(found for found in plan.steps if found.step_id == step).state_before
    return {fact.subject: str(fact.value) for fact in facts if fact.variable == "volume"}


def amount(number: int) -> Amount:
    return Amount(quantity(number, "mL"), (HERE,))


transfer = st.tuples(st.sampled_from(THINGS), st.sampled_from(THINGS), st.integers(0, 5000))


@settings(deadline=None, max_examples=30)
@given(moves=st.lists(transfer, max_size=8), start=st.lists(st.integers(0, 9000), min_size=4, max_size=4))
def test_transfers_conserve_the_total(moves: list[tuple[str, str, int]], start: list[int]) -> None:
    givens = "".join(
        f"given volume({thing}) == {held} uL\n" for thing, held in zip(THINGS, start, strict=True)
    )
    steps = "".join(f"dose(source={a}, target={b}, volume={v} uL)\n" for a, b, v in moves)
    plan = plan_of(protocol(f"{givens}{steps}end: wait 1 s"))
    expected = dict(zip(THINGS, start, strict=True))
    for source, target, moved in moves:
        expected[source] -= moved
        expected[target] += moved
    assert holds(plan, "end") == {thing: str(quantity(left, "uL")) for thing, left in expected.items()}
    assert sum(expected.values()) == sum(start)
    assert len(plan.steps) == 1 + sum(moved > 0 for _, _, moved in moves)


def at(value: object, where: dict[object, Fraction]) -> object:
    """An open value where each unknown is so far on its way from its lower to its upper end."""
    if not isinstance(value, Interval):
        return value
    base = value.lower
    for _, width in value.shares:
        base -= min(width, 0)  # type: ignore[operator,type-var]
    return base + sum(where[unknown] * width for unknown, width in value.shares)  # type: ignore[operator]


expression = st.recursive(
    st.sampled_from(["v", "w", 2, 3, -1]),
    lambda inner: st.tuples(st.sampled_from("+-*"), inner, inner),
    max_leaves=8,
)


@given(tree=expression, parts=st.tuples(*[st.fractions(0, 1, max_denominator=20)] * 2))
def test_what_open_values_share_is_exact_for_sums_and_enclosed_for_products(
    tree: object, parts: tuple[Fraction, Fraction]
) -> None:
    v, w = arithmetic.open_value(-2, 5, 1), arithmetic.open_value(0, 3, 3)
    where = {v.shares[0][0]: parts[0], w.shares[0][0]: parts[1]}

    def open_of(node: object) -> object:
        if isinstance(node, tuple):
            return arithmetic.combine(node[0], open_of(node[1]), open_of(node[2]))
        return {"v": v, "w": w}.get(node, node)  # type: ignore[call-overload]

    def one_of(node: object) -> object:
        if isinstance(node, tuple):
            return arithmetic.combine(node[0], one_of(node[1]), one_of(node[2]))
        return at(open_of(node), where)

    whole, one = open_of(tree), one_of(tree)
    if not isinstance(whole, Interval):
        assert whole == one
        return
    assert whole.lower <= one <= whole.upper  # type: ignore[operator]
    if all(unknown in where for unknown, _ in whole.shares):
        assert at(whole, where) == one


points = st.tuples(st.integers(-50, 50), st.integers(-50, 50)).map(sorted)


@given(first=points, second=points, op=st.sampled_from("+-*/"), at=st.tuples(*[st.fractions(0, 1)] * 2))
def test_an_interval_encloses_what_its_members_give(
    first: list[int], second: list[int], op: str, at: tuple[Fraction, Fraction]
) -> None:
    left, right = (Interval(low, high, low) for low, high in (first, second))
    a, b = (low + (high - low) * part for (low, high), part in zip((first, second), at, strict=True))
    try:
        whole = arithmetic.combine(op, left, right)
    except ZeroDivisionError:
        assert op == "/" and second[0] <= 0 <= second[1]
        return
    one = arithmetic.combine(op, a, b)
    assert isinstance(whole, Interval)
    assert whole.lower <= one <= whole.upper  # type: ignore[operator]
    assert whole.lower <= whole.nominal <= whole.upper  # type: ignore[operator]


def test_a_vessel_is_filled_up() -> None:
    body = """
      given volume(cup_1) == 50 mL and volume(tube_1) == 20 uL
      let before = volume(tube_1)
      fill: dose(source=cup_1, target=tube_1, volume=50 uL - volume(tube_1))
      again: dose(source=cup_1, target=tube_1, volume=50 uL - volume(tube_1)) within 1 min
      wait before / 1 uL * 1 s
      empty: dose(source=tube_1, target=tube_2, volume=volume(rack_1.slot("A1")))
      end: wait 1 s
    """
    plan = plan_of(protocol(body))
    assert [step.step_id for step in plan.steps] == ["fill", "wait#1", "empty", "end"]
    assert str(plan.steps[0].arg("volume")) == "30 uL"
    assert str(plan.steps[1].arg("duration")) == "20 s"
    assert str(plan.steps[2].arg("volume")) == "50 uL"
    assert plan.constraints == ()
    assert holds(plan, "end") == {"cup_1": "49.97 mL", "tube_1": "0 uL"}
    assert codes(body) == ["XEI0504"]


def test_the_default_of_an_open_parameter_is_what_a_plan_has() -> None:
    body = """
      param v: Volume = 2 mL in 1 mL .. 4 mL
      given volume(cup_1) == 50 mL and volume(tube_1) == 0 mL
      dose(source=cup_1, target=tube_1, volume=v)
      rest: dose(source=cup_1, target=tube_1, volume=5 mL - volume(tube_1))
      back: dose(source=tube_2, target=tube_3, volume=max(1 uL, volume(tube_1)))
      wait volume(tube_1) / 1 mL * 1 s
    """
    plan = plan_of(protocol(body), open_bindings=True)
    assert str(plan.steps[1].arg("volume")) == "3 mL"
    assert str(plan.steps[2].arg("volume")) == "5 mL"
    assert str(plan.steps[3].arg("duration")) == "5 s"
    assert holds(plan, "rest") == {"cup_1": "48 mL", "tube_1": "2 mL"}


def test_all_that_was_poured_in_can_be_poured_out() -> None:
    body = """
      param v: Volume = 2 mL in 1 mL .. 4 mL
      given volume(cup_1) == 50 mL and volume(tube_1) == 0 mL
      dose(source=cup_1, target=tube_1, volume=v)
      dose(source=tube_1, target=cup_1, volume=volume(tube_1))
      dose(source=cup_1, target=tube_1, volume=5 mL - volume(tube_1))
    """
    assert codes(body, open_bindings=True) == []


def test_branches_that_differ_leave_nothing_known() -> None:
    body = """
      param n: Int in 1 .. 3
      given volume(cup_1) == 50 mL and volume(tube_1) == 0 mL and volume(tube_2) == 1 mL
      if n > 2 { dose(source=cup_1, target=tube_1, volume=1 mL) } else { wait 1 s }
      end: dose(source=cup_1, target=tube_1, volume=4 mL - volume(tube_1))
    """
    plan = plan_of(protocol(body), open_bindings=True)
    assert holds(plan, "end") == {"tube_2": "1 mL"}


def test_branches_that_overlap_are_added_up() -> None:
    body = """
      given volume(cup_1) == 50 mL and volume(tube_1) == 0 mL and volume(tube_2) == 5 mL
      given volume(tube_3) == 0 mL
      parallel {
        { dose(source=cup_1, target=tube_1, volume=1 mL - volume(tube_1)) }
        { dose(source=tube_2, target=tube_3, volume=2 mL - volume(tube_3)) }
      }
      end: wait 1 s
    """
    assert holds(plan_of(protocol(body)), "end") == {
        "cup_1": "49 mL",
        "tube_1": "1 mL",
        "tube_2": "3 mL",
        "tube_3": "2 mL",
    }


def test_a_procedure_alone_may_ask_for_any_volume() -> None:
    text = protocol("wait 1 s") + (
        "procedure top(tube: liquid_container, to: Volume) {\n"
        "  dose(source=cup_1, target=tube, volume=to - volume(tube))\n}\n"
    )
    assert plan_of(text).steps[0].kind == "wait"


def test_joining_keeps_what_is_alike() -> None:
    base, other = Volumes(), Volumes()
    base.set("a", amount(1))
    other.set("a", amount(1))
    base.set("b", amount(1))
    other.set("b", amount(2))
    base.set("c", amount(1))
    both = base.join(other)
    assert both.get("a").value == quantity(1, "mL")
    assert both.get("b").value is POISON
    assert both.get("c").labels == (HERE,)
    assert both.get("c").value is POISON
    assert both.get("d") is NEVER_SAID


def test_adopting_takes_what_a_branch_has_set() -> None:
    base = Volumes()
    base.set("a", amount(1))
    base.set("b", amount(1))
    first, second, after = base.copy(), base.copy(), base.copy()
    first.set("a", amount(2))
    second.set("b", amount(3))
    after.adopt(base, first)
    after.adopt(base, second)
    assert first.changed_since(base) == ("a",)
    values = [after.get(name).value for name in "ab"]
    assert values == [quantity(2, "mL"), quantity(3, "mL")]
    assert all(isinstance(value, Quantity) for value in values)


def test_an_amount_remembers_its_last_changes() -> None:
    changed = amount(1)
    for start in range(1, 6):
        changed = changed.then(quantity(start, "mL"), Label(Span("t.xei", start, start + 1), str(start)))
    assert [label.message for label in changed.labels] == ["3", "4", "5"]
    assert changed.then(quantity(9, "mL"), Label(Span("t.xei", 5, 6), "5")).labels == changed.labels
