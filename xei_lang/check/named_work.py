"""Which work a step is about: the one that `await`, `stop`, `leave` or `pause` names, if it goes on there.

A work that was started or ended in only one branch of a choice is torn: that is reported where a step names
it after all, or else at the plan's end (`meanwhile`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from xei_lang.check import work_errors
from xei_lang.check.report import replace as replace_text
from xei_lang.check.works import Work
from xei_lang.diagnostics import Fix, Span
from xei_lang.syntax.ast import Await, Leave, Pause, Step, StepRef, Stop

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


@dataclass(slots=True)
class Begun:
    """Every work that was ever started, where each was ended first, and whether an end led nowhere."""

    works: dict[str, Work] = field(default_factory=dict[str, Work])
    ends: dict[str, Span] = field(default_factory=dict[str, Span])
    lost: bool = False


def going_on(expander: Expander, step: Step, node: Await | Stop | Leave | Pause, kind: str) -> Work | None:
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
