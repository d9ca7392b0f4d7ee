"""The verifier of plans finds every start that is not ended as it should be."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.check.checking import plan_of, protocol
from xei_lang.ir.skill_plan import Argument, Condition, SkillPlan, Step
from xei_lang.ir.verify_plan import verify_plan

PLAN = plan_of(
    protocol(
        "start warm: heat(block=block_1, to=37 degC, for=10 min)\n pause warm { wait 1 s }\n await warm\n"
        "wait 1 s"
    )
)
START, PAUSE, REST, RESUME, END, LAST = PLAN.steps
OTHER = replace(END, step_id="stop#1", kind="stop", after=(END.step_id,))


def with_steps(*steps: Step) -> SkillPlan:
    return replace(PLAN, steps=steps, constraints=())


def about(step: Step, name: object) -> Step:
    return replace(step, args=(Argument("step", name, "Step", "call", step.span),))  # type: ignore[arg-type]


def test_what_is_ended_once_has_no_problem() -> None:
    assert verify_plan(PLAN) == ()
    late, early = (Condition(text, (), END.span) for text in ("late", "not (late)"))
    one = replace(END, when=(early,))
    other = replace(OTHER, after=(RESUME.step_id,), when=(late,))
    assert verify_plan(with_steps(START, PAUSE, REST, RESUME, one, other)) == ()


@pytest.mark.parametrize(
    ("plan", "words"),
    [
        (with_steps(START, PAUSE, REST, RESUME), "never ended"),
        (with_steps(START, PAUSE, REST, RESUME, END, OTHER), "ended by `await#1` and by `stop#1`"),
        (with_steps(START, PAUSE, REST, replace(END, after=(REST.step_id,))), "not paused and resumed"),
        (with_steps(START, PAUSE, REST, RESUME, replace(END, after=())), "does not follow a start"),
        (with_steps(START, PAUSE, REST, RESUME, about(END, "wait#1")), "does not follow a start"),
        (with_steps(START, PAUSE, REST, RESUME, about(END, 3)), "does not follow a start"),
    ],
)
def test_each_fault_is_found(plan: SkillPlan, words: str) -> None:
    assert any(words in problem for problem in verify_plan(plan)), verify_plan(plan)
