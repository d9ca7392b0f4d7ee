"""What the checker says of protocols, as it is to be said of a plan in JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace

from xei_lang.check.report import MAX_ERRORS
from xei_lang.diagnostics import Diagnostic, Diagnostics, Edit, Fix, Source

_HOW_TO_WRITE_IT = ("XEI0302",)
"""Codes whose help shows a statement of the language."""


_LABELS = {
    "neither a skill of this robot nor a procedure of this file": "no skill of this robot has this name",
    "no object, station, parameter or variable has this name": "no object or station has this name",
}


def in_json(diagnostic: Diagnostic, source: Source) -> Diagnostic:
    """The same diagnostic; a fix puts its words between quotes, and is dropped where that is no text."""
    help_ = () if diagnostic.code in _HOW_TO_WRITE_IT else diagnostic.help
    label = _LABELS.get(diagnostic.label, diagnostic.label)
    return replace(diagnostic, label=label, help=help_, fix=_fix(diagnostic.fix, source))


def first_ones(diagnostics: Iterable[Diagnostic]) -> Diagnostics:
    """The diagnostics in the order of the text, as many as anyone reads."""
    said = sorted(diagnostics, key=lambda item: (item.span.start if item.span else 0, item.code))
    if len(said) <= MAX_ERRORS:
        return tuple(said)
    message = f"only the first {MAX_ERRORS} errors are shown"
    last = Diagnostic("XEI0109", message, said[MAX_ERRORS].span, help=("mend these first",))
    return (*said[:MAX_ERRORS], last)


def _fix(fix: Fix | None, source: Source) -> Fix | None:
    if fix is None or not all(_is_text(source.slice(edit.span)) for edit in fix.edits):
        return None
    edits = tuple(Edit(edit.span, json.dumps(edit.text, ensure_ascii=False)) for edit in fix.edits)
    return Fix("unsafe", edits)


def _is_text(words: str) -> bool:
    return len(words) >= 2 and words[0] == words[-1] == '"'
