"""How a message of lowering words a length."""

from __future__ import annotations


def mm(length_m: float) -> str:
    """In millimetres, to a tenth: `12.5 mm`."""
    return f"{round(length_m * 1000, 1):g} mm"
