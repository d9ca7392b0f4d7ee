"""Amounts in arguments: inside the skill bank's range, not less than nothing, and what they were made of."""

from __future__ import annotations

from xei_lang.check import arithmetic
from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope
from xei_lang.check.state import State
from xei_lang.check.types import Types
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, ObjectValue, Val
from xei_lang.diagnostics import Label
from xei_lang.profiles.model import ArgSpec
from xei_lang.quantity import DimensionError, Quantity
from xei_lang.syntax.ast import Binary, CallExpr, Expression, Name, walk

_NEVER_NEGATIVE = ("Volume", "Mass")


def is_nothing(value: Val | None) -> bool:
    """Whether it is a quantity of exactly nothing, `0 uL`."""
    return isinstance(value, Quantity) and value.value == 0


def is_less_than_nothing(value: Val, spec: ArgSpec) -> bool:
    """Whether an amount of stuff is, or may be, below zero."""
    low = value.lower if isinstance(value, Interval) else value
    return spec.type in _NEVER_NEGATIVE and isinstance(low, Quantity) and low.value < 0


def in_range(value: Val, spec: ArgSpec, expected: Expectation, node: Expression, reporter: Reporter) -> Val:
    """The value, if all that it may be lies in the range that the skill bank gives; else POISON, reported."""
    if (spec.min is None and spec.max is None) or not arithmetic.is_numeric(value):
        return value
    low, high = (value.lower, value.upper) if isinstance(value, Interval) else (value, value)
    try:
        below = spec.min is not None and arithmetic.compare("<", low, spec.min) is True
        above = spec.max is not None and arithmetic.compare(">", high, spec.max) is True
    except DimensionError:
        return value
    if not below and not above:
        return value
    bounds = f"{spec.min if spec.min is not None else '...'} .. {spec.max if spec.max is not None else '...'}"
    may = "may be" if isinstance(value, Interval) else "is"
    side = f"less than {spec.min}" if below else f"more than {spec.max}"
    reporter.report(
        "XEI0308",
        f"{expected.what} {may} {show(low if below else high)}, {side}",
        node.span,
        f"expected {bounds}",
        notes=(reporter.rule(spec.span),),
    )
    return POISON


class Amounts:
    """Says how an amount came about that cannot be."""

    def __init__(self, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter

    def less_than_nothing(
        self, value: Val, expected: Expectation, node: Expression, scope: Scope, state: State
    ) -> None:
        """Report an amount below zero with the arithmetic that led to it."""
        may = "may be" if isinstance(value, Interval) else "is"
        low = value.lower if isinstance(value, Interval) else value
        labels = self._origins(node, scope, state)
        self._reporter.report(
            "XEI0323",
            f"{expected.what} {may} {show(low)}, less than nothing",
            node.span,
            self._arithmetic(node, value, scope),
            labels=labels,
            help=("use `max(0 uL, ...)` if nothing is to be moved then; a transfer of `0 uL` is skipped",)
            if isinstance(node, Binary)
            else (),
        )

    def _arithmetic(self, node: Expression, value: Val, scope: Scope) -> str:
        if not isinstance(node, Binary):
            return f"this is {show(value)}"
        left, right = (self._evaluator.value(side, scope) for side in (node.left, node.right))
        return f"{_bracketed(left)} {node.op} {_bracketed(right)} is {show(value)}"

    def _origins(self, node: Expression, scope: Scope, state: State) -> tuple[Label, ...]:
        """The places that made the volumes which the expression asks for."""
        found: dict[Label, None] = {}
        asked = (part for part in walk(node) if isinstance(part, CallExpr) and len(part.args) == 1)
        for part in asked:
            if isinstance(part.function, Name) and part.function.id == "volume":
                arg = part.args[0].value
                thing = self._evaluator.value(arg, scope)
                thing = self._types.coerce(thing, Expectation("`volume`", "object"), arg, state)
                if isinstance(thing, ObjectValue):
                    found.update(dict.fromkeys(state.volumes.get(thing.name).labels))
        return tuple(found)


def _bracketed(value: Val) -> str:
    return f"({show(value)})" if isinstance(value, Interval) else show(value)
