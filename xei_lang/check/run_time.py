"""Values that only a run will know: in words that it can evaluate, and refused where nothing can wait for it.

The words are expressions of the language in which a measurement is named by the id of its step, so that they
mean the same wherever they stand in the plan.
"""

from __future__ import annotations

from fractions import Fraction

from xei_lang.check.report import Reporter
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, Interval, Undecided, Val
from xei_lang.diagnostics import Span
from xei_lang.quantity import Quantity
from xei_lang.quantity.text import format_magnitude

MAX_FORMULA = 2000
"""Characters of a formula: a few lines of `let` could else make one as long as memory lasts."""


def needs_of(*values: Val) -> tuple[str, ...]:
    """The measuring steps that some values come from, each once, in their order."""
    found = [name for value in values if isinstance(value, (Interval, Undecided)) for name in value.needs]
    return tuple(dict.fromkeys(found))


def formula_of(value: Val) -> str:
    """How a value is written in a formula: what is measured by its formula, all else as exactly as it is."""
    match value:
        case Interval() | Undecided() if value.needs:
            return f"({value.formula})" if " " in value.formula else value.formula
        case bool():
            return show(value)
        case int() | Fraction():
            return _exact(Fraction(value), "")
        case Quantity():
            return _exact(value.magnitude, value.unit)
        case _:
            return show(value)


def negated(value: Undecided) -> Undecided:
    """`not value`."""
    return Undecided(f"not ({value.formula})", value.needs)


def joined(op: str, values: list[Undecided]) -> Undecided:
    """Several conditions with `and` or `or` between them."""
    parts = (formula_of(value) for value in values) if len(values) > 1 else (values[0].formula,)
    return Undecided(f" {op} ".join(parts), needs_of(*values))


def known_now(value: Val, what: str, span: Span, reporter: Reporter) -> Val:
    """The value, which must be known before anything runs; POISON where it is measured, which is reported."""
    if not needs_of(value):
        return value
    reporter.report(
        "XEI0352",
        f"{what} is known only when the protocol runs",
        span,
        f"comes from {' and '.join(f'`{name}`' for name in needs_of(value))}, which is measured",
        notes=(
            "rule: how many steps a plan has, and what bounds their time, is decided when it is compiled",
        ),
        help=("write a value, or decide with `if` or `repeat ... until` what happens",),
    )
    return POISON


def _exact(magnitude: Fraction, unit: str) -> str:
    shown = format_magnitude(magnitude) if abs(magnitude) < 10**30 else str(magnitude.numerator)
    whole = shown if magnitude.denominator == 1 or Fraction(shown) == magnitude else str(magnitude.numerator)
    with_unit = f"{whole} {unit}" if unit else whole
    return with_unit if Fraction(whole) == magnitude else f"({with_unit} / {magnitude.denominator})"
