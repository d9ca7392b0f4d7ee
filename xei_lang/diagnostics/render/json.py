"""The form for programs: one JSON object, described by `check.schema.json` beside this file."""

from __future__ import annotations

from typing import Any

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics, Fix
from xei_lang.diagnostics.render.json_text import json_text
from xei_lang.diagnostics.render.region import region_of
from xei_lang.diagnostics.span import Sources, Span


def render_json(diagnostics: Diagnostics, sources: Sources, files: int) -> str:
    """All diagnostics in their order, and a summary; `files` is how many were checked.

    Lines and columns count from 1, columns in characters, ends are exclusive; offsets of a fix count UTF-8
    bytes from 0. What has no place has null for it.
    """
    severities = [diagnostic.severity for diagnostic in diagnostics]
    report = {
        "version": 1,
        "diagnostics": [_diagnostic(diagnostic, sources) for diagnostic in diagnostics],
        "summary": {
            "files": files,
            "errors": severities.count("error"),
            "warnings": severities.count("warning"),
        },
    }
    return json_text(report)


def _diagnostic(diagnostic: Diagnostic, sources: Sources) -> dict[str, Any]:
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        **_place(diagnostic.span, sources),
        "labels": [{**_place(label.span, sources), "message": label.message} for label in diagnostic.labels],
        "notes": list(diagnostic.notes),
        "help": list(diagnostic.help),
        "fix": _fix(diagnostic.fix, sources),
    }


def _place(span: Span | None, sources: Sources) -> dict[str, Any]:
    region = region_of(span, sources)
    return {
        "file": None if span is None else span.file,
        "line": None if region is None else region.line,
        "column": None if region is None else region.column,
        "end_line": None if region is None else region.end_line,
        "end_column": None if region is None else region.end_column,
    }


def _fix(fix: Fix | None, sources: Sources) -> dict[str, Any] | None:
    """A fix with its places in bytes; none where a file of it is not among the sources."""
    if fix is None or any(edit.span.file not in sources for edit in fix.edits):
        return None
    edits = [{**_bytes(edit.span, sources), "text": edit.text} for edit in fix.edits]
    return {"applicability": fix.applicability, "edits": edits}


def _bytes(span: Span, sources: Sources) -> dict[str, Any]:
    source = sources[span.file]
    start, end = source.position(span.start).byte, source.position(span.end).byte
    return {"file": span.file, "start": start, "end": end}
