"""The form for programs: one JSON object, described by `check.schema.json` beside this file."""

from __future__ import annotations

import json
from typing import Any

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics
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
    return json.dumps(report, indent=2, ensure_ascii=False) + "\n"


def _diagnostic(diagnostic: Diagnostic, sources: Sources) -> dict[str, Any]:
    fix = diagnostic.fix
    return {
        "code": diagnostic.code,
        "severity": diagnostic.severity,
        "message": diagnostic.message,
        **_place(diagnostic.span, sources),
        "labels": [{**_place(label.span, sources), "message": label.message} for label in diagnostic.labels],
        "notes": list(diagnostic.notes),
        "help": list(diagnostic.help),
        "fix": None
        if fix is None
        else {
            "applicability": fix.applicability,
            "edits": [{**_bytes(edit.span, sources), "text": edit.text} for edit in fix.edits],
        },
    }


def _place(span: Span | None, sources: Sources) -> dict[str, Any]:
    source = None if span is None else sources.get(span.file)
    if span is None or source is None:
        file = None if span is None else span.file
        return {"file": file, "line": None, "column": None, "end_line": None, "end_column": None}
    start, end = source.position(span.start), source.position(span.end)
    return {
        "file": span.file,
        "line": start.line,
        "column": start.column,
        "end_line": end.line,
        "end_column": end.column,
    }


def _bytes(span: Span, sources: Sources) -> dict[str, Any]:
    """An edit's place in bytes; the file of an edit is always among the sources, for its text was read."""
    source = sources[span.file]
    start, end = source.position(span.start).byte, source.position(span.end).byte
    return {"file": span.file, "start": start, "end": end}
