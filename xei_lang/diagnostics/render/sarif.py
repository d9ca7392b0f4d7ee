"""The form for code scanners: SARIF 2.1.0 (OASIS Standard, Static Analysis Results Interchange Format).

Section numbers in comments are those of the standard.
"""

from __future__ import annotations

from typing import Any
from urllib.parse import quote

from xei_lang.diagnostics.catalogue import CATALOGUE
from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics, Fix
from xei_lang.diagnostics.fingerprint import fingerprints
from xei_lang.diagnostics.render.json_text import json_text
from xei_lang.diagnostics.render.region import region_of
from xei_lang.diagnostics.span import Sources, Span

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {"error": "error", "warning": "warning", "info": "note"}
_ROOT = "%SRCROOT%"
"""The name under which a reader knows the working folder, to which relative paths refer (3.4.4)."""


def render_sarif(diagnostics: Diagnostics, sources: Sources, version: str) -> str:
    """One run with a result for each diagnostic, in their order; `version` is that of xei.

    The rules are the catalogue's entries of the codes that occur.
    """
    codes = sorted({diagnostic.code for diagnostic in diagnostics})
    names = fingerprints(diagnostics, sources)
    results = [
        _result(diagnostic, codes.index(diagnostic.code), name, sources)
        for diagnostic, name in zip(diagnostics, names, strict=True)
    ]
    driver = {"name": "xei", "version": version, "rules": [_rule(code) for code in codes]}
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": results}
    return json_text({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]})


def _rule(code: str) -> dict[str, Any]:
    entry = CATALOGUE[code]
    return {
        "id": code,
        "shortDescription": {"text": entry.title},
        "help": {"text": f"`xei explain {code}` says more"},
        "defaultConfiguration": {"level": _LEVELS[entry.severity]},
    }


def _result(diagnostic: Diagnostic, rule: int, name: str, sources: Sources) -> dict[str, Any]:
    result: dict[str, Any] = {
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": _LEVELS[diagnostic.severity],
        "message": {"text": _message(diagnostic)},
        "partialFingerprints": {"xei/v1": name},
    }
    if diagnostic.span is not None:
        result["locations"] = [_location(diagnostic.span, diagnostic.label, sources)]
    if diagnostic.labels:
        result["relatedLocations"] = [
            {"id": index, **_location(label.span, label.message, sources)}
            for index, label in enumerate(diagnostic.labels, start=1)
        ]
    fix = _fix(diagnostic, sources)
    return result if fix is None else {**result, "fixes": [fix]}


def _message(diagnostic: Diagnostic) -> str:
    notes = (note if note.startswith("rule: ") else f"note: {note}" for note in diagnostic.notes)
    return "\n".join((diagnostic.message, *notes, *(f"help: {text}" for text in diagnostic.help)))


def _location(span: Span, message: str, sources: Sources) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": _artifact(span.file)}
    if span.file in sources:
        place["region"] = _region(span, sources)
    location: dict[str, Any] = {"physicalLocation": place}
    return {**location, "message": {"text": message}} if message else location


def _artifact(file: str) -> dict[str, str]:
    """A path as a URI reference (3.4.3): bytes that a URI cannot hold are percent-encoded."""
    uri = quote(file.encode("utf-8", "surrogatepass"))
    return {"uri": f"file://{uri}"} if file.startswith("/") else {"uri": uri, "uriBaseId": _ROOT}


def _region(span: Span, sources: Sources) -> dict[str, int]:
    region = region_of(span, sources)
    assert region is not None
    return {
        "startLine": region.line,
        "startColumn": region.column,
        "endLine": region.end_line,
        "endColumn": region.end_column,
    }


def _fix(diagnostic: Diagnostic, sources: Sources) -> dict[str, Any] | None:
    """The fix (3.55), where it can be applied: not one for display only, or of a file that is unknown."""
    fix = diagnostic.fix
    if fix is None or fix.applicability == "display" or not fix.edits:
        return None
    if any(edit.span.file not in sources for edit in fix.edits):
        return None
    text = diagnostic.help[0] if diagnostic.help else "replace this"
    files = list(dict.fromkeys(edit.span.file for edit in fix.edits))
    return {
        "description": {"text": text},
        "artifactChanges": [_change(file, fix, sources) for file in files],
        "properties": {"applicability": fix.applicability},
    }


def _change(file: str, fix: Fix, sources: Sources) -> dict[str, Any]:
    edits = (edit for edit in fix.edits if edit.span.file == file)
    return {
        "artifactLocation": _artifact(file),
        "replacements": [
            {"deletedRegion": _region(edit.span, sources), "insertedContent": {"text": edit.text}}
            for edit in edits
        ],
    }
