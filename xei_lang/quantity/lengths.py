"""A length in the words of a message: millimetres, rounded to what the message is about."""

from __future__ import annotations


def millimetres(length_m: float) -> str:
    """`12.5`: the number alone, to a tenth, without trailing zeros or a negative zero."""
    return f"{round(length_m * 1000, 1) + 0.0:g}"


def mm(length_m: float) -> str:
    """`12.5 mm`: to a tenth, as closely as lengths are measured on a bench."""
    return f"{millimetres(length_m)} mm"


def exact_mm(length_m: float) -> str:
    """`12.345 mm`: to a micrometre, as closely as lengths are stated and held against a limit."""
    return f"{round(length_m * 1000, 3) + 0.0:.10g} mm"


def error_mm(length_m: float) -> str:
    """`3.0 mm`: with its tenth even where that is zero, for how far off something may be."""
    return f"{length_m * 1000:.1f} mm"
