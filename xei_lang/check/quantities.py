"""Whether a value is a quantity of the dimension that is expected, with the unit that was probably meant."""

from __future__ import annotations

from fractions import Fraction

from xei_lang.check.expectation import Expectation
from xei_lang.check.report import Reporter, replace
from xei_lang.check.value_habits import NO_MEND, Mend
from xei_lang.check.value_words import a, kind, show
from xei_lang.check.values import POISON, Interval, Val
from xei_lang.diagnostics import Applicability
from xei_lang.quantity import TYPE_DIMENSIONS, UNITS, Quantity, quantity
from xei_lang.quantity.dimension import Dimension
from xei_lang.syntax.ast import Expression, QuantityLit


def quantity_value(value: Val, expected: Expectation, node: Expression, reporter: Reporter) -> Val:
    """The value, where it is a quantity of the expected type's dimension; else POISON, which is reported."""
    dimensions = TYPE_DIMENSIONS[expected.type]
    probe = value.lower if isinstance(value, Interval) else value
    if isinstance(probe, Quantity) and probe.dimension in dimensions:
        return value
    if isinstance(probe, (int, Fraction)) and not isinstance(probe, bool):
        return _no_unit(value, expected, node, reporter)
    if not isinstance(probe, Quantity):
        return no_such_type(value, expected, node, reporter)
    found = probe.dimension.name
    mended = _mended_unit(node, dimensions)
    reporter.report(
        "XEI0306",
        f"`{show(value)}` is {a(found)}, but {expected.what} takes {expected.noun}",
        node.span,
        f"expected {expected.noun}, found {a(found)}",
        notes=rule_of(expected, reporter),
        help=(f"write `{mended}` if that is what you mean",) if mended else _confused(probe, expected),
        fix=replace(node.span, mended, _applicability(node)) if mended else None,
    )
    return POISON


def _no_unit(value: Val, expected: Expectation, node: Expression, reporter: Reporter) -> Val:
    units = [symbol for symbol, unit in UNITS.items() if unit.dimension in TYPE_DIMENSIONS[expected.type]]
    usual = next((unit for unit in _USUAL_UNITS if unit in units), units[0])
    example = f"{show(value)} {usual}"
    reporter.report(
        "XEI0307",
        f"`{show(value)}` has no unit, but {expected.what} takes {expected.noun}",
        node.span,
        f"expected {expected.noun}, found a plain number",
        notes=rule_of(expected, reporter),
        help=(f"write it with a unit: {', '.join(units[:5])}; for example `{example}`",),
    )
    return POISON


def no_such_type(
    value: Val, expected: Expectation, node: Expression, reporter: Reporter, mend: Mend = NO_MEND
) -> Val:
    """Report a value of another type; always POISON."""
    help, fix = mend
    reporter.report(
        "XEI0305",
        f"`{show(value)}` is {kind(value)}, but {expected.what} takes {expected.noun}",
        node.span,
        f"expected {expected.noun}, found {kind(value)}",
        notes=rule_of(expected, reporter),
        help=help,
        fix=fix,
    )
    return POISON


def rule_of(expected: Expectation, reporter: Reporter) -> tuple[str, ...]:
    """The note that says where the type is asked for, if that is in a profile."""
    return (reporter.rule(expected.rule),) if expected.rule else ()


_USUAL_UNITS = ("mL", "mm", "s", "min", "g", "degC", "deg", "rpm", "mM", "xg")
_CONFUSED_UNITS = (
    ("g", "xg"),
    ("m", "min"),
    ("degC", "K"),
    ("mm", "mL"),
    ("mM", "mL"),
    ("mL", "mM"),
    ("mm", "mM"),
)
_MORE_CONFUSED = (
    ("mM", "mm"),
    ("mL", "mm"),
    ("uM", "uL"),
    ("um", "uL"),
    ("uL", "uM"),
    ("M", "min"),
    ("K", "degC"),
)


def _mended_unit(node: Expression, dimensions: tuple[Dimension, ...]) -> str | None:
    """The literal with the unit that a hand writes for the one that is needed; None where there is no such
    unit.
    """
    if not isinstance(node, QuantityLit):
        return None
    for written, better in (*_CONFUSED_UNITS, *_MORE_CONFUSED):
        if node.value.unit == written and UNITS[better].dimension in dimensions:
            return str(quantity(node.value.magnitude, better))
    return None


def _confused(found: Quantity, expected: Expectation) -> tuple[str, ...]:
    if expected.type != "CentrifugalForce":
        return ()
    if found.dimension.name == "Frequency":
        return ("how strong a spin is depends on the rotor's radius too: write its force, as in `3000 xg`",)
    return ("a centrifugal force is written with `xg`, as in `3000 xg`",)


def _applicability(node: Expression) -> Applicability:
    return "safe" if isinstance(node, QuantityLit) and node.value.unit == "g" else "unsafe"
