"""SkillPlan as text for people: what is known at the beginning, then a block a step with what changes."""

from __future__ import annotations

import math
from collections.abc import Iterable

from xei_lang.ir.forms.pose_text import written_pose
from xei_lang.ir.skill_plan import (
    Argument,
    Fact,
    ObjectRef,
    PlaceRef,
    PoseIn,
    RunValue,
    SkillPlan,
    StationRef,
    Step,
    TimeConstraint,
    Value,
)


def to_text(plan: SkillPlan) -> str:
    """The plan. Of each step's state only what differs from the step before it in the text."""
    blocks = [f"protocol {plan.protocol} for {plan.profile}: {_count(len(plan.steps), 'step')}"]
    if plan.initial_state:
        blocks.append("\n".join(["at the beginning", *(f"  {_fact(fact)}" for fact in plan.initial_state)]))
    known = plan.initial_state
    for step in plan.steps:
        blocks.append(_step(step, known))
        known = step.state_before
    remarks = [
        *(_constraint(item) for item in plan.constraints),
        *(
            f'unmapped {_position(item.after_step)}: "{item.text}"{_because(item.reason)}'
            for item in plan.unmapped_requests
        ),
        *(f'note {_position(item.after_step)}: "{item.text}"' for item in plan.safety_notes),
    ]
    if remarks:
        blocks.append("\n".join(remarks))
    return "\n\n".join(blocks) + "\n"


def value_text(value: Value) -> str:  # noqa: PLR0911 one return for each kind of value
    """A value as a protocol would write it: `2 mL`, `rack_1.slot("A1")`, `[a, b]`; texts stand bare."""
    match value:
        case bool():
            return str(value).lower()
        case ObjectRef() | StationRef():
            return value.name
        case PlaceRef():
            return f'{value.object}.{value.kind}("{value.key}")' if value.key else value.object
        case PoseIn():
            return written_pose(value)
        case RunValue():
            return f"{value.formula} ({value_text(value.lower)} .. {value_text(value.upper)})"
        case tuple():
            return f"[{', '.join(value_text(item) for item in value)}]"
        case _:
            return str(value)


def _step(step: Step, known: tuple[Fact, ...]) -> str:
    arguments = ", ".join(_argument(item) for item in step.args)
    after = f" after {', '.join(step.after)}" if step.after else ""
    condition = f" when {' and '.join(item.text for item in step.when)}" if step.when else ""
    start = "start " if step.kind == "start" else ""
    lines = [f"{step.step_id}: {start}{step.skill or step.kind}({arguments}){after}{condition}"]
    by = f"by {step.owner}, " if step.owner else ""
    lines.append(f"  {by}{_duration(step.duration_s)}; uses {', '.join(step.resources) or 'nothing'}")
    lines.extend(f"  known: {_fact(fact)}" for fact in _without(step.state_before, known))
    lines.extend(f"  no longer known: {_fact(fact)}" for fact in _lost(known, step.state_before))
    lines.extend(f"  keeps: {condition.text}" for condition in step.keep)
    lines.extend(f"  inside {call.procedure}" for call in step.origin)
    return "\n".join(lines)


def _argument(item: Argument) -> str:
    shown = f'"{item.value}"' if item.type == "String" else value_text(item.value)
    return f"{item.name}={shown}{' by default' if item.source == 'default' else ''}"


def _duration(bounds_s: tuple[float, float]) -> str:
    lower, upper = bounds_s
    if math.isinf(upper):
        return f"{lower:g} s or longer"
    return f"{lower:g} s" if lower == upper else f"{lower:g} .. {upper:g} s"


def _fact(fact: Fact) -> str:
    return f"{fact.variable}({fact.subject}) == {value_text(fact.value)}"


def _without(facts: Iterable[Fact], others: tuple[Fact, ...]) -> list[Fact]:
    return [fact for fact in facts if fact not in others]


def _lost(before: Iterable[Fact], now: tuple[Fact, ...]) -> list[Fact]:
    """The facts of which nothing is known any more; what has a new value is not among them."""
    still = [(fact.variable, fact.subject) for fact in now]
    return [fact for fact in before if (fact.variable, fact.subject) not in still]


def _constraint(item: TimeConstraint) -> str:
    span = f"{item.from_end} of {item.from_step} to {item.to_end} of {item.to_step}"
    if math.isinf(item.upper_s):
        return f"from {span}: at least {item.lower_s:g} s"
    return f"from {span}: {item.lower_s:g} .. {item.upper_s:g} s"


def _position(after_step: str | None) -> str:
    return f"after {after_step}" if after_step else "at the beginning"


def _because(reason: str) -> str:
    return f", because {reason}" if reason else ""


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
