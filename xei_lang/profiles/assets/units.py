"""The unit that the numbers of a file are in: files of meshes do not say it."""

from __future__ import annotations

import math

SCALES = {"m": 1.0, "mm": 0.001, "cm": 0.01, "in": 0.0254}
"""Metres in one of each unit."""
LEAST_M, MOST_M = 0.002, 3.0
"""What stands in a lab is at least so large, and at most, along its longest side."""
_USUAL_M = 0.1
_SAME = 0.12


def plausible(longest_m: float) -> bool:
    """Whether something in a lab may be so long."""
    return LEAST_M <= longest_m <= MOST_M


def likely_unit(longest: float) -> str:
    """The unit, metres or millimetres, in which a file's longest side is nearest to 10 cm; empty where that
    is no size for a thing either.
    """
    unit = min(("m", "mm"), key=lambda name: abs(math.log(longest * SCALES[name] / _USUAL_M)))
    return unit if plausible(longest * SCALES[unit]) else ""


def matching_unit(longest: float, stated_m: float) -> str:
    """The unit in which a file's longest side is the stated one, to 12 %; empty where there is none."""
    near = (name for name in SCALES if abs(math.log(longest * SCALES[name] / stated_m)) <= _SAME)
    return next(near, "")
