"""`keep condition { }`: a condition that holds at every point inside.

It is looked at where the block begins and after each step inside. Where it is known there, it is proved or
refuted; where it is not, the steps around that point carry it, and the run looks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from xei_lang.check.choices import condition
from xei_lang.check.conditions import Asked
from xei_lang.check.plan_builder import Where
from xei_lang.check.scope import Scope
from xei_lang.check.values import Undecided
from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import Condition
from xei_lang.syntax.ast import Keep, Step

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


@dataclass(slots=True, eq=False)
class Kept:
    """A condition that is kept just now: what is open of it at the last point, and whether it is broken."""

    node: Keep
    scope: Scope
    open: Condition | None = None
    broken: bool = False


def keep(expander: Expander, step: Step, node: Keep, scope: Scope, where: Where) -> None:
    """Look at the condition where the block begins, and expand the block while it is kept."""
    kept = Kept(node, scope)
    labels = _look(expander, kept)
    if labels is not None:
        expander.context.reporter.report(
            "XEI0355",
            f"`{expander.context.words(node.condition.span)}` does not hold where it is to be kept",
            node.condition.span,
            "known to be false here already",
            labels=labels,
            help=("change it by a step before this block",),
        )
    expander.keeping.append(kept)
    expander.named_block(step, node.body, scope, where)
    expander.keeping.pop()


def watch(expander: Expander, step: Step, before: int) -> None:
    """A step has ended whose steps in the plan begin at `before`: look at all that is kept."""
    made = len(expander.plan.steps)
    for kept in expander.keeping:
        if kept.broken or made == before or expander.state.ended is not None:
            continue
        earlier = kept.open
        labels = _look(expander, kept)
        if labels is not None:
            _broken(expander, kept, step, labels)
        for found in (earlier, kept.open):
            if found is not None:
                _carry(expander, before, made, found)


def _look(expander: Expander, kept: Kept) -> tuple[Label, ...] | None:
    """Labels of why the condition is false, if it is; else whether it is open is noted."""
    asked, node = Asked(expander), kept.node.condition
    value = condition(expander, node, "`keep`", kept.scope, asked)
    kept.open = None
    if isinstance(value, Undecided):
        kept.open = Condition(value.formula, value.needs, node.span)
    elif not isinstance(value, bool):
        kept.open = Condition(expander.context.words(node.span), (), node.span)
    kept.broken = value is False
    return tuple(asked.found) if kept.broken else None


def _broken(expander: Expander, kept: Kept, step: Step, labels: tuple[Label, ...]) -> None:
    words = expander.context.words(kept.node.condition.span)
    after = tuple(Label(label.span, label.message.replace(" here", " after it")) for label in labels)
    expander.context.reporter.report(
        "XEI0355",
        f"`{words}` is kept here, and this step ends it",
        step.span,
        "does not hold after this step",
        labels=after or (Label(kept.node.condition.span, "kept from here on"),),
        notes=("rule: what is kept holds before, between and after all steps of its block",),
        help=("move the step out of the block",),
        about=words,
    )


def _carry(expander: Expander, start: int, end: int, found: Condition) -> None:
    """Let steps carry a condition that the run must look at."""
    steps = expander.plan.steps
    for index in range(start, end):
        step = steps[index]
        if found not in step.keep:
            needs = tuple(dict.fromkeys((*step.needs, *found.needs)))
            steps[index] = replace(step, keep=(*step.keep, found), needs=needs)
