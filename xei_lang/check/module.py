"""Checking a whole file: its protocol becomes a plan; procedures that nothing calls are checked alone."""

from __future__ import annotations

from xei_lang.check.allow import allowed
from xei_lang.check.binding import CheckOptions
from xei_lang.check.context import Context, make_context
from xei_lang.check.expand import Expander
from xei_lang.check.initial import initial_state
from xei_lang.check.meanwhile import all_ended
from xei_lang.check.paths import check_labels, step_names
from xei_lang.check.plan_builder import PlanBuilder, Where
from xei_lang.check.procedures import check_alone, check_declarations
from xei_lang.check.report import Reporter, listed
from xei_lang.check.scope import Scope
from xei_lang.check.units import Unit
from xei_lang.check.values import Val
from xei_lang.diagnostics import Diagnostics, Label, Source, Span, has_errors
from xei_lang.ir.skill_plan import Fact, SkillPlan
from xei_lang.profiles.model import Profile
from xei_lang.syntax.ast import (
    Given,
    GivenContains,
    ImportTable,
    Module,
    ObjectDecl,
    Param,
    ProfileDecl,
    Protocol,
    Step,
)

LANGUAGE_VERSION = 1


def profile_name(module: Module) -> tuple[str, Span] | None:
    """The profile that the file's protocol names, and where; None where it names none."""
    for protocol in _protocols(module):
        for member in protocol.body:
            if isinstance(member, ProfileDecl):
                return member.name.value, member.name.span
    return None


def is_library(module: Module) -> bool:
    """Whether a file holds procedures and no protocol."""
    return not _protocols(module)


def check_module(
    module: Module, source: Source, profile: Profile, options: CheckOptions
) -> tuple[SkillPlan | None, Diagnostics]:
    """The plan of the file's protocol, with everything that is wrong with the file in the order of its text.

    There is no plan where there are errors, and none for a file of procedures only, which may be free of
    errors. With `options.open_bindings` a plan stands for all that may still be bound: an open object
    appears in it under its name in the protocol, an open parameter with its default or else its lower
    bound.
    """
    context = make_context(module, source, profile, options)
    expander = Expander(context, PlanBuilder(options.max_steps), initial_state(context.registry))
    for unit in context.units.values():
        _check_unit(unit, expander)
    _one_protocol(module, context.reporter)
    own, protocols = context.units[source.file], _protocols(module)
    plan = _protocol(protocols[0], expander, own.scope.child(), profile) if protocols else None
    for procedure in dict.fromkeys(own.procedures[item.name.id] for item in own.own):
        if procedure not in expander.called:
            alone = Expander(context, PlanBuilder(options.max_steps), initial_state(context.registry))
            check_alone(alone, procedure)
            expander.called |= alone.called
    if not expander.stopped:
        context.usage.warn(context.reporter, source.file)
    diagnostics = allowed(module, source, context.reporter.diagnostics)
    return (None if has_errors(diagnostics) else plan), diagnostics


def _protocols(module: Module) -> tuple[Protocol, ...]:
    return tuple(item for item in module.items if isinstance(item, Protocol))


def _check_version(module: Module, expander: Expander) -> None:
    version = module.version
    if version is None or version.value == LANGUAGE_VERSION:
        return
    expander.context.reporter.report(
        "XEI0108",
        f"this compiler does not know version {version.value} of the language",
        version.span,
        f"expected {LANGUAGE_VERSION}",
        help=(f"write `xei {LANGUAGE_VERSION}`, or install a compiler that knows the newer language",),
    )


def _check_unit(unit: Unit, expander: Expander) -> None:
    reporter = expander.context.reporter
    _check_version(unit.module, expander)
    for item in unit.module.items:
        if isinstance(item, ImportTable):
            value = _table(unit, item, expander)
            unit.scope.declare(item.name, "table", value, reporter)
    check_declarations(expander, unit.own)


def _table(unit: Unit, node: ImportTable, expander: Expander) -> Val:
    """A table; the room that reads CSV is entered only where there is one."""
    from xei_lang.check.tables import import_table

    context = expander.context
    return import_table(unit, node, context.options.files, context.registry, context.reporter)


def _one_protocol(module: Module, reporter: Reporter) -> None:
    first, *others = _protocols(module) or (None,)
    for other in others:
        assert first is not None
        reporter.report(
            "XEI0213",
            "this file has two protocols",
            other.name.span,
            "a second protocol",
            labels=(Label(first.name.span, "the first one"),),
            help=("give each protocol a file of its own; what they share can be a `procedure`",),
        )


def _protocol(protocol: Protocol, expander: Expander, scope: Scope, profile: Profile) -> SkillPlan:
    context, plan = expander.context, expander.plan
    check_labels(protocol.body, context.reporter)
    declared = [member for member in protocol.body if isinstance(member, ObjectDecl | Param)]
    context.binder.unknown_names(declared, protocol.name.span)
    where = Where(step_names(protocol.body))
    initial = _expand(protocol, expander, scope, where)
    if plan.full and plan.overflow is None:
        _full(context, plan, protocol)
    _say_what_is_skipped(context, plan)
    return SkillPlan(
        protocol.name.id,
        profile.name,
        tuple(plan.steps),
        initial,
        tuple(plan.constraints),
        tuple(plan.unmapped),
        tuple(plan.notes),
    )


def _expand(protocol: Protocol, expander: Expander, scope: Scope, where: Where) -> tuple[Fact, ...]:
    """Expand the protocol; what is given before its first step is the state that it begins with."""
    first = next(
        (i for i, member in enumerate(protocol.body) if isinstance(member, Step)), len(protocol.body)
    )
    expander.members(protocol.body[:first], scope, where)
    initial = expander.state.facts()
    for member in protocol.body[first:]:
        if isinstance(member, Given | GivenContains):
            expander.context.reporter.report(
                "XEI0212",
                "`given` stands after the first step",
                member.span,
                "says what is so before the protocol begins",
                labels=(Label(protocol.body[first].span, "the first step"),),
                help=("move it before the first step",),
            )
    expander.members(protocol.body[first:], scope, where)
    all_ended(expander)
    return initial


def _say_what_is_skipped(context: Context, plan: PlanBuilder) -> None:
    for span, paths in plan.skipped.items():
        context.reporter.report(
            "XEI0504",
            f"`{context.words(span)}` moves nothing here and is skipped",
            span,
            f"nothing to do in {listed(tuple(paths))}",
            notes=("rule: a transfer of `0 uL` is no step of the plan",),
        )


def _full(context: Context, plan: PlanBuilder, protocol: Protocol) -> None:
    context.reporter.report(
        "XEI0316",
        f"protocol `{protocol.name.id}` has more than {plan.max_steps} steps",
        protocol.name.span,
        f"a plan may have {plan.max_steps} steps",
        help=("divide the work into several protocols",),
    )
