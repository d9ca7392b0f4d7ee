"""Exact quantities: a rational number of SI units, remembered in the unit that the user wrote."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction

from xei_lang.quantity.dimension import NUMBER, Dimension
from xei_lang.quantity.text import format_magnitude
from xei_lang.quantity.units import UNITS, Unit, suggest_unit


class DimensionError(ValueError):
    """Two quantities do not go together; `left` and `right` are their dimensions."""

    def __init__(self, operation: str, left: Dimension, right: Dimension) -> None:
        super().__init__(f"cannot {operation} {left.name} and {right.name}")
        self.operation = operation
        self.left = left
        self.right = right


class QuantityError(ValueError):
    """A text is no quantity: `reason` says why; `suggestion` is a mended text where there is one meaning."""

    def __init__(self, text: str, reason: str, suggestion: str | None = None) -> None:
        super().__init__(reason)
        self.text = text
        self.reason = reason
        self.suggestion = suggestion


@dataclass(frozen=True, slots=True, eq=False)
class Quantity:
    """`value` in SI units (`37 degC` is 310.15 K), with its dimension and the unit in which to show it.

    A unit that is not in `UNITS` comes from arithmetic and spells base SI units (`m^6`). Quantities are equal
    when value and dimension are; quantities of other dimensions are unequal, and ordering them is an error.
    """

    value: Fraction
    dimension: Dimension
    unit: str

    @property
    def si(self) -> float:
        """The value in SI units as a float; infinite where it is too large for one."""
        numerator, denominator = self.value.as_integer_ratio()
        try:
            return numerator / denominator
        except OverflowError:
            return math.inf if self.value > 0 else -math.inf

    @property
    def magnitude(self) -> Fraction:
        """The number before the unit: 2 of `2 mL`."""
        scale = self._scale()
        return (self.value - scale.offset if scale.offset else self.value) / scale.factor

    def to(self, unit: str) -> Quantity:
        """The same quantity in another unit of `UNITS`; DimensionError if that measures something else."""
        if UNITS[unit].dimension != self.dimension:
            raise DimensionError("convert between", self.dimension, UNITS[unit].dimension)
        return Quantity(self.value, self.dimension, unit)

    def __str__(self) -> str:
        number = format_magnitude(self.magnitude)
        return f"{number} {self.unit}" if self.unit else number

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Quantity):
            return NotImplemented
        return self.value == other.value and self.dimension == other.dimension

    def __hash__(self) -> int:
        return hash((self.value, self.dimension))

    def __lt__(self, other: Quantity) -> bool:
        self._require_same(other, "compare")
        return self.value < other.value

    def __le__(self, other: Quantity) -> bool:
        self._require_same(other, "compare")
        return self.value <= other.value

    def __gt__(self, other: Quantity) -> bool:
        return other < self

    def __ge__(self, other: Quantity) -> bool:
        return other <= self

    def __neg__(self) -> Quantity:
        """The negative as it is written: `-(20 degC)` is `-20 degC`, not a negative absolute temperature."""
        scale = self._scale()
        return Quantity(2 * scale.offset - self.value, self.dimension, self.unit)

    def __add__(self, other: Quantity) -> Quantity:
        """A point plus a difference is a point; two points have no sum."""
        left, right = self.dimension, other.dimension
        if left.difference != right.difference or (left.point and right.point):
            raise DimensionError("add", left, right)
        keeper = other if right.point else self
        return Quantity(self.value + other.value, keeper.dimension, keeper.unit)

    def __sub__(self, other: Quantity) -> Quantity:
        """Two points make a difference, in base units; from a difference only a difference is subtracted."""
        left, right = self.dimension, other.dimension
        if left.difference != right.difference or (right.point and not left.point):
            raise DimensionError("subtract", left, right)
        value = self.value - other.value
        if right.point:
            return Quantity(value, left.difference, left.difference.base_unit)
        return Quantity(value, left, self.unit)

    def __mul__(self, other: Quantity | Fraction | int) -> Quantity:
        factor = _as_quantity(other)
        self._require_no_point(factor, "multiply")
        dimension = self.dimension.times(factor.dimension)
        return Quantity(self.value * factor.value, dimension, _product_unit(self, factor, dimension))

    def __rmul__(self, other: Fraction | int) -> Quantity:
        return self * other

    def __truediv__(self, other: Quantity | Fraction | int) -> Quantity:
        """Raises ZeroDivisionError for a zero divisor, as numbers do."""
        divisor = _as_quantity(other)
        self._require_no_point(divisor, "divide")
        dimension = self.dimension.times(divisor.dimension, -1)
        return Quantity(self.value / divisor.value, dimension, _quotient_unit(self, divisor, dimension))

    def __rtruediv__(self, other: Fraction | int) -> Quantity:
        return _as_quantity(other) / self

    def _scale(self) -> Unit:
        return UNITS.get(self.unit) or Unit(self.dimension, Fraction(1))

    def _require_same(self, other: Quantity, operation: str) -> None:
        if self.dimension != other.dimension:
            raise DimensionError(operation, self.dimension, other.dimension)

    def _require_no_point(self, other: Quantity, operation: str) -> None:
        if self.dimension.point or other.dimension.point:
            raise DimensionError(operation, self.dimension, other.dimension)


def quantity(magnitude: Fraction | int, unit: str) -> Quantity:
    """So many of a unit of `UNITS`; KeyError for another unit."""
    scale = UNITS[unit]
    return Quantity(magnitude * scale.factor + scale.offset, scale.dimension, unit)


def parse_quantity(text: str) -> Quantity:
    """Read `2 mL`, `0.5mL`, `-20 degC`, `5 %`; raises QuantityError with a reason that people can read.

    Number and unit stand on one line, the number has no exponent and at most 40 digits.
    """
    match = _QUANTITY.fullmatch(text.strip())
    if match is None:
        raise QuantityError(text, f"`{_shown(text)}` is not a number with a unit, such as `2 mL`")
    sign, whole, part, unit = match.groups(default="")
    if len(whole) + len(part) > _MAX_DIGITS:
        raise QuantityError(text, f"a number may have at most {_MAX_DIGITS} digits")
    if not unit:
        raise QuantityError(text, f"`{text.strip()}` has no unit; write for example `{text.strip()} mL`")
    if unit not in UNITS:
        better = suggest_unit(unit)
        hint = f"; write `{better}`" if better else ""
        mended = f"{sign}{whole}{'.' if part else ''}{part} {better}" if better else None
        raise QuantityError(text, f"`{_shown(unit)}` is not a unit{hint}", mended)
    magnitude = Fraction(int(whole + part), 10 ** len(part))
    return quantity(-magnitude if sign == "-" else magnitude, unit)


_MAX_DIGITS = 40
_QUANTITY = re.compile(r"([+-]?)([0-9]+)(?:\.([0-9]+))?[ \t]*([^\s0-9.][^\s]*)?")


def _shown(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."


def _as_quantity(number: Quantity | Fraction | int) -> Quantity:
    return number if isinstance(number, Quantity) else Quantity(Fraction(number), NUMBER, "")


def _product_unit(left: Quantity, right: Quantity, dimension: Dimension) -> str:
    if right.dimension == NUMBER:
        return left.unit
    if left.dimension == NUMBER:
        return right.unit
    return _known_unit(dimension)


def _quotient_unit(left: Quantity, right: Quantity, dimension: Dimension) -> str:
    if right.dimension == NUMBER:
        return left.unit
    composed = f"{left.unit}/{right.unit}"
    if composed in UNITS and UNITS[composed].dimension == dimension:
        return composed
    return _known_unit(dimension)


def _known_unit(dimension: Dimension) -> str:
    """The first unit of the table for a dimension, else base units; a plain number has none."""
    if dimension == NUMBER:
        return ""
    for symbol, unit in UNITS.items():
        if unit.dimension == dimension:
            return symbol
    return dimension.base_unit
