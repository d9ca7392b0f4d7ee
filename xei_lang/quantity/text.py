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
    numerator, denominator = abs(number.numerator), number.denominator
    if numerator >= _LARGEST * denominator:
        return f"{'less than -' if number < 0 else 'more than '}10^30"
    places = _exact_places(denominator)
    if places is None:
        magnitude = Fraction(numerator, denominator)
        places = _rounded_places(magnitude)
        scaled = round(magnitude * 10**places)
    else:
        scaled = numerator * 10**places // denominator
    digits = _decimal(scaled, places)
    return digits if digits == "0" or number.numerator >= 0 else f"-{digits}"


def _exact_places(denominator: int) -> int | None:
    """How many decimals write a fraction with this denominator exactly, or None where there are too many."""
    left, twos, fives = denominator, 0, 0
    while left % 2 == 0:
        left, twos = left // 2, twos + 1
    while left % 5 == 0:
        left, fives = left // 5, fives + 1
    places = max(twos, fives)
    return places if left == 1 and places <= _EXACT_DIGITS else None


def _rounded_places(number: Fraction) -> int:
    places = 0
    while number and number * 10**places < 10 ** (_ROUNDED_DIGITS - 1) and places < 40:
        places += 1
    return places


def _decimal(scaled: int, places: int) -> str:
    if not places:
        return str(scaled)
    whole, part = divmod(scaled, 10**places)
    decimals = str(part).zfill(places).rstrip("0")
    return f"{whole}.{decimals}" if decimals else str(whole)
