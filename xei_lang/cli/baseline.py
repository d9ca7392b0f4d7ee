"""`--baseline`: what an earlier report already holds is known, and only the rest is told.

A report of `--format json` holds no line of text, so there a diagnostic is known by its file, its code and
its message; one of `--format sarif` carries fingerprints, which also outlive a change of wording. Neither
knows line numbers: a message that counts lines is compared without them.
"""

from __future__ import annotations

import json
import os
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal
from urllib.parse import unquote

from xei_lang.cli.check_run import Checked
from xei_lang.diagnostics import Diagnostic, Sources
from xei_lang.diagnostics.fingerprint import fingerprints
from xei_lang.syntax.reading import read_source

_Known = tuple[str, str]
"""A file (empty for what stands in none), and what a diagnostic in it is known by."""

_LINE = re.compile(r"\b(line|lines) \d+")


@dataclass(frozen=True, slots=True, eq=False)
class Baseline:
    """What is known, and how often; `by` says what stands for a diagnostic: its words or its fingerprint."""

    by: Literal["words", "fingerprint"]
    known: Counter[_Known]


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """The files with what is new; how many known diagnostics were left out, and how many no longer occur.

    Of files that were not checked nobody can tell whether theirs still occur, unless they are gone.
    """

    checked: list[Checked]
    hidden: int
    gone: int


def read_baseline(path: Path) -> Baseline | Diagnostic:
    """The report in a file, or why it is none."""
    source, problems = read_source(path, str(path))
    if source is None:
        return problems[0] if problems[0].code == "XEI0101" else _unusable(path, problems[0].message)
    try:
        report = json.loads(source.text)
    except (ValueError, RecursionError):
        return _unusable(path, f"`{path}` is not JSON" if source.text.strip() else f"`{path}` is empty")
    try:
        return _sarif(report) if "runs" in report else _json(report)
    except (TypeError, KeyError, ValueError, AttributeError):
        return _unusable(path, f"`{path}` is no report of `xei check`")


def compare(checked: Sequence[Checked], sources: Sources, baseline: Baseline) -> Compared:
    """Take out of the files what the baseline knows, as often as it knows it."""
    left = baseline.known.copy()
    kept: list[Checked] = []
    every = tuple(item for one in checked for item in one.said)
    names = iter(_names(every, sources, baseline.by))
    for one in checked:
        new: list[Diagnostic] = []
        for item in one.said:
            known = next(names)
            if left[known] > 0:
                left[known] -= 1
            else:
                new.append(item)
        kept.append(replace(one, said=tuple(new)))
    hidden = len(every) - sum(len(one.said) for one in kept)
    here = {os.path.realpath(one.file) for one in checked}
    gone = sum(number for (file, _), number in left.items() if _is_told_of(file, here))
    return Compared(kept, hidden, gone)


def _names(said: Sequence[Diagnostic], sources: Sources, by: str) -> list[_Known]:
    files = ["" if item.span is None else item.span.file for item in said]
    if by == "words":
        return [(file, _words(item.code, item.message)) for file, item in zip(files, said, strict=True)]
    return list(zip(files, fingerprints(tuple(said), sources), strict=True))


def _words(code: str, message: str) -> str:
    return f"{code} " + _LINE.sub(r"\1", message)


def _json(report: Any) -> Baseline:
    if report["version"] != 1:
        raise ValueError("another version")
    known = [
        (_text(item["file"] or ""), _words(_text(item["code"]), _text(item["message"])))
        for item in report["diagnostics"]
    ]
    return Baseline("words", Counter(known))


def _sarif(report: Any) -> Baseline:
    results = [result for run in report["runs"] for result in run["results"]]
    return Baseline(
        "fingerprint",
        Counter((_place(result), _text(result["partialFingerprints"]["xei/v1"])) for result in results),
    )


def _place(result: Any) -> str:
    for location in result.get("locations", ()):
        return unquote(location["physicalLocation"]["artifactLocation"]["uri"].removeprefix("file://"))
    return ""


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def _is_told_of(file: str, here: set[str]) -> bool:
    return bool(file) and (os.path.realpath(file) in here or not os.path.lexists(file))


def _unusable(path: Path, message: str) -> Diagnostic:
    return Diagnostic(
        "XEI0125",
        message,
        notes=("a baseline is what `xei check --format json` or `--format sarif` printed",),
        help=(f"write it anew: `xei check --format json PATH > {path}`",),
    )
