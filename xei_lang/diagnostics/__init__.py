"""Diagnostics as data: what is said, where, and how to mend it. `render/` shows them, at the edge."""

from __future__ import annotations

from xei_lang.diagnostics.catalogue import CATALOGUE, Entry
from xei_lang.diagnostics.diagnostic import (
    Applicability,
    Diagnostic,
    Diagnostics,
    Edit,
    Fix,
    Label,
    Severity,
    has_errors,
)
from xei_lang.diagnostics.span import Position, Source, Sources, Span
from xei_lang.diagnostics.suggest import did_you_mean

__all__ = [
    "CATALOGUE",
    "Applicability",
    "Diagnostic",
    "Diagnostics",
    "Edit",
    "Entry",
    "Fix",
    "Label",
    "Position",
    "Severity",
    "Source",
    "Sources",
    "Span",
    "did_you_mean",
    "has_errors",
]
