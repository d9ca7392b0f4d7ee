"""What a protocol leaves open and the command line fills in: parameters and objects."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from types import MappingProxyType

from xei_lang.check import arithmetic
from xei_lang.check.declared import declared_expectation
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.objects import Objects
from xei_lang.check.option_values import OptionValues
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed, meant
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import ANY_ARM, Types
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, Poison, Val
from xei_lang.diagnostics import Diagnostics, Label, Source, Sources, Span, did_you_mean
from xei_lang.diagnostics.options import option_value
from xei_lang.quantity import DimensionError
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Module, ObjectDecl, Param, Range
from xei_lang.syntax.loading import Files

_NOTHING: Mapping[str, str] = MappingProxyType({})


@record
class CheckOptions(Shown):
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
        self._values = OptionValues(registry, evaluator, types, reporter)
        self._objects = Objects(registry, evaluator, types, reporter, options, self._values)

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

    def object(self, node: ObjectDecl, scope: Scope, state: State) -> None:
        """Declare an object under its name in the protocol."""
        scope.declare(node.name, "object", self._objects.value(node, scope, state), self._reporter)

    def param(self, node: Param, scope: Scope, state: State) -> None:
        """Declare a parameter of the protocol."""
        expected = declared_expectation(
            node.type, f"parameter `{node.name.id}`", self._registry, self._reporter
        )
        value = POISON if expected is None else self._param(node, expected, scope, state)
        scope.declare(node.name, "parameter", value, self._reporter)

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
        name = node.name.id
        value = self._values.read("param", name, given, expected, state)
        at = option_value("param", name, given)
        return self.inside(value, limits, node, at, f"`--param {name}={given}`")

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
