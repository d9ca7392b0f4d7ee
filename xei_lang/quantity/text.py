"""A rational number as people write it."""

from __future__ import annotations

from fractions import Fraction

_EXACT_DIGITS = 12
_ROUNDED_DIGITS = 6
_LARGEST = 10**30


def format_magnitude(number: Fraction) -> str:
    """A decimal without exponent: exact where 12 digits suffice, else rounded to 6 significant ones.

    Values past 10^30 are only said to be so: no quantity in a laboratory is that large.
    """
    sign = "-" if number < 0 else ""
    number = abs(number)
    if number >= _LARGEST:
        return f"{'less than -' if sign else 'more than '}10^30"
    exact = _exact_places(number)
    digits = _decimal(number, _rounded_places(number) if exact is None else exact)
    return digits if digits == "0" else sign + digits


def _exact_places(number: Fraction) -> int | None:
    """How many decimals write the number exactly, or None where there are too many."""
    denominator, twos, fives = number.denominator, 0, 0
    while denominator % 2 == 0:
        denominator, twos = denominator // 2, twos + 1
    while denominator % 5 == 0:
        denominator, fives = denominator // 5, fives + 1
    places = max(twos, fives)
    return places if denominator == 1 and places <= _EXACT_DIGITS else None


def _rounded_places(number: Fraction) -> int:
    places = 0
    while number and number * 10**places < 10 ** (_ROUNDED_DIGITS - 1) and places < 40:
        places += 1
    return places


def _decimal(number: Fraction, places: int) -> str:
    scaled = round(number * 10**places)
    if not places:
        return str(scaled)
    whole, part = divmod(scaled, 10**places)
    decimals = str(part).zfill(places).rstrip("0")
    return f"{whole}.{decimals}" if decimals else str(whole)
