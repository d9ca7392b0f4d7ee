"""The plan's verifier finds each fault that is put into a sound plan."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.check.checking import plan_of
from tests.check.test_properties import RICH
from xei_lang.ir.skill_plan import Argument, Condition, Fact, SkillPlan, Step, TimeConstraint
from xei_lang.ir.verify_plan import verify_plan

PLAN = plan_of(RICH)
FIRST, SECOND = PLAN.steps[:2]
SPAN = FIRST.span
BOUND = TimeConstraint(FIRST.step_id, "end", SECOND.step_id, "start", 0.0, 1.0, SPAN)
TWICE = Argument("object", 1, "Int", "call", SPAN)


def with_second(**changes: object) -> SkillPlan:
    changed: Step = replace(SECOND, **changes)  # type: ignore[arg-type]
    return replace(PLAN, steps=(FIRST, changed, *PLAN.steps[2:]))


def test_a_sound_plan_has_no_problems() -> None:
    assert verify_plan(PLAN) == ()


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (with_second(step_id=FIRST.step_id), "its id is used before"),
        (replace(PLAN, steps=(replace(FIRST, step_id=""), *PLAN.steps[1:])), "its id is empty"),
        (with_second(after=(PLAN.steps[4].step_id,)), "which is no earlier step"),
        (with_second(after=(SECOND.step_id,)), "which is no earlier step"),
        (with_second(after=(FIRST.step_id, FIRST.step_id)), "listed twice"),
        (with_second(skill=""), "of kind `skill` with the skill ``"),
        (with_second(kind="wait"), "of kind `wait`"),
        (with_second(owner=""), "no owner"),
        (with_second(args=(TWICE, TWICE)), "has the argument `object` twice"),
        (with_second(duration_s=(5.0, 1.0)), "is no interval"),
        (with_second(duration_s=(-1.0, 1.0)), "is no interval"),
        (with_second(needs=(FIRST.step_id,)), "which is no earlier measurement"),
        (with_second(keep=(Condition("od < 1", ("od",), SPAN),)), "which it does not need"),
        (with_second(turn=(0,)), "do not count from 1"),
        (with_second(resources=("right_arm", "left_arm")), "not sorted"),
        (with_second(state_before=SECOND.state_before[::-1]), "facts are not sorted"),
        (with_second(state_before=(Fact("a", "b", 1),) * 2), "said twice"),
        (replace(PLAN, constraints=(replace(BOUND, to_step="nowhere"),)), "there is no step `nowhere`"),
        (replace(PLAN, constraints=(replace(BOUND, lower_s=2.0),)), "is no interval"),
        (replace(PLAN, safety_notes=(replace(PLAN.safety_notes[0], after_step="x"),)), "unknown step `x`"),
    ],
)  # fmt: skip
def test_each_fault_is_found(plan: SkillPlan, words: str) -> None:
    assert any(words in problem for problem in verify_plan(plan)), verify_plan(plan)
