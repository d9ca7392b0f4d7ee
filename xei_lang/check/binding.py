"""What a protocol leaves open and the command line fills in: parameters and objects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from xei_lang.check import arithmetic
from xei_lang.check.command_line import read_value
from xei_lang.check.declared import declared_expectation, known_roles
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed, meant
from xei_lang.check.roles import candidates, fits, text, unmet
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import ANY_ARM, Types
from xei_lang.check.values import (
    POISON,
    Interval,
    ObjectValue,
    Poison,
    Val,
    show,
)
from xei_lang.diagnostics import Diagnostics, Label, Source, Sources, Span, did_you_mean
from xei_lang.quantity import DimensionError, QuantityError
from xei_lang.syntax.ast import Module, Name, ObjectDecl, Param, Range, StringLit
from xei_lang.syntax.loading import Files

_NOTHING: Mapping[str, str] = MappingProxyType({})


@dataclass(frozen=True, slots=True, eq=False)
class CheckOptions:
    """How to check.

    `bindings` gives objects (`--bind rack=rack_1`), `params` the text of values (`--param volume="2 mL"`).
    With `open_bindings`, as in `xei check`, an object without binding is any object with its roles, and a
    ranged parameter is its whole interval. `sources` are the texts of the profile's files, so that notes can
    name a rule's line, `files` are those that imports may name; without them every import is an error.
    `parse` reads imported texts, and is `parse_module` unless somebody keeps a parser.
    """

    bindings: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    params: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    open_bindings: bool = False
    max_steps: int = 100_000
    sources: Sources = field(default_factory=dict[str, "object"])  # type: ignore[assignment]
    files: Files | None = None
    parse: Callable[[Source], tuple[Module | None, Diagnostics]] | None = None


class Binder:
    """Gives declared parameters and objects their values."""

    def __init__(
        self,
        registry: Registry,
        evaluator: Evaluator,
        types: Types,
        reporter: Reporter,
        options: CheckOptions,
    ) -> None:
        self._registry = registry
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter
        self._options = options

    def unknown_names(self, declared: Iterable[ObjectDecl | Param], where: Span) -> None:
        """Report bindings and parameters of the command line that the protocol does not declare."""
        known = tuple(declared)
        objects = tuple(item.name.id for item in known if isinstance(item, ObjectDecl))
        params = tuple(item.name.id for item in known if isinstance(item, Param))
        for flag, given, names in (
            ("bind", self._options.bindings, objects),
            ("param", self._options.params, params),
        ):
            for name in sorted(given.keys() - set(names)):
                noun = "object" if flag == "bind" else "parameter"
                self._reporter.report(
                    "XEI0207",
                    f"`--{flag} {name}={given[name]}` names no {noun} of this protocol",
                    where,
                    f"declares the {noun}s {listed(names)}" if names else f"declares no {noun}s",
                    help=meant(did_you_mean(name, names)),
                    about=f"{flag} {name}",
                )

    def object(self, node: ObjectDecl, scope: Scope) -> None:
        """Declare an object under its name in the protocol."""
        scope.declare(node.name, "object", self._object(node, scope), self._reporter)

    def param(self, node: Param, scope: Scope, state: State) -> None:
        """Declare a parameter of the protocol."""
        expected = declared_expectation(
            node.type, f"parameter `{node.name.id}`", self._registry, self._reporter
        )
        value = POISON if expected is None else self._param(node, expected, scope, state)
        scope.declare(node.name, "parameter", value, self._reporter)

    def _object(self, node: ObjectDecl, scope: Scope) -> Val:
        if not known_roles(node.type, self._registry, self._reporter):
            return POISON
        given = self._options.bindings.get(node.name.id)
        if given is not None:
            return self._bound(node, given, node.name.span, f"`--bind {node.name.id}={given}`")
        if node.binding is not None:
            if isinstance(node.binding, Name) and scope.find(node.binding.id) is None:
                return self._bound(node, node.binding.id, node.binding.span, f"`{node.binding.id}`")
            return self._from_expression(node, self._evaluator.value(node.binding, scope))
        if self._options.open_bindings:
            return self._open(node)
        self._reporter.report(
            "XEI0206",
            f"object `{node.name.id}` is not bound to a registered object",
            node.name.span,
            f"needs an object that is `{text(node.type)}`",
            help=self._binding_help(node),
        )
        return POISON

    def _from_expression(self, node: ObjectDecl, value: Val) -> Val:
        assert node.binding is not None
        if isinstance(value, Poison):
            return POISON
        if isinstance(value, ObjectValue) and value.registered is not None:
            return self._bound(node, value.registered.name, node.binding.span, f"`{value.registered.name}`")
        expected = Expectation(f"object `{node.name.id}`", "object", None, node.type)
        return self._types.coerce(value, expected, node.binding, State(self._registry.arms))

    def _bound(self, node: ObjectDecl, name: str, span: Span, words: str) -> Val:
        thing = self._registry.objects.get(name)
        if thing is None:
            self._reporter.report(
                "XEI0202",
                f"{words} names no registered object",
                span,
                "no such object in the profile",
                help=meant(did_you_mean(name, self._registry.objects)) or self._binding_help(node),
            )
            return POISON
        if fits(node.type, thing.roles):
            return ObjectValue(name, thing, node.type)
        fitting = candidates(node.type, self._registry)
        self._reporter.report(
            "XEI0309",
            f"{words} {unmet(node.type, thing.roles)}, "
            f"but object `{node.name.id}` is to be `{text(node.type)}`",
            span,
            f"`{name}` has the roles {', '.join(thing.roles) or 'none'}",
            labels=(Label(node.type.span, "declared so here"),),
            notes=(self._reporter.rule(thing.span),),
            help=(f"registered objects that would do: {listed(fitting)}",)
            if fitting
            else ("no registered object would do",),
        )
        return POISON

    def _open(self, node: ObjectDecl) -> Val:
        if candidates(node.type, self._registry):
            return ObjectValue(node.name.id, None, node.type)
        self._reporter.report(
            "XEI0206",
            f"no registered object can be bound to `{node.name.id}`",
            node.type.span,
            f"none is `{text(node.type)}`",
        )
        return POISON

    def _binding_help(self, node: ObjectDecl) -> tuple[str, ...]:
        fitting = candidates(node.type, self._registry)
        if not fitting:
            return ("no registered object would do",)
        name = node.name.id
        return (
            f"bind it in the protocol, `object {name}: {text(node.type)} = {fitting[0]}`, or with "
            f"`--bind {name}={fitting[0]}`; objects that would do: {listed(fitting)}",
        )

    def _param(self, node: Param, expected: Expectation, scope: Scope, state: State) -> Val:
        limits = self.limits(node.limits, expected, scope, state)
        given = self._options.params.get(node.name.id)
        default: Val | None = None
        if node.default is not None:
            words = (*self._registry.arms, ANY_ARM) if expected.type == "Arm" else ()
            found = self._evaluator.value(node.default, scope, words)
            default = self._types.coerce(found, expected, node.default, state)
            default = self.inside(default, limits, node, node.default.span, "the default")
        if given is not None:
            return self._given(node, given, expected, limits, state)
        if limits is POISON or default is POISON:
            return POISON
        if self._options.open_bindings and isinstance(limits, Interval):
            return limits if default is None else _about(limits, default)
        if default is not None:
            return default
        return self._missing(node)

    def _missing(self, node: Param) -> Val:
        name = node.name.id
        if not self._options.open_bindings:
            self._reporter.report(
                "XEI0208",
                f"parameter `{name}` has no value",
                node.name.span,
                "declared without a default",
                help=(f"give it with `--param {name}=...`, or a default in the protocol",),
            )
        return POISON

    def _given(self, node: Param, given: str, expected: Expectation, limits: Val | None, state: State) -> Val:
        written = StringLit(given, node.name.span)
        shown = f"`--param {node.name.id}={given}`"
        try:
            value = read_value(given, expected, self._registry)
        except (QuantityError, ValueError) as error:
            reason = error.reason if isinstance(error, QuantityError) else str(error)
            self._reporter.report(
                "XEI0305", f"{shown} cannot be read: {reason}", node.name.span, f"takes {expected.noun}"
            )
            return POISON
        value = self._types.coerce(value, expected, written, state)
        return self.inside(value, limits, node, node.name.span, shown)

    def limits(
        self, node: Range | None, expected: Expectation, scope: Scope, state: State
    ) -> Interval | Poison | None:
        """The bounds of `in A .. B`, of the parameter's own type."""
        if node is None:
            return None
        if node.step is not None:
            self._reporter.report(
                "XEI0305", "the range of a parameter has no step", node.step.span, "leave it out"
            )
        ends = [
            self._types.coerce(self._evaluator.value(part, scope), expected, part, state)
            for part in (node.lower, node.upper)
        ]
        low, high = ends
        if (
            isinstance(low, Interval)
            or isinstance(high, Interval)
            or not all(map(arithmetic.is_numeric, ends))
        ):
            return POISON
        if arithmetic.compare(">", low, high):
            self._reporter.report(
                "XEI0308",
                f"the range `{show(low)} .. {show(high)}` is empty",
                node.span,
                "the ends are swapped",
            )
            return POISON
        return arithmetic.open_value(low, high, low)  # type: ignore[arg-type]

    def inside(self, value: Val, limits: Val | None, node: Param, span: Span, words: str) -> Val:
        """The value, if it lies inside the parameter's own limits."""
        if not isinstance(limits, Interval) or not arithmetic.is_numeric(value):
            return value
        low, high = (value.lower, value.upper) if isinstance(value, Interval) else (value, value)
        try:
            outside = arithmetic.compare("<", low, limits.lower) or arithmetic.compare(
                ">", high, limits.upper
            )
        except DimensionError:
            return POISON
        if not outside:
            return value
        assert node.limits is not None
        self._reporter.report(
            "XEI0308",
            f"{words} of parameter `{node.name.id}` is {show(value)}, outside of {show(limits)}"
            if words == "the default"
            else f"{words} is outside of {show(limits)}, the range of `{node.name.id}`",
            span,
            f"expected {show(limits)}",
            labels=(Label(node.limits.span, "its range"),),
        )
        return POISON


def _about(limits: Interval, default: Val) -> Interval:
    return replace(limits, nominal=default)
