"""Whether a cap is where a step that turns it needs it: on its vessel to open that, off it to close it."""

from __future__ import annotations

from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.caps import Cap
from xei_lang.lower.operations.state_before import CAP, planned_cap
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.checks.rule_facts import Fact, facts_of
from xei_lang.syntax import ast


def refuse_elsewhere(work: Work, cap: Cap) -> None:
    """Give up a step whose state before it is not where the cap is, or whose skill requires the other one
    (XEI0728).
    """
    if work.scene.holder(cap.known.name) is not None:
        return
    actual = "closed" if work.scene.carrier_of(cap.known.name) == cap.vessel.name else "open"
    stated = planned_cap(work, cap.vessel.name)
    if stated not in ("", actual):
        _refuse_stated(work, cap, stated)
    required = _required(work, cap)
    if required is not None and isinstance(required.value, ast.Name) and required.value.id != actual:
        _refuse_done(work, cap, actual, required)


def _required(work: Work, cap: Cap) -> Fact | None:
    """The rule of the skill that says whether the vessel must be open or closed."""
    spec = work.profile.bank.skill(work.step.skill)
    for fact in facts_of(spec.requires if spec else (), "requires"):
        state, argument = fact.key
        if (state, fact.op, work.step.arg(argument)) == (CAP, "==", ObjectRef(cap.vessel.name)):
            return fact
    return None


def _refuse_stated(work: Work, cap: Cap, stated: str) -> None:
    name, where = cap.vessel.name, _where(work, cap)
    refuse(
        "XEI0728",
        f"`{name}` is said to be {stated}, and its cap {where}",
        work.span,
        f"`{cap.known.name}` {where}",
        _since(work, cap),
        help=(f"leave out `given cap({name}) == {stated}`, or correct the cap's `prior`",),
    )


def _refuse_done(work: Work, cap: Cap, actual: str, required: Fact) -> None:
    refuse(
        "XEI0728",
        f"`{cap.vessel.name}` is {actual} already: its cap {_where(work, cap)}",
        work.span,
        f"`{work.step.skill}` requires {required.text} == {'open' if actual == 'closed' else 'closed'}",
        (*_since(work, cap), Label(required.span, "the skill asks for it here")),
        help=("leave this step out",),
    )


def _where(work: Work, cap: Cap) -> str:
    standing = work.scene.standing.get(cap.known.name)
    if work.scene.carrier_of(cap.known.name) == cap.vessel.name:
        return "sits on it"
    return f"lies on `{standing.support}`" if standing else "is not on it"


def _since(work: Work, cap: Cap) -> tuple[Label, ...]:
    standing = work.scene.standing.get(cap.known.name)
    return (standing.since,) if standing and standing.since else ()
