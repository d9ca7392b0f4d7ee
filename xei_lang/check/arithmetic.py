"""Exact arithmetic and comparisons on numbers, quantities and open intervals of them."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from math import ceil
from typing import Any

from xei_lang.check import affine
from xei_lang.check.run_time import MAX_FORMULA, formula_of, needs_of
from xei_lang.check.values import Interval, Numeric, Val, number
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import NUMBER

_BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": lambda left, right: left / (Fraction(right) if isinstance(right, int) else right),
}
_MOST_BITS = 4096
_ORDER: dict[str, Callable[[Any, Any], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


class TooLargeError(ArithmeticError):
    """A number of so many digits, or of so long a formula, that computing with it would take long."""


def is_numeric(value: Val) -> bool:
    """Whether arithmetic can be done with the value."""
    return isinstance(value, (Quantity, int, Fraction, Interval)) and not isinstance(value, bool)


def combine(op: str, left: Val, right: Val) -> Val:
    """`left op right` for numeric values.

    Raises DimensionError where the dimensions do not go together, ZeroDivisionError where the divisor is or
    may be zero, TooLargeError for numbers of absurdly many digits. Sums, differences and multiples know an
    open value again (`v - v` is nothing); elsewhere each occurrence counts as its own.
    """
    if not isinstance(left, Interval) and not isinstance(right, Interval):
        return _apply(op, _numeric(left), _numeric(right))
    lows, highs = _as_interval(left), _as_interval(right)
    if op == "/" and _has_zero(highs):
        raise ZeroDivisionError
    formula = f"{formula_of(left)} {op} {formula_of(right)}" if needs_of(left, right) else ""
    linear = affine.linear(op, _either(left), _either(right), _apply)
    if linear is not None:
        return _measured(linear, formula, left, right) if linear.shares else linear.lower
    corners = [_apply(op, a, b) for a in (lows.lower, lows.upper) for b in (highs.lower, highs.upper)]
    ordered = sorted(corners, key=lambda corner: _lifted(corner).value)
    nominal = _apply(op, lows.nominal, highs.nominal)
    made = affine.opened(Interval(ordered[0], ordered[-1], nominal), _apply)
    return _measured(made, formula, left, right)


def negate(value: Val) -> Val:
    """`-value`, for a numeric value."""
    if isinstance(value, Interval):
        shares = tuple((unknown, _negative(width)) for unknown, width in value.shares)
        ends = (_negative(value.upper), _negative(value.lower), _negative(value.nominal))
        turned = Interval(*ends, shares=shares)
        return _measured(turned, f"-{formula_of(value)}", value)
    return _negative(_numeric(value))


def extreme(name: str, left: Val, right: Val) -> Val:
    """`min(left, right)` or `max(left, right)`, by its name, for numeric values. Raises DimensionError."""
    op = "<" if name == "min" else ">"
    if not isinstance(left, Interval) and not isinstance(right, Interval):
        return right if compare(op, right, left) else left
    first, second = _as_interval(left), _as_interval(right)
    ends = ((first.lower, second.lower), (first.upper, second.upper), (first.nominal, second.nominal))
    lower, upper, nominal = (b if _ordered(op, b, a) else a for a, b in ends)
    chosen = affine.opened(Interval(lower, upper, nominal), _apply)
    return _measured(chosen, f"{name}({formula_of(left)}, {formula_of(right)})", left, right)


def rounded_up(value: Val) -> Val:
    """`ceil(value)`, for a plain number. Raises TypeError for a quantity."""
    if isinstance(value, Interval):
        lower, upper, nominal = (_ceiling(part) for part in (value.lower, value.upper, value.nominal))
        return _measured(Interval(lower, upper, nominal), f"ceil({value.formula})", value)
    return _ceiling(_numeric(value))


def compare(op: str, left: Val, right: Val) -> bool | None:
    """`left op right` for numeric values; None where open values leave it open. Raises DimensionError."""
    if not isinstance(left, Interval) and not isinstance(right, Interval):
        return _ordered(op, _numeric(left), _numeric(right))
    apart = affine.linear("-", _either(left), _either(right), _apply)
    if apart is not None:
        left, right = apart, _apply("*", apart.upper, 0)
    first, second = _as_interval(left), _as_interval(right)
    if op in ("==", "!="):
        if _ordered("<", first.upper, second.lower) or _ordered(">", first.lower, second.upper):
            return op == "!="
        same = _ordered("==", first.lower, first.upper) and _ordered("==", second.lower, second.upper)
        return (op == "==") if same else None
    answers = {_ordered(op, a, b) for a in (first.lower, first.upper) for b in (second.lower, second.upper)}
    return answers.pop() if len(answers) == 1 else None


def _measured(made: Interval, formula: str, *sources: Val) -> Interval:
    """The interval with its formula, if any of what it was made of is measured."""
    needs = needs_of(*sources)
    if len(formula) > MAX_FORMULA and needs:
        raise TooLargeError("what is computed from measurements here is too long to be carried in a plan")
    return replace(made, formula=formula, needs=needs) if needs else made


def _ceiling(value: Numeric) -> int:
    if isinstance(value, Quantity):
        raise TypeError(f"not a plain number: {value!r}")
    return ceil(value)


def _apply(op: str, left: Numeric, right: Numeric) -> Numeric:
    if isinstance(left, Quantity) or isinstance(right, Quantity):
        if op in "+-":
            left, right = _lifted(left), _lifted(right)
        elif not isinstance(left, Quantity):
            left = Fraction(left)
    made = number(_BINARY[op](left, right))
    exact_value = Fraction(made.value if isinstance(made, Quantity) else made)
    if max(exact_value.numerator.bit_length(), exact_value.denominator.bit_length()) > _MOST_BITS:
        raise TooLargeError("this number has too many digits")
    return made


def _ordered(op: str, left: Numeric, right: Numeric) -> bool:
    """Raises DimensionError also for `==`: comparing a volume with a time is a mistake, not an answer."""
    first, second = _lifted(left), _lifted(right)
    _ = first <= second
    return _ORDER[op](first, second)


def _negative(value: Numeric) -> Numeric:
    return number(-value)


def _lifted(value: Numeric) -> Quantity:
    return value if isinstance(value, Quantity) else Quantity(Fraction(value), NUMBER, "")


def open_value(lower: Numeric, upper: Numeric, nominal: Numeric) -> Interval:
    """A value of its own that lies between two ends, of the same dimension."""
    return affine.opened(Interval(lower, upper, nominal), _apply)


def _either(value: Val) -> Interval | Numeric:
    return value if isinstance(value, Interval) else _numeric(value)


def _as_interval(value: Val) -> Interval:
    if isinstance(value, Interval):
        return value
    only = _numeric(value)
    return Interval(only, only, only)


def _has_zero(value: Interval) -> bool:
    return _lifted(value.lower).value <= 0 <= _lifted(value.upper).value


def _numeric(value: Val) -> Numeric:
    if isinstance(value, (Quantity, int, Fraction)):
        return value
    raise TypeError(f"not a number: {value!r}")


def exact(value: float) -> Numeric:
    """A float as the decimal that it is written as."""
    return number(Fraction(str(value)))
