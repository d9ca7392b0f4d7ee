"""Steps that are done as they stand: a skill, a wait, a question; with what they bring about."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from xei_lang.check import procedures
from xei_lang.check.calls import CheckedCall
from xei_lang.check.effects import apply_effects, resources_of
from xei_lang.check.plan_builder import Where
from xei_lang.check.run_time import needs_of
from xei_lang.check.scope import Scope
from xei_lang.check.transfers import apply_transfers
from xei_lang.check.values import Interval, nominal, to_plan
from xei_lang.ir.skill_plan import Argument, StepKind
from xei_lang.profiles.instruments import OWNER, instrument_of, work_duration_s
from xei_lang.quantity import Quantity
from xei_lang.syntax.ast import Call, Confirm, Step, Wait

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def call_skill(expander: Expander, step: Step, call: Call, scope: Scope, where: Where) -> None:
    """Add the step of a call of a skill, or the steps of a procedure's body in its place."""
    name = call.callee.id
    procedure = expander.context.procedure(call.callee)
    if procedure is not None and name not in expander.context.registry.skills:
        procedures.inline(expander, step, call, procedure, scope=scope, where=where)
        return
    checked = expander.context.calls.check(call, scope, expander.state)
    if checked is None:
        return
    if checked.moves_nothing:
        expander.plan.skip(call.callee.span, where.path(step))
        return
    perform(expander, step, checked, where)


def perform(
    expander: Expander,
    step: Step,
    checked: CheckedCall,
    where: Where,
    kind: StepKind = "skill",
    also: tuple[Argument, ...] = (),
) -> None:
    """Add the step of a skill, with arguments besides the skill's own, and do what it brings about."""
    values = checked.values
    skill = checked.skill
    key = (
        skill.name,
        instrument_of(skill, values),
        *(str(values[spec.name]) for spec in skill.args if spec.type == "Arm" and spec.name in values),
    )
    if key not in expander.resources:
        expander.resources[key] = resources_of(skill, values)
    expander.plan.add(
        step,
        kind,
        where,
        expander.state.facts(),
        skill=skill.name,
        owner=skill.owner,
        args=(*checked.arguments, *also),
        duration_s=work_duration_s(skill, values) if skill.owner == OWNER else skill.duration_s,
        resources=expander.resources[key],
    )
    apply_effects(checked.effects, values, expander.state)
    if checked.transfers:
        apply_transfers(checked.transfers, checked.given, expander.state, skill.name, checked.span)


def wait(expander: Expander, step: Step, action: Wait, scope: Scope, where: Where) -> None:
    """Add a step of waiting, as long as is known of it."""
    value = expander.context.clauses.time(action.duration, "`wait`", scope, expander.state)
    value = value if needs_of(value) else nominal(value)
    low, high = (value.lower, value.upper) if isinstance(value, Interval) else (value, value)
    if not isinstance(low, Quantity) or not isinstance(high, Quantity):
        return
    argument = Argument("duration", to_plan(value), "Time", "call", action.duration.span)
    expander.plan.add(
        step, "wait", where, expander.state.facts(), args=(argument,), duration_s=(low.si, high.si)
    )


def confirm(expander: Expander, step: Step, action: Confirm, where: Where) -> None:
    """Add a step that asks a person, however long that takes."""
    text = Argument("text", action.text.value, "String", "call", action.text.span)
    expander.plan.add(
        step,
        "confirm",
        where,
        expander.state.facts(),
        owner="person",
        args=(text,),
        duration_s=(0.0, math.inf),
        resources=("person",),
    )
