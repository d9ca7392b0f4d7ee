"""Instruments that work on their own: `start`, and `await`, `stop` or `leave`, in which every start ends.

`start` returns at once; the work goes on (`State.works`) until a step ends it. `pause` holds it up for a
block.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

from xei_lang.check import work_errors
from xei_lang.check.effects import apply_effects, effects_of, resources_of
from xei_lang.check.named_work import going_on
from xei_lang.check.plan_builder import Where
from xei_lang.check.remaining import remaining_s
from xei_lang.check.scope import Scope
from xei_lang.check.touch import held
from xei_lang.check.works import Work
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Argument, TimeConstraint
from xei_lang.profiles.instruments import OWNER, instrument_of, startable, work_duration_s
from xei_lang.syntax.ast import Await, Leave, Pause, Start, Step, StepRef, Stop

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander

_KINDS: dict[type, Literal["await", "stop", "leave"]] = {Await: "await", Stop: "stop", Leave: "leave"}


def start(expander: Expander, step: Step, node: Start, scope: Scope, where: Where) -> None:
    """`start label: skill(...)`: a step that takes no time, and a work that goes on."""
    context, plan = expander.context, expander.plan
    if not _may_start(expander, node, scope):
        return
    checked = context.calls.check(node.call, scope, expander.state)
    if checked is None:
        return
    skill, values = checked.skill, checked.values
    facts = expander.state.facts()
    plan.add(
        step,
        "start",
        where,
        facts,
        skill=skill.name,
        owner=skill.owner,
        args=checked.arguments,
        resources=resources_of(skill, values),
    )
    if plan.full:
        return
    work = Work(
        plan.steps[-1].step_id,
        len(plan.steps) - 1,
        step.label.id if step.label else "",
        Span(node.span.file, node.span.start, node.call.callee.span.end),
        skill,
        instrument_of(skill, values) or skill.name,
        held(skill, values),
        tuple(values.items()),
        work_duration_s(skill, values),
        where.origin,
    )
    clash = next((other for other in expander.state.works if other.instrument == work.instrument), None)
    if clash is not None:
        work_errors.already(context.reporter, clash, work.instrument, node.call.callee.span)
        expander.state.works = expander.state.works.put(replace(clash, told=True))
        work = replace(work, told=True)
    else:
        expander.state.works = expander.state.works.put(work)
    expander.begun.works[work.step_id] = work


def _may_start(expander: Expander, node: Start, scope: Scope) -> bool:
    context = expander.context
    skill = context.registry.skills.get(node.call.callee.id)
    if skill is None and context.procedure(node.call.callee) is None:
        return True  # the call itself is wrong, and reported as such
    if skill is not None and (startable(skill) or not skill.exposed):
        return True
    known = tuple(item.name for item in context.registry.skills.values() if startable(item))
    work_errors.not_startable(context.reporter, node.call.callee, skill, known)
    if skill is not None:
        context.calls.check(node.call, scope, expander.state)
    return False


def end(expander: Expander, step: Step, node: Await | Stop | Leave, where: Where) -> None:
    """`await`, `stop`, `leave`: the step that ends a work."""
    kind = _KINDS[type(node)]
    work = going_on(expander, step, node, kind)
    if work is None:
        return
    plan, state = expander.plan, expander.state
    bounds = (0.0, 0.0)
    if kind == "await":
        bounds = remaining_s(work, plan.steps, plan.tails, where.when)
    _add(expander, step, kind, where, work, node.step, bounds)
    if kind == "await":
        own = plan.steps[-1].step_id
        plan.constraints.append(
            TimeConstraint(work.step_id, "end", own, "end", work.duration_s[0], math.inf, node.span)
        )
        apply_effects(effects_of(work.skill), dict(work.args), state)
    expander.begun.ends.setdefault(work.step_id, node.span)
    still = work if kind == "leave" else None
    state.works = state.works.put(replace(still, left=True)) if still else state.works.drop(work.step_id)


def pause(expander: Expander, step: Step, node: Pause, scope: Scope, where: Where) -> None:
    """`pause label { }`: a step `pause`, the block, and a step `resume`, whose id ends in `.resume`."""
    work = going_on(expander, step, node, "pause")
    if work is None:
        expander.named_block(step, node.body, scope, where)
        return
    _add(expander, step, "pause", where, work, node.step, (0.0, 0.0))
    expander.state.works = expander.state.works.put(replace(work, paused=node.span))
    expander.named_block(step, node.body, scope, where)
    after = where.under(f"{where.path(step)}.", {step.span: "resume"})
    after = replace(after, turn=where.turn)
    _add(expander, step, "resume", after, work, node.step, (0.0, 0.0))
    now = expander.state.works.get(work.step_id)
    if now is not None:
        expander.state.works = expander.state.works.put(replace(now, paused=None))


def _add(
    expander: Expander,
    step: Step,
    kind: Literal["await", "stop", "leave", "pause", "resume"],
    where: Where,
    work: Work,
    named: StepRef,
    duration_s: tuple[float, float],
) -> None:
    expander.plan.add(
        step,
        kind,
        where,
        expander.state.facts(),
        owner=OWNER,
        args=(Argument("step", work.step_id, "Step", "call", named.span),),
        duration_s=duration_s,
        resources=resources_of(work.skill, dict(work.args)),
    )
