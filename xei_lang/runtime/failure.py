"""A failure of a run: what is wrong, and the handoff that is to blame for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.ir.trace import FailedStage


@dataclass(frozen=True, slots=True)
class Failure:
    """Why a run stops, and at which handoff."""

    stage: FailedStage
    diagnostic: Diagnostic


def failure(
    stage: FailedStage, code: str, message: str, span: Span | None = None, *, note: str = "", help: str = ""
) -> Failure:
    """A failure with at most one note (the rule) and one help (the way out)."""
    notes, helps = (note,) if note else (), (help,) if help else ()
    return Failure(stage, Diagnostic(code, message, span, notes=notes, help=helps))


def diagnostic_json(diagnostic: Diagnostic) -> dict[str, Any]:
    """A diagnostic as a trace keeps it: the words, and where they point (characters from 0)."""
    value: dict[str, Any] = {"code": diagnostic.code, "message": diagnostic.message}
    if diagnostic.span is not None:
        span = diagnostic.span
        value["source"] = {"file": span.file, "start": span.start, "end": span.end}
    if diagnostic.notes:
        value["notes"] = list(diagnostic.notes)
    if diagnostic.help:
        value["help"] = list(diagnostic.help)
    return value
