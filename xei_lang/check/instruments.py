"""Instruments that work on their own: `start`, and `await`, `stop` or `leave`, in which every start ends.

`start` returns at once; the work goes on (`State.works`) until a step ends it. A work that was started or
ended in only one branch of a choice is torn: that is reported where it is ended after all, or else at the
plan's end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from xei_lang.check import work_errors
from xei_lang.check.effects import apply_effects, effects_of, resources_of
from xei_lang.check.plan_builder import Where
from xei_lang.check.remaining import remaining_s
from xei_lang.check.report import replace as replace_text
from xei_lang.check.scope import Scope
from xei_lang.check.touch import held, touches
from xei_lang.check.works import Work
from xei_lang.diagnostics import Fix, Span
from xei_lang.ir.skill_plan import Argument, TimeConstraint
from xei_lang.ir.skill_plan import Step as PlanStep
from xei_lang.profiles.instruments import OWNER, instrument_of, startable, work_duration_s
from xei_lang.profiles.model import SkillSpec
from xei_lang.syntax.ast import Await, Leave, Pause, Start, Step, StepRef, Stop

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander

_KINDS: dict[type, Literal["await", "stop", "leave"]] = {Await: "await", Stop: "stop", Leave: "leave"}


@dataclass(slots=True)
class Begun:
    """Every work that was ever started, where each was ended first, and whether an end led nowhere."""

    works: dict[str, Work] = field(default_factory=dict[str, Work])
    ends: dict[str, Span] = field(default_factory=dict[str, Span])
    lost: bool = False


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
    work = _going_on(expander, step, node, kind)
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
    work = _going_on(expander, step, node, "pause")
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


def _going_on(expander: Expander, step: Step, node: Await | Stop | Leave | Pause, kind: str) -> Work | None:
    """The work that a step is about; None where there is none that goes on here, which is reported."""
    reporter, begun, named = expander.context.reporter, expander.begun, node.step
    work = _meant(expander, named, kind)
    if work is None:
        begun.lost = True
        return None
    now, before = expander.state.works.get(work.step_id), begun.ends.get(work.step_id)
    if now is None or now.left:
        if not work.told:
            work_errors.ended_before(reporter, work, named, kind, before, _away(expander, step))
        return None
    if now.torn:
        work_errors.torn(reporter, now, before, named.span)
        expander.state.works = expander.state.works.drop(work.step_id)
        return None
    if now.paused is not None:
        work_errors.paused(reporter, now, named, kind)
        expander.state.works = expander.state.works.put(replace(now, told=True))
        return None
    return now


def _away(expander: Expander, step: Step) -> Fix | None:
    """A fix that takes away a line with a step alone on it, which happens once and nothing else speaks of."""
    if step.label is not None or step.clauses or isinstance(step.action, Pause):
        return None
    if expander.loops or expander.running:
        return None
    text, span = expander.context.units[step.span.file].source.text, step.span
    begin, stop = text.rfind("\n", 0, span.start), text.find("\n", span.end)
    alone = stop > begin >= 0 and not (text[begin : span.start] + text[span.end : stop]).strip()
    return replace_text(Span(span.file, begin, stop), "") if alone else None


def _meant(expander: Expander, named: StepRef, kind: str) -> Work | None:
    """The work that a reference leads to; None where it leads to none, which is reported."""
    reporter, begun = expander.context.reporter, expander.begun
    if not expander.labels.knows(named):
        module = expander.context.units[named.span.file].module
        if work_errors.too_early(reporter, named, kind, module):
            return None
    found = expander.labels.find(named, reporter)
    if found is None:
        return None
    ids = tuple(dict.fromkeys((*found.firsts, *found.lasts)))
    work = begun.works.get(ids[0]) if len(ids) == 1 else None
    if work is None:
        steps = [step for step in expander.plan.steps if step.step_id in ids]
        words, works = expander.context.words(named.span), tuple(begun.works.values())
        work_errors.not_started(reporter, named, words, kind, steps, works)
    return work


def watch(expander: Expander, step: PlanStep) -> None:
    """Report a step, just added, that touches what a work holds or that uses its instrument.

    A skill that asks the same instrument for a value touches nothing.
    """
    context = expander.context
    skill = context.registry.skills.get(step.skill)
    if skill is None:
        return
    for work in expander.state.works:
        if work.step_id == step.step_id or work.told:
            continue
        if skill.owner == OWNER and work.instrument == _instrument(step, skill):
            if step.kind == "skill" and skill.returns is None:
                work_errors.already(context.reporter, work, work.instrument, step.span)
            continue
        touched = None if work.skill.touchable or work.paused else touches(step, work, context.registry)
        if touched is not None:
            work_errors.touched(context.reporter, work, touched)


def _instrument(step: PlanStep, skill: SkillSpec) -> str:
    return instrument_of(skill, {item.name: item.value for item in step.args}) or skill.name


def all_ended(expander: Expander) -> None:
    """Report what was started and is never ended, once all steps are known."""
    reporter, begun = expander.context.reporter, expander.begun
    for work in expander.state.works:
        if work.told or work.left or expander.plan.full:
            continue
        if work.torn:
            work_errors.torn(reporter, work, begun.ends.get(work.step_id), None)
        elif not begun.lost:
            work_errors.never_ended(reporter, work)
