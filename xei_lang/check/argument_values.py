"""The value of one argument of a call: of the type, unit, range and kind of place that the skill bank asks
for, or else the bank's own default.
"""

from __future__ import annotations

from xei_lang.check import arithmetic
from xei_lang.check.amounts import Amounts, in_range, is_less_than_nothing, is_nothing
from xei_lang.check.blank import says_something
from xei_lang.check.contracts import Formal
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.names import ANY_WORD
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import ANY_ARM, Types
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, ObjectValue, PlaceValue, Val, Word
from xei_lang.profiles.model import ArgSpec
from xei_lang.quantity import Quantity, QuantityError, parse_quantity
from xei_lang.syntax.ast import Arg, Call, Expression


class ArgumentValues:
    """Evaluates the arguments of calls of skills; what does not fit is reported, and its value is POISON."""

    def __init__(self, registry: Registry, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._registry = registry
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter
        self._amounts = Amounts(evaluator, types, reporter)

    def value(self, given: Arg | None, formal: Formal, scope: Scope, state: State) -> Val | None:
        """The checked value of one argument; None for one that neither the call nor the skill bank gives."""
        spec, expected = formal.spec, formal.expected
        if given is None:
            return _default(spec, self._registry)
        value = self._evaluator.value(given.value, scope, self._words(spec))
        value = self._types.coerce(value, expected, given.value, state)
        if (
            isinstance(value, PlaceValue)
            and spec.type == "Place"
            and spec.choices
            and value.kind not in spec.choices
        ):
            return self._wrong_kind_of_place(value, spec, expected, given.value)
        if spec.type == "String":
            said = says_something(value, expected.what, given.value.span, self._reporter, spec.span)
            return value if said else POISON
        if formal.is_amount and is_nothing(value):
            return value
        if is_less_than_nothing(value, spec):
            self._amounts.less_than_nothing(value, expected, given.value, scope, state)
            return POISON
        return in_range(value, spec, expected, given.value, self._reporter)

    def look_at(self, call: Call, scope: Scope) -> None:
        """Evaluate the arguments of a call that cannot be checked, for the mistakes in themselves."""
        for arg in call.args:
            self._evaluator.value(arg.value, scope, ANY_WORD)

    def _words(self, spec: ArgSpec) -> tuple[str, ...]:
        """The bare words that an argument takes."""
        if spec.type == "Arm":
            return (*self._registry.arms, ANY_ARM)
        return spec.choices if spec.type == "choice" else ()

    def _wrong_kind_of_place(
        self, value: PlaceValue, spec: ArgSpec, expected: Expectation, node: Expression
    ) -> Val:
        wanted = " or ".join(f"a {choice}" for choice in spec.choices)
        self._reporter.report(
            "XEI0305",
            f"`{show(value)}` is a {value.kind}, but {expected.what} takes {wanted}",
            node.span,
            f"expected {wanted}, found a {value.kind}",
            notes=(self._reporter.rule(spec.span),),
        )
        return POISON


def _default(spec: ArgSpec, registry: Registry) -> Val | None:
    """The skill bank's own value of an argument, of whose type the profile's check has made sure."""
    default = spec.default
    if default is None or isinstance(default, (bool, int, Quantity)):
        return default
    if isinstance(default, float):
        return arithmetic.exact(default)
    if spec.type in ("Arm", "choice"):
        return Word(default)
    if spec.type == "object" and default in registry.objects:
        return ObjectValue(default, registry.objects[default])
    try:
        return default if spec.type == "String" else parse_quantity(default)
    except QuantityError:
        return default
