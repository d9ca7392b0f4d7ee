"""Quantities with dimensions: exact, unit-aware, and cheap to import."""

from __future__ import annotations

from xei_lang.quantity.dimension import TYPE_DIMENSIONS, Dimension
from xei_lang.quantity.quantity import DimensionError, Quantity, QuantityError, parse_quantity, quantity
from xei_lang.quantity.units import UNIT_HABITS, UNITS, Unit, suggest_unit

__all__ = [
    "TYPE_DIMENSIONS",
    "UNITS",
    "UNIT_HABITS",
    "Dimension",
    "DimensionError",
    "Quantity",
    "QuantityError",
    "Unit",
    "parse_quantity",
    "quantity",
    "suggest_unit",
]
