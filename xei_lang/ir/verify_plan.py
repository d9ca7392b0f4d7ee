"""The verifier of SkillPlan: what must hold of every plan, however it came about.

It runs between passes in tests and on plans that are read from files. It says what is wrong in words and
repairs nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from xei_lang.ir.skill_plan import Fact, SkillPlan, Step, TimeConstraint
from xei_lang.ir.verify_works import work_problems


def verify_plan(plan: SkillPlan) -> tuple[str, ...]:
    """Every problem of the plan, in the order of its steps; empty for a sound one.

    Checked: unique, non-empty step ids; `after` names earlier steps only (so there is no cycle), each once;
    what is needed are earlier steps that measure; a skill has a name and an owner, arguments are named once;
    durations are ordered and not negative; turns count from 1; facts are sorted and said once; what is
    started is ended once; constraints, notes and unmapped requests name steps of the plan.
    """
    problems: list[str] = []
    seen: set[str] = set()
    measuring: set[str] = set()
    for step in plan.steps:
        problems.extend(f"step `{step.step_id}`: {text}" for text in _step(step, seen))
        problems.extend(f"step `{step.step_id}`: {text}" for text in _needs(step, measuring))
        seen.add(step.step_id)
        if step.kind == "measure":
            measuring.add(step.step_id)
    problems.extend(work_problems(plan.steps))
    problems.extend(f"initial state: {text}" for text in _facts(plan.initial_state))
    for constraint in plan.constraints:
        problems.extend(_constraint(constraint, seen))
    for request in (*plan.unmapped_requests, *plan.safety_notes):
        if request.after_step is not None and request.after_step not in seen:
            problems.append(f"`{request.text}` stands after the unknown step `{request.after_step}`")
    return tuple(problems)


def _step(step: Step, seen: set[str]) -> Iterator[str]:
    if not step.step_id:
        yield "its id is empty"
    if step.step_id in seen:
        yield "its id is used before"
    yield from (f"`{name}` is listed twice in `after`" for name in _repeated(step.after))
    yield from (f"is after `{name}`, which is no earlier step" for name in step.after if name not in seen)
    if (step.kind in ("skill", "start", "measure")) != bool(step.skill):
        yield f"is of kind `{step.kind}` with the skill `{step.skill}`"
    if step.skill and not step.owner:
        yield "its skill has no owner"
    yield from (f"has the argument `{name}` twice" for name in _repeated(item.name for item in step.args))
    low, high = step.duration_s
    if not 0.0 <= low <= high or math.isinf(low):
        yield f"its duration {low} .. {high} s is no interval"
    if any(number < 1 for number in step.turn):
        yield f"its turns {step.turn} do not count from 1"
    if list(step.resources) != sorted(set(step.resources)):
        yield "its resources are not sorted"
    yield from _facts(step.state_before)


def _needs(step: Step, measuring: set[str]) -> Iterator[str]:
    yield from (
        f"needs `{name}`, which is no earlier measurement" for name in step.needs if name not in measuring
    )
    named = {name for condition in (*step.when, *step.keep) for name in condition.needs}
    yield from (
        f"has a condition on `{name}`, which it does not need" for name in sorted(named - set(step.needs))
    )


def _facts(facts: tuple[Fact, ...]) -> Iterator[str]:
    keys = [(fact.variable, fact.subject) for fact in facts]
    if keys != sorted(keys):
        yield "its facts are not sorted"
    if len(set(facts)) != len(facts):
        yield "a fact is said twice"


def _constraint(constraint: TimeConstraint, known: set[str]) -> Iterator[str]:
    ends = f"constraint from `{constraint.from_step}` to `{constraint.to_step}`"
    yield from (
        f"{ends}: there is no step `{name}`"
        for name in (constraint.from_step, constraint.to_step)
        if name not in known
    )
    if not constraint.lower_s <= constraint.upper_s or math.isinf(constraint.lower_s):
        yield f"{ends}: {constraint.lower_s} .. {constraint.upper_s} s is no interval"


def _repeated(names: Iterable[str]) -> list[str]:
    seen: set[str] = set()
    again: list[str] = []
    for name in names:
        if name in seen:
            again.append(name)
        seen.add(name)
    return again
