"""`measure od: Float = read(object=cuvette) in 0.05 .. 2.0`: a value that only the run will know.

For the checker it is the interval of its limits, which must fit wherever it is used. The plan carries the
limits with the step, so that a reading outside of them stops the run.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check import arithmetic
from xei_lang.check.declared import declared_expectation
from xei_lang.check.expectation import Expectation
from xei_lang.check.perform import perform
from xei_lang.check.plan_builder import Where
from xei_lang.check.report import listed
from xei_lang.check.scope import Scope
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, Numeric, Poison, Val, number, to_plan
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.skill_plan import Argument, Value
from xei_lang.profiles.model import ReturnSpec, SkillSpec
from xei_lang.quantity import TYPE_DIMENSIONS
from xei_lang.syntax.ast import Measure, Step

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander

LOWER, UPPER = "reading.lower", "reading.upper"
"""Names of the arguments that hold the limits; no argument of a skill has a dot in its name."""

_NUMBERS = ("Int", "Float")


def measure(expander: Expander, step: Step, node: Measure, scope: Scope, where: Where) -> None:
    """Add the measuring step, and declare the name that its reading has."""
    context = expander.context
    checked = context.calls.check(node.call, scope, expander.state)
    expected = _declared(expander, node)
    limits = _written(expander, node, expected, scope)
    skill = checked.skill if checked is not None else None
    if skill is not None and skill.returns is None:
        _gives_nothing(expander, node, skill)
    if checked is None or expected is None or checked.skill.returns is None or isinstance(limits, Poison):
        scope.declare(node.name, "measurement", POISON, context.reporter)
        return
    returns = checked.skill.returns
    if not _is_of_type(expander, node, expected, returns):
        scope.declare(node.name, "measurement", POISON, context.reporter)
        return
    bounds = _bounds(expander, node, limits, returns)
    before = len(expander.plan.steps)
    if bounds is not None:
        at = node.limits.span if node.limits is not None else returns.span
        source = "call" if node.limits is not None else "default"
        ends = ((LOWER, bounds.lower), (UPPER, bounds.upper))
        also = tuple(
            Argument(name, _typed(end, expected.type), expected.type, source, at) for name, end in ends
        )
        perform(expander, step, checked, where, "measure", also)
    value: Val = POISON
    if bounds is not None and len(expander.plan.steps) > before:
        made = expander.plan.steps[-1].step_id
        value = Interval(bounds.lower, bounds.upper, bounds.nominal, made, (made,))
    scope.declare(node.name, "measurement", value, context.reporter)


def _declared(expander: Expander, node: Measure) -> Expectation | None:
    context = expander.context
    expected = declared_expectation(node.type, f"`{node.name.id}`", context.registry, context.reporter)
    if expected is None or (not expected.lists and expected.type in (*TYPE_DIMENSIONS, *_NUMBERS)):
        return expected
    context.reporter.report(
        "XEI0305",
        f"`{node.name.id}` is measured, so it cannot be {expected.noun}",
        node.type.span,
        "expected a quantity, `Float` or `Int`",
    )
    return None


def _written(
    expander: Expander, node: Measure, expected: Expectation | None, scope: Scope
) -> Interval | Poison | None:
    """The limits as they are written; None without any."""
    if node.limits is None or expected is None:
        return None if node.limits is None else POISON
    return expander.context.binder.limits(node.limits, expected, scope, expander.state)


def _is_of_type(expander: Expander, node: Measure, expected: Expectation, returns: ReturnSpec) -> bool:
    if expected.type == returns.type or (expected.type, returns.type) == ("Float", "Int"):
        return True
    reporter, skill = expander.context.reporter, node.call.callee.id
    given = Expectation("", returns.type).noun
    reporter.report(
        "XEI0305",
        f"`{skill}` gives {given}, but `{node.name.id}` is to be {expected.noun}",
        node.type.span,
        f"expected {returns.type}, found {expected.type}",
        labels=(Label(node.call.callee.span, f"gives {given}"),),
        notes=(reporter.rule(returns.span),),
    )
    return False


def _gives_nothing(expander: Expander, node: Measure, skill: SkillSpec) -> None:
    context = expander.context
    reading = tuple(item.name for item in context.registry.skills.values() if item.returns and item.exposed)
    context.reporter.report(
        "XEI0350",
        f"`{skill.name}` gives nothing that could be measured",
        node.call.callee.span,
        "a skill that only does something",
        notes=(context.reporter.rule(skill.span),),
        help=(f"skills that measure: {listed(reading)}" if reading else "no skill of this robot measures",),
    )


def _bounds(
    expander: Expander, node: Measure, limits: Interval | None, returns: ReturnSpec
) -> Interval | None:
    """Between what a reading must lie: as it is written, else what the skill can give."""
    reporter, low, high = expander.context.reporter, _end(returns.min), _end(returns.max)
    if limits is None:
        if low is not None and high is not None:
            return Interval(low, high, low)
        reporter.report(
            "XEI0351",
            f"nothing says between what `{node.name.id}` lies",
            _end_of(node),
            "expected limits",
            notes=(reporter.rule(returns.span),),
            help=("write what a sound reading can be, as in `in 0.05 .. 2.0`; one outside stops the run",),
        )
        return None
    assert node.limits is not None
    below = low is not None and arithmetic.compare("<", limits.lower, low)
    above = high is not None and arithmetic.compare(">", limits.upper, high)
    if not below and not above:
        return limits
    shown = f"{show(low) if low is not None else '...'} .. {show(high) if high is not None else '...'}"
    reporter.report(
        "XEI0308",
        f"the limits `{show(limits)}` of `{node.name.id}` reach beyond what `{node.call.callee.id}` can give",
        node.limits.span,
        f"expected limits inside of {shown}",
        notes=(reporter.rule(returns.span),),
    )
    return None


def _typed(bound: Numeric, type_: str) -> Value:
    planned = to_plan(bound)
    return float(planned) if type_ == "Float" and isinstance(planned, int) else planned


def _end(bound: Numeric | None) -> Numeric | None:
    return None if bound is None else number(bound)


def _end_of(node: Measure) -> Span:
    return Span(node.call.span.file, node.name.span.start, node.call.span.end)
