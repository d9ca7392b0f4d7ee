"""What a tolerance states: a bound that no error exceeds, or a standard deviation of it.

A standard deviation is that of the error along its least certain direction (of a position) or about its least
certain axis (of a rotation). It is held against a gap as `SIGMAS` times itself: for normal errors 99.7 % of
them stay within along any one direction, and at least 97.1 % of them as a distance in space (chi-square with
three degrees of freedom).
"""

from __future__ import annotations

import math
from typing import Literal

ToleranceKind = Literal["bound", "std"]
SIGMAS = 3.0
"""How many standard deviations stand for a bound."""


def as_bound(tolerance: float, kind: ToleranceKind) -> float:
    """What an error is taken to be at most."""
    return SIGMAS * tolerance if kind == "std" else tolerance


def tolerance_text(position_m: float, rotation_rad: float, kind: ToleranceKind) -> str:
    """`3 mm and 0.5 deg`, or `3 x (0.2 mm and 0.01 deg)` where these are standard deviations."""
    text = f"{_digits(1e3 * position_m)} mm and {_digits(math.degrees(rotation_rad))} deg"
    return f"{SIGMAS:g} x ({text})" if kind == "std" else text


def _digits(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}"
