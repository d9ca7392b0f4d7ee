"""The units that a protocol or profile may use, each with its exact size in the SI."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from types import MappingProxyType

from xei_lang.quantity import dimension as d
from xei_lang.quantity.dimension import Dimension


@dataclass(frozen=True, slots=True)
class Unit:
    """`value_si = magnitude * factor + offset`; the offset is 0 but for temperatures in degrees Celsius."""

    dimension: Dimension
    factor: Fraction
    offset: Fraction = Fraction(0)


# An angle's exact factor is irrational: the double nearest to pi, taken as an exact fraction, keeps
# 180 deg == pi in floats and lets 90 deg print as 90 deg.
_DEGREE = Fraction(math.pi) / 180
_SIZES: tuple[tuple[Dimension, tuple[tuple[str, Fraction | int], ...]], ...] = (
    (d.NUMBER, (("%", Fraction(1, 100)),)),
    (
        d.LENGTH,
        (
            ("m", 1),
            ("cm", Fraction(1, 100)),
            ("mm", Fraction(1, 10**3)),
            ("um", Fraction(1, 10**6)),
            ("nm", Fraction(1, 10**9)),
        ),
    ),
    (
        d.VOLUME,
        (
            ("L", Fraction(1, 10**3)),
            ("mL", Fraction(1, 10**6)),
            ("uL", Fraction(1, 10**9)),
            ("nL", Fraction(1, 10**12)),
        ),
    ),
    (
        d.MASS,
        (
            ("kg", 1),
            ("g", Fraction(1, 10**3)),
            ("mg", Fraction(1, 10**6)),
            ("ug", Fraction(1, 10**9)),
            ("ng", Fraction(1, 10**12)),
        ),
    ),
    (d.TIME, (("s", 1), ("ms", Fraction(1, 1000)), ("min", 60), ("h", 3600), ("d", 86400))),
    (d.FREQUENCY, (("Hz", 1), ("rpm", Fraction(1, 60)))),
    (d.TEMPERATURE_DIFFERENCE, (("K", 1),)),
    (d.ANGLE, (("rad", 1), ("deg", _DEGREE))),
    (
        d.AMOUNT,
        (
            ("mol", 1),
            ("mmol", Fraction(1, 10**3)),
            ("umol", Fraction(1, 10**6)),
            ("nmol", Fraction(1, 10**9)),
        ),
    ),
    (d.SPEED, (("m/s", 1), ("mm/s", Fraction(1, 1000)))),
    (d.ACCELERATION, (("m/s2", 1), ("mm/s2", Fraction(1, 1000)))),
    (d.ANGULAR_SPEED, (("rad/s", 1), ("deg/s", _DEGREE))),
    (d.ANGULAR_ACCELERATION, (("rad/s2", 1), ("deg/s2", _DEGREE))),
    (d.FORCE, (("N", 1), ("mN", Fraction(1, 1000)))),
    (d.TORQUE, (("Nm", 1),)),
    (
        d.FLOW,
        (
            ("mL/s", Fraction(1, 10**6)),
            ("uL/s", Fraction(1, 10**9)),
            ("mL/min", Fraction(1, 60 * 10**6)),
        ),
    ),
    (
        d.MOLAR_CONCENTRATION,
        (
            ("mol/L", 1000),
            ("M", 1000),
            ("mM", 1),
            ("uM", Fraction(1, 10**3)),
            ("nM", Fraction(1, 10**6)),
        ),
    ),
    (
        d.MASS_CONCENTRATION,
        (
            ("g/L", 1),
            ("mg/mL", 1),
            ("mg/L", Fraction(1, 10**3)),
            ("ug/mL", Fraction(1, 10**3)),
            ("ng/uL", Fraction(1, 10**3)),
        ),
    ),
    (d.CENTRIFUGAL_FORCE, (("xg", 1),)),
)

UNITS: Mapping[str, Unit] = MappingProxyType(
    {
        **{symbol: Unit(dimension, Fraction(size)) for dimension, sizes in _SIZES for symbol, size in sizes},
        "degC": Unit(d.TEMPERATURE, Fraction(1), Fraction(27315, 100)),
    }
)
"""Every unit by its symbol; symbols tell capitals from small letters (`mM` is molar, `mm` a length)."""

UNIT_HABITS: Mapping[str, str] = MappingProxyType(
    {
        **{f"{prefix}l": f"{new}L" for prefix, new in (("m", "m"), ("u", "u"), ("n", "n"), ("", ""))},
        **{f"{micro}{rest}": f"u{rest}" for micro in "µμ" for rest in ("L", "m", "g", "M", "mol")},
        **{f"{micro}l": "uL" for micro in "µμ"},
        **{f"{micro}g/mL": "ug/mL" for micro in "µμ"},
        **dict.fromkeys(("°C", "℃", "C", "celsius", "degree_celsius", "oC"), "degC"),
        **dict.fromkeys(("°", "degree", "degrees"), "deg"),
        **dict.fromkeys(("seconds", "second", "sec", "secs"), "s"),
        **dict.fromkeys(("minutes", "minute", "mins"), "min"),
        **dict.fromkeys(("hours", "hour", "hr", "hrs"), "h"),
        **dict.fromkeys(("days", "day"), "d"),
        **dict.fromkeys(("\N{MULTIPLICATION SIGN}g", "x_g", "rcf"), "xg"),
        **dict.fromkeys(("milliliter", "milliliters", "millilitre", "millilitres", "cc"), "mL"),
        **dict.fromkeys(("microliter", "microliters", "microlitre", "microlitres"), "uL"),
        **dict.fromkeys(("percent",), "%"),
        **dict.fromkeys(("mm/s^2", "mm/s²"), "mm/s2"),
        **dict.fromkeys(("m/s^2", "m/s²"), "m/s2"),
        **dict.fromkeys(("N*m", "N.m"), "Nm"),
    }
)
"""Spellings that people write by habit, with the unit that they mean."""


def suggest_unit(written: str) -> str | None:
    """The unit that a wrong spelling stands for, if there is just one that it can mean."""
    if written in UNIT_HABITS:
        return UNIT_HABITS[written]
    alike = [symbol for symbol in UNITS if symbol.lower() == written.lower()]
    return alike[0] if len(alike) == 1 else None
