"""Lines of a template that are gone through several times."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from tests.lower.plans import bench, obj, plan, with_skill
from xei_lang.diagnostics import Diagnostics, Span
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.lower import lower
from xei_lang.profiles.model import OperationDefault, Profile, Repeat, TemplateStep
from xei_lang.quantity import Quantity, parse_quantity
from xei_lang.quantity.dimension import NUMBER

HERE = Span("test.yaml", 0, 6)


def blinking(times: str | int, value: str = "3") -> Profile:
    """The bench with a `set_do` that switches twice in each turn, and once at the end."""
    profile, _ = bench()
    known = profile.bank.skill("set_do")
    assert known is not None
    line = known.template[0]
    repeat = Repeat(times, 0, HERE)
    inner = tuple(replace(line, repeat=repeat, path=(0, "repeat", "do", k)) for k in range(2))
    number = parse_quantity(value) if " " in value else Quantity(Fraction(value), NUMBER, "")
    changed = replace(
        known,
        template=(*inner, replace(line, path=(1,))),
        parameters=(OperationDefault("turns", number, HERE),),
    )
    return with_skill(profile, changed)


def switched(profile: Profile) -> tuple[MotionGoalGraph | None, Diagnostics]:
    return lower(plan(("set_do", {"output": "lamp", "value": True})), profile, bench()[1])


@pytest.mark.parametrize(("times", "value"), [(3, "9"), ("turns", "3")])
def test_a_repeat_becomes_its_lines_that_often_and_ids_count_on(times: str | int, value: str) -> None:
    graph, problems = switched(blinking(times, value))
    assert graph is not None, problems
    ids = [goal.id for goal in graph.goals if goal.step_id == "set_do#1"]
    assert ids == [f"set_do#1/{number}" for number in range(1, 8)]


@pytest.mark.parametrize("value", ["0", "2.5", "101", "3 mm"])
def test_a_number_that_is_none_is_refused(value: str) -> None:
    graph, problems = switched(blinking("turns", value))
    assert graph is None
    assert [item.code for item in problems] == ["XEI0702"]


def test_a_repeat_of_an_unknown_number_is_told_at_the_template() -> None:
    _, problems = switched(blinking("trns"))
    assert [item.code for item in problems] == ["XEI0701"]


def test_repeats_side_by_side_are_gone_through_one_after_the_other() -> None:
    profile, world = bench()
    known = profile.bank.skill("set_do")
    assert known is not None
    first, second = Repeat(2, 0, HERE), Repeat(3, 1, HERE)

    def line(value: bool, repeat: Repeat) -> TemplateStep:
        return TemplateStep("set_do", (("output", "output"), ("value", value)), HERE, repeat)

    changed = replace(known, template=(line(True, first), line(False, second)))
    graph, problems = lower(
        plan(("set_do", {"output": "lamp", "value": True})), with_skill(profile, changed), world
    )
    assert graph is not None, problems
    values = [getattr(goal.action, "value", None) for goal in graph.goals if goal.step_id == "set_do#1"]
    assert values == [True, True, False, False, False]


def test_the_times_of_a_call_count() -> None:
    calls = [
        ("pick", {"object": obj("tube_1"), "arm": "right"}),
        (
            "shake",
            {"object": obj("tube_1"), "amplitude": parse_quantity("10 deg"), "times": 4, "arm": "right"},
        ),
    ]
    graph, problems = lower(plan(*calls), *bench())
    assert graph is not None, problems
    assert sum(goal.step_id == "shake#1" for goal in graph.goals) == 3 + 2 * 4
