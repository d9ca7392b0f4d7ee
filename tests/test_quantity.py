"""Quantities: written cases, and the laws that exact arithmetic with dimensions must keep."""

from __future__ import annotations

import contextlib
import math
import subprocess
import sys
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.quantity import (
    TYPE_DIMENSIONS,
    UNIT_HABITS,
    UNITS,
    DimensionError,
    Quantity,
    QuantityError,
    parse_quantity,
    quantity,
    suggest_unit,
)

numbers = st.decimals(min_value=-(10**6), max_value=10**6, places=4, allow_nan=False).map(Fraction)
plain_units = st.sampled_from(sorted(symbol for symbol, unit in UNITS.items() if not unit.dimension.point))
quantities = st.builds(quantity, numbers, plain_units)


@pytest.mark.parametrize(
    ("text", "si", "name", "shown"),
    [
        ("2 mL", 2e-6, "Volume", "2 mL"),
        ("2.50mL", 2.5e-6, "Volume", "2.5 mL"),
        ("0.1 uL", 1e-10, "Volume", "0.1 uL"),
        ("118 mm", 0.118, "Length", "118 mm"),
        ("6.5 g", 0.0065, "Mass", "6.5 g"),
        ("10 min", 600, "Time", "10 min"),
        ("1 d", 86400, "Time", "1 d"),
        ("37 degC", 310.15, "Temperature", "37 degC"),
        ("-20 degC", 253.15, "Temperature", "-20 degC"),
        ("5 K", 5, "TemperatureDifference", "5 K"),
        ("180 deg", math.pi, "Angle", "180 deg"),
        ("90 deg/s", math.pi / 2, "AngularSpeed", "90 deg/s"),
        ("250 mm/s", 0.25, "Speed", "250 mm/s"),
        ("3 mN", 0.003, "Force", "3 mN"),
        ("3000 xg", 3000, "CentrifugalForce", "3000 xg"),
        ("600 rpm", 10, "Frequency", "600 rpm"),
        ("5 mM", 5, "Concentration (molar)", "5 mM"),
        ("5 mg/mL", 5, "Concentration (mass per volume)", "5 mg/mL"),
        ("70 %", 0.7, "Number", "70 %"),
    ],
)
def test_parse(text: str, si: float, name: str, shown: str) -> None:
    value = parse_quantity(text)
    assert value.si == pytest.approx(si, rel=1e-15)
    assert value.dimension.name == name
    assert str(value) == shown


@pytest.mark.parametrize(
    ("text", "reason", "suggestion"),
    [
        ("2", "`2` has no unit; write for example `2 mL`", None),
        ("2 ul", "`ul` is not a unit; write `uL`", "2 uL"),
        ("2.50 \N{MICRO SIGN}L", "`\N{MICRO SIGN}L` is not a unit; write `uL`", "2.50 uL"),
        ("10 minutes", "`minutes` is not a unit; write `min`", "10 min"),
        ("37 °C", "`°C` is not a unit; write `degC`", "37 degC"),
        ("3 parsec", "`parsec` is not a unit", None),
        ("much", "`much` is not a number with a unit, such as `2 mL`", None),
        ("1e3 m", "`1e3 m` is not a number with a unit, such as `2 mL`", None),
        ("10 min 30 s", "`10 min 30 s` is not a number with a unit, such as `2 mL`", None),
        ("", "`` is not a number with a unit, such as `2 mL`", None),
        ("9" * 5000 + " mL", "a number may have at most 40 digits", None),
    ],
)
def test_parse_error(text: str, reason: str, suggestion: str | None) -> None:
    with pytest.raises(QuantityError) as error:
        parse_quantity(text)
    assert error.value.reason == reason
    assert error.value.suggestion == suggestion


def test_units_of_one_size_are_equal() -> None:
    assert parse_quantity("2000 uL") == parse_quantity("2 mL")
    assert hash(parse_quantity("2000 uL")) == hash(parse_quantity("2 mL"))
    assert parse_quantity("1 M") == parse_quantity("1 mol/L")
    assert parse_quantity("1 g") != parse_quantity("1 xg")
    assert parse_quantity("0 mL") != parse_quantity("0 s")


def test_sums_keep_the_left_unit_and_stay_exact() -> None:
    total = parse_quantity("2 mL") + parse_quantity("500 uL")
    assert str(total) == "2.5 mL"
    tenth = parse_quantity("0.1 mL")
    assert str(tenth + tenth + tenth) == "0.3 mL"
    assert str(total / 3) == "0.833333 mL"
    assert str(3 * total) == "7.5 mL"
    assert str(total.to("uL")) == "2500 uL"


def test_temperatures_are_points() -> None:
    warm, step = parse_quantity("37 degC"), parse_quantity("5 K")
    assert str(warm + step) == str(step + warm) == "42 degC"
    assert str(warm - step) == "32 degC"
    assert str(warm - parse_quantity("4 degC")) == "33 K"
    for impossible in (lambda: warm + warm, lambda: step - warm, lambda: warm * 2, lambda: warm < step):
        with pytest.raises(DimensionError):
            impossible()


def test_products_find_their_unit() -> None:
    assert str(parse_quantity("10 mm") / parse_quantity("2 s")) == "5 mm/s"
    assert str(parse_quantity("3 m") * parse_quantity("2 N")) == "6 Nm"
    assert str(parse_quantity("2 mL") / parse_quantity("4 mL")) == "0.5"
    assert str(1 / parse_quantity("10 s")) == "0.1 Hz"
    assert (
        parse_quantity("1 m") * parse_quantity("1 m") / parse_quantity("1 s")
    ).dimension.name == "Length^2/Time"
    assert (parse_quantity("1 m") * parse_quantity("1 m")).unit == "m^2"


def test_dimension_error_carries_both_sides() -> None:
    with pytest.raises(DimensionError, match="cannot add Volume and Time") as error:
        parse_quantity("2 mL") + parse_quantity("3 s")
    assert error.value.left in TYPE_DIMENSIONS["Volume"]
    assert error.value.right in TYPE_DIMENSIONS["Time"]


@given(quantities)
def test_text_and_back(value: Quantity) -> None:
    assert parse_quantity(str(value)) == value


@given(numbers, numbers, numbers, plain_units)
def test_group_laws(a: Fraction, b: Fraction, c: Fraction, unit: str) -> None:
    x, y, z = (quantity(number, unit) for number in (a, b, c))
    zero = quantity(0, unit)
    assert x + y == y + x
    assert (x + y) + z == x + (y + z)
    assert x + zero == x
    assert x + -x == zero
    assert x - y == x + -y
    assert (x < y) == (a < b)
    assert (x <= y) == (a <= b)


@given(quantities, quantities)
def test_products_commute_and_quotients_undo(x: Quantity, y: Quantity) -> None:
    assert x * y == y * x
    if y.value:
        assert (x * y) / y == x


@given(quantities, quantities)
def test_other_dimensions_never_mix(x: Quantity, y: Quantity) -> None:
    if x.dimension == y.dimension:
        assert (x + y).dimension == x.dimension
        return
    for operation in (lambda: x + y, lambda: x - y, lambda: x < y, lambda: x >= y):
        with pytest.raises(DimensionError):
            operation()


@given(numbers, numbers)
def test_point_laws(a: Fraction, b: Fraction) -> None:
    warm, other = quantity(a, "degC"), quantity(b, "degC")
    assert warm + (other - warm) == other
    below = -warm
    assert -below == warm
    assert below.magnitude == -a


@given(st.text(max_size=40))
def test_any_text_parses_or_says_why(text: str) -> None:
    with contextlib.suppress(QuantityError):
        assert parse_quantity(text).unit in UNITS


def test_habits_name_units_and_are_none() -> None:
    for written, unit in UNIT_HABITS.items():
        assert unit in UNITS
        assert written not in UNITS, written
        assert suggest_unit(written) == unit
    assert suggest_unit("KG") == "kg"
    assert suggest_unit("MM") is None


def test_huge_values_still_print() -> None:
    value = quantity(10**39, "m")
    for _ in range(12):
        value = value * value
    assert str(value).startswith("more than 10^30")
    assert value.si == math.inf


def test_import_is_light() -> None:
    heavy = ("numpy", "pint", "pydantic", "lark", "yaml")
    code = f"import sys, xei_lang.quantity; print([name for name in {heavy} if name in sys.modules])"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"
