"""The form for programs: as described, valid against its schema, with bytes where bytes are said."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema

import xei_lang.diagnostics.render
from xei_lang.diagnostics import Diagnostic, Edit, Fix, Label, Source, Span
from xei_lang.diagnostics.render.json import render_json

SCHEMA = json.loads(Path(xei_lang.diagnostics.render.__file__).with_name("check.schema.json").read_text())
SOURCE = Source("t.xei", 'note "5 \u00b5L" pick(object=a)\nwait 5 ul\n')


def report(*diagnostics: Diagnostic) -> dict[str, Any]:
    text = render_json(diagnostics, {"t.xei": SOURCE}, files=1)
    assert text.endswith("}\n")
    value = json.loads(text)
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.Draft202012Validator(SCHEMA).validate(value)
    return value


def test_fixed_form() -> None:
    start = SOURCE.text.index("5 ul")
    span = Span("t.xei", start, start + 4)
    value = report(
        Diagnostic(
            "XEI0104",
            "`ul` is not a unit",
            span,
            "expected `uL`",
            (Label(Span("t.xei", 12, 16), "seen here"),),
            ("rule: units.md:3",),
            ("write `5 uL`",),
            Fix("safe", (Edit(span, "5 uL"),)),
        )
    )
    assert value == {
        "version": 1,
        "diagnostics": [
            {
                "code": "XEI0104",
                "severity": "error",
                "message": "`ul` is not a unit",
                "file": "t.xei",
                "line": 2,
                "column": 6,
                "end_line": 2,
                "end_column": 10,
                "labels": [
                    {
                        "file": "t.xei",
                        "line": 1,
                        "column": 13,
                        "end_line": 1,
                        "end_column": 17,
                        "message": "seen here",
                    }
                ],
                "notes": ["rule: units.md:3"],
                "help": ["write `5 uL`"],
                "fix": {
                    "applicability": "safe",
                    "edits": [{"file": "t.xei", "start": start + 1, "end": start + 5, "text": "5 uL"}],
                },
            }
        ],
        "summary": {"files": 1, "errors": 1, "warnings": 0},
    }
    edit = value["diagnostics"][0]["fix"]["edits"][0]
    assert SOURCE.text.encode()[edit["start"] : edit["end"]] == b"5 ul"


def test_what_has_no_place_has_nulls() -> None:
    without_span, unread = report(
        Diagnostic("XEI0101", "`gone.xei` does not exist"),
        Diagnostic("XEI0104", "in a file that was not read", Span("other.csv", 3, 4)),
    )["diagnostics"]
    assert (without_span["file"], without_span["line"], without_span["fix"]) == (None, None, None)
    assert (unread["file"], unread["line"]) == ("other.csv", None)


def test_nothing_to_say() -> None:
    assert report() == {"version": 1, "diagnostics": [], "summary": {"files": 1, "errors": 0, "warnings": 0}}


def test_schema_refuses_other_forms() -> None:
    validator = jsonschema.Draft202012Validator(SCHEMA)
    value = report(Diagnostic("XEI0101", "`gone.xei` does not exist"))
    assert not validator.is_valid(value | {"extra": 1})
    del value["diagnostics"][0]["help"]
    assert not validator.is_valid(value)
