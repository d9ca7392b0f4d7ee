"""Values that a cell of a table gives as text: `2 mL`, `left`, `rack_1.slot("A1")`."""

from __future__ import annotations

from fractions import Fraction

from xei_lang.check.expectation import Expectation
from xei_lang.check.registry import Registry
from xei_lang.check.values import ObjectValue, PlaceValue, Val, Word, number
from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.skill_plan import StationRef
from xei_lang.quantity import parse_quantity

_MOST_DIGITS = 40


def read_value(given: str, expected: Expectation, registry: Registry) -> Val:  # noqa: PLR0911 one return a type
    """The value that a text stands for where a type is expected; whether it is of the type is seen later.

    Raises ValueError or QuantityError, with a reason for people, where it stands for none.
    """
    if expected.lists:
        raise ValueError("a cell holds one value, not a list")
    match expected.type:
        case "String":
            return given
        case "Bool":
            if given not in ("true", "false"):
                raise ValueError("expected `true` or `false`")
            return given == "true"
        case "Int" | "Float":
            return _number(given)
        case "Arm":
            return Word(given)
        case "Station":
            if given not in registry.stations:
                raise ValueError(f"stations are {', '.join(registry.stations)}")
            return StationRef(given)
        case "object" | "Place":
            return _object_or_place(given, registry)
        case _:
            return parse_quantity(given)


def _number(given: str) -> Val:
    digits = given.removeprefix("-").replace(".", "", 1)
    if not (digits.isascii() and digits.isdigit() and len(digits) <= _MOST_DIGITS):
        raise ValueError(f"`{given}` is not a plain number such as 3 or 0.5")
    return number(Fraction(given))


def _object_or_place(given: str, registry: Registry) -> Val:
    owner, dot, rest = given.partition(".")
    thing = registry.objects.get(owner)
    if thing is None:
        close = did_you_mean(owner, registry.objects)
        raise ValueError(f"there is no object `{owner}`" + (f"; did you mean `{close[0]}`?" if close else ""))
    if not dot:
        return ObjectValue(owner, thing)
    for kind in ("slot", "spot"):
        if rest.startswith(f'{kind}("') and rest.endswith('")'):
            key = rest[len(kind) + 2 : -2]
            return PlaceValue(ObjectValue(owner, thing), kind, key)
    raise ValueError('a place is written as `rack_1.slot("A1")`')
