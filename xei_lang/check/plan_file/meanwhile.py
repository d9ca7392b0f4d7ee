"""Steps of a plan that touch what an instrument holds while it works, or that use the instrument itself.

A step that nothing puts in order with a `start` is told of by `overlaps`; here are those that follow it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.check.plan_file.precedence import Precedence
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.check.touch import Touch, held, touches
from xei_lang.check.works import Work
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.skill_plan import Step
from xei_lang.ir.verify_works import ENDS
from xei_lang.profiles.instruments import OWNER, instrument_of, startable, work_duration_s
from xei_lang.profiles.model import SkillSpec


@dataclass(frozen=True, slots=True, eq=False)
class _About:
    """A start and, by their places in the order, the steps that end, pause and resume its work."""

    start: int
    ends: list[int]
    pauses: list[int]
    resumes: list[int]


def check_meanwhile(order: Precedence, root: JsonNode, registry: Registry, reporter: Reporter) -> None:
    """Report the first step of each work that disturbs it."""
    spans = {node.span: node.items["step_id"].span for node in root.items["skill_calls"].elements}
    for about in _works(order):
        start = order.steps[about.start]
        skill = registry.skills.get(start.skill)
        if skill is None or not startable(skill) or not about.ends:
            continue  # that it never ends is told of elsewhere
        work = _work(start, about.start, skill, spans)
        for place in _meanwhile(about, order):
            if _disturbs(
                order.steps[place], work, _is_paused(place, about, order), registry, spans, reporter
            ):
                break


def _works(order: Precedence) -> list[_About]:
    found: dict[str, _About] = {}
    for place, step in enumerate(order.steps):
        if step.kind == "start":
            found.setdefault(step.step_id, _About(place, [], [], []))
    for place, step in enumerate(order.steps):
        about = found.get(str(step.arg("step"))) if step.kind in (*ENDS, "pause", "resume") else None
        if about is not None:
            kept = {"pause": about.pauses, "resume": about.resumes}.get(step.kind, about.ends)
            kept.append(place)
    return list(found.values())


def _work(start: Step, index: int, skill: SkillSpec, spans: dict[Span, Span]) -> Work:
    args = {item.name: item.value for item in start.args}
    return Work(
        start.step_id,
        index,
        start.step_id[:80],
        spans.get(start.span, start.span),
        skill,
        instrument_of(skill, args) or skill.name,
        held(skill, args),
        tuple(args.items()),
        work_duration_s(skill, args),
        (),
    )


def _meanwhile(about: _About, order: Precedence) -> Iterator[int]:
    """The steps that follow the start and may come before its end."""
    after_all = -1
    for end in about.ends:
        after_all &= order.later[end] if order.steps[end].kind != "leave" else 0
    left = order.later[about.start] & ~after_all
    while left:
        place = (left & -left).bit_length() - 1
        left &= left - 1
        if order.together(about.start, place) and not _has_ended(place, about, order):
            yield place


def _has_ended(place: int, about: _About, order: Precedence) -> bool:
    ends = [end for end in about.ends if order.together(end, place)]
    done = (order.later[end] >> place & 1 and order.steps[end].kind != "leave" for end in ends)
    return bool(ends) and all(done)


def _is_paused(place: int, about: _About, order: Precedence) -> bool:
    """Whether it stands between a pause and the next resume."""
    before = [pause for pause in about.pauses if order.later[pause] >> place & 1]
    return any(
        order.earlier[resume] >> place & 1
        for pause in before[-1:]
        for resume in about.resumes
        if not any(order.later[pause] >> other & order.later[other] >> resume & 1 for other in about.resumes)
    )


def _disturbs(
    step: Step, work: Work, paused: bool, registry: Registry, spans: dict[Span, Span], reporter: Reporter
) -> bool:
    skill = registry.skills.get(step.skill)
    if skill is None:
        return False
    args = {item.name: item.value for item in step.args}
    if skill.owner == OWNER and work.instrument == (instrument_of(skill, args) or skill.name):
        if skill.returns is not None:
            return False
        _already(step, work, spans, reporter)
        return True
    touch = None if paused or work.skill.touchable else touches(step, work, registry)
    if touch is not None:
        _touched(step, touch, work, spans, reporter)
    return touch is not None


def _already(step: Step, work: Work, spans: dict[Span, Span], reporter: Reporter) -> None:
    reporter.report(
        "XEI0344",
        f"`{work.instrument[:80]}` already works",
        spans.get(step.span, step.span),
        f"`{step.skill}` may begin before {work.words} has ended",
        labels=(Label(work.span, "works since here"),),
        notes=(reporter.rule(work.skill.span),),
        help=(f"let this come after the step that ends {work.words}",),
    )


def _touched(step: Step, touch: Touch, work: Work, spans: dict[Span, Span], reporter: Reporter) -> None:
    rule = work.skill.occupies_span or work.skill.span
    reporter.report(
        "XEI0345",
        f"`{touch.thing}` is touched by `{step.step_id[:80]}` while {work.words} may go on",
        spans.get(touch.span, touch.span),
        touch.how if touch.thing != touch.held else f"is held by {work.words}",
        labels=(Label(work.span, f"`{work.skill.name}` holds `{touch.held}` from here on"),),
        notes=(f"{reporter.rule(rule)}, `{work.skill.name}` is not `touchable` while it works",),
        help=(f"let this come after the step that ends {work.words}, or before the start",),
    )
