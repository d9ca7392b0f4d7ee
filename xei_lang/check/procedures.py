"""Procedures, inlined where they are called."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from xei_lang.check.arguments import Signature, match_arguments
from xei_lang.check.budget import CALL
from xei_lang.check.declared import declared_expectation
from xei_lang.check.names import ANY_WORD
from xei_lang.check.paths import check_labels, step_names
from xei_lang.check.plan_builder import PlanBuilder, Where
from xei_lang.check.scope import Scope
from xei_lang.check.types import ANY_ARM
from xei_lang.check.values import POISON, Interval, ObjectValue, Val
from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import Call as Frame
from xei_lang.syntax.ast import Arg, Call, Param, Procedure, Step

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def inline(
    expander: Expander, step: Step, call: Call, procedure: Procedure, *, scope: Scope, where: Where
) -> None:
    """Expand a procedure's body in place of its call, with the arguments as they are at this point."""
    name = procedure.name.id
    expander.called.add(procedure)
    if _too_deep(expander, call, procedure, where):
        return
    if not expander.context.evaluator.budget.spend(CALL, call.span):
        return
    given = match_arguments(call, _signature(procedure), expander.context.reporter)
    if given is None:
        for arg in call.args:
            expander.context.evaluator.value(arg.value, scope, ANY_WORD)
        given = dict[str, Arg]()
    inner = expander.context.units[procedure.span.file].scope.child()
    for formal in procedure.params:
        value = _actual(expander, formal, given, procedure, scope=scope, inner=inner)
        inner.declare(formal.name, "parameter", value, expander.context.reporter)
    frame = Frame(name, call.span)
    below = where.under(f"{where.path(step)}.", step_names(procedure.body))
    below = replace(below, origin=(*where.origin, frame), depth=where.depth + 1)
    outer, expander.labels = expander.labels, expander.labels.hide()
    expander.running.append(procedure)
    with expander.context.reporter.inside(frame):
        expander.members(procedure.body, inner, below)
    expander.running.pop()
    outer.reveal(expander.labels, step.label.id if step.label else None)
    expander.labels = outer


def check_alone(expander: Expander, procedure: Procedure) -> None:
    """Check a procedure that nothing calls, for any arguments that its parameters allow."""
    expander.plan = PlanBuilder(expander.plan.max_steps)
    expander.called.add(procedure)
    expander.running = [procedure]
    expander.alone = True
    inner = expander.context.units[procedure.span.file].scope.child()
    for formal in procedure.params:
        inner.declare(formal.name, "parameter", _any(expander, formal, inner), expander.context.reporter)
    frame = Frame(procedure.name.id, procedure.name.span)
    expander.members(procedure.body, inner, Where(step_names(procedure.body), origin=(frame,)))


def check_declarations(expander: Expander, procedures: tuple[Procedure, ...]) -> None:
    """Report labels that clash, and names that two procedures or a procedure and a skill share."""
    reporter = expander.context.reporter
    first: dict[str, Procedure] = {}
    for procedure in procedures:
        check_labels(procedure.body, reporter)
        name = procedure.name
        before = first.setdefault(name.id, procedure)
        if before is not procedure:
            reporter.report(
                "XEI0209",
                f"procedure `{name.id}` is declared twice",
                name.span,
                "declared again here",
                labels=(Label(before.name.span, "first declared here"),),
            )
        skill = expander.context.registry.skills.get(name.id)
        if skill is not None:
            reporter.report(
                "XEI0209",
                f"procedure `{name.id}` has the name of a skill",
                name.span,
                "a call could mean either",
                notes=(reporter.rule(skill.span),),
                help=("give the procedure another name",),
            )


def _signature(procedure: Procedure) -> Signature:
    formals = tuple(formal.name.id for formal in procedure.params)
    required = tuple(formal.name.id for formal in procedure.params if formal.default is None)
    return Signature("procedure", procedure.name.id, formals, required, None)


def _actual(
    expander: Expander,
    formal: Param,
    given: Mapping[str, Arg],
    procedure: Procedure,
    *,
    scope: Scope,
    inner: Scope,
) -> Val:
    context, name = expander.context, formal.name.id
    what = f"`{name}` of `{procedure.name.id}`"
    expected = declared_expectation(formal.type, what, context.registry, context.reporter)
    arg = given.get(name)
    node = arg.value if arg else formal.default
    if expected is None or node is None:
        return POISON
    words = (*context.registry.arms, ANY_ARM) if expected.type == "Arm" else ()
    value = context.evaluator.value(node, scope if arg else inner, words)
    value = context.types.coerce(value, expected, node, expander.state)
    limits = context.binder.limits(formal.limits, expected, inner, expander.state)
    words_for = "the argument" if arg else "the default"
    return context.binder.inside(value, limits, formal, node.span, words_for)


def _any(expander: Expander, formal: Param, inner: Scope) -> Val:
    """Any value that a parameter allows: its interval, any object of its roles; POISON for what has no
    bounds.
    """
    context = expander.context
    expected = declared_expectation(formal.type, f"`{formal.name.id}`", context.registry, context.reporter)
    if expected is None:
        return POISON
    if formal.default is not None:
        words = (*context.registry.arms, ANY_ARM) if expected.type == "Arm" else ()
        found = context.evaluator.value(formal.default, inner, words)
        context.types.coerce(found, expected, formal.default, expander.state)
    limits = context.binder.limits(formal.limits, expected, inner, expander.state)
    if isinstance(limits, Interval):
        return limits
    if expected.type == "object" and not expected.lists and expected.roles is not None:
        return ObjectValue(formal.name.id, None, expected.roles)
    return POISON


def _too_deep(expander: Expander, call: Call, procedure: Procedure, where: Where) -> bool:
    from xei_lang.check.expand import MAX_DEPTH

    reporter, name = expander.context.reporter, call.callee.id
    running = expander.running
    if procedure in running:
        links = [link.name.id for link in running[running.index(procedure) :]]
        chain = " calls ".join(f"`{link}`" for link in (*links, name))
        reporter.report(
            "XEI0214",
            f"procedure `{name}` calls itself",
            call.callee.span,
            chain,
            help=("a procedure is written out at its call, so it cannot contain itself",),
        )
        return True
    if where.depth >= MAX_DEPTH:
        reporter.report(
            "XEI0321",
            f"calls and blocks lie more than {MAX_DEPTH} deep in each other",
            call.callee.span,
            "this call",
        )
        return True
    return False
