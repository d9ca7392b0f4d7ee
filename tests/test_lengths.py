"""Lengths in messages: rounded to what each is for, without trailing zeros or a negative zero."""

from __future__ import annotations

import pytest

from xei_lang.quantity.lengths import error_mm, exact_mm, millimetres, mm


@pytest.mark.parametrize(
    ("length_m", "tenth", "exact"),
    [
        (0.0125, "12.5 mm", "12.5 mm"),
        (0.01234567, "12.3 mm", "12.346 mm"),
        (0.030, "30 mm", "30 mm"),
        (0.1 + 0.2, "300 mm", "300 mm"),
        (-0.000_000_4, "0 mm", "0 mm"),
        (-0.002, "-2 mm", "-2 mm"),
        (1.234567, "1234.6 mm", "1234.567 mm"),
    ],
)
def test_lengths_are_rounded_to_a_tenth_or_a_micrometre(length_m, tenth, exact):
    assert (mm(length_m), f"{millimetres(length_m)} mm", exact_mm(length_m)) == (tenth, tenth, exact)


def test_an_error_keeps_its_tenth():
    assert [error_mm(value) for value in (0.0, 0.003, 0.00125)] == ["0.0 mm", "3.0 mm", "1.2 mm"]
