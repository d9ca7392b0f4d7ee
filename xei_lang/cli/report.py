"""Showing diagnostics to people and to programs; the only place where commands render them."""

from __future__ import annotations

from pathlib import Path

import click

from xei_lang.cli.exit_codes import INPUT_HAS_ERRORS, WRONG_USAGE
from xei_lang.diagnostics import Diagnostics, Source, Sources
from xei_lang.diagnostics.options import option_source
from xei_lang.syntax.reading import read_source

UNUSABLE_FILES = frozenset({"XEI0101", "XEI0125"})
"""Codes for files that are missing or cannot be used: wrong usage rather than a wrong protocol."""


def show(diagnostics: Diagnostics, sources: Sources, color: bool) -> None:
    """Write diagnostics to stderr in full, with the source lines they speak of."""
    if diagnostics:
        from xei_lang.diagnostics.render.full import render_full

        click.echo(render_full(diagnostics, with_quoted(diagnostics, sources), color), err=True, nl=False)


def with_quoted(diagnostics: Diagnostics, sources: Sources) -> dict[str, Source]:
    """The sources, with the texts of other files that the diagnostics point into (profiles, tables)."""
    known = dict(sources)
    for file in sorted(_files(diagnostics) - known.keys()):
        source = option_source(file) or read_source(Path(file), file)[0]
        if source is not None:
            known[file] = source
    return known


def exit_code(diagnostics: Diagnostics) -> int:
    """The exit code that the errors among these ask for."""
    codes = {diagnostic.code for diagnostic in diagnostics if diagnostic.severity == "error"}
    if not codes:
        return 0
    return WRONG_USAGE if codes <= UNUSABLE_FILES else INPUT_HAS_ERRORS


def _files(diagnostics: Diagnostics) -> set[str]:
    spans = [diagnostic.span for diagnostic in diagnostics if diagnostic.span is not None]
    spans += [label.span for diagnostic in diagnostics for label in diagnostic.labels]
    return {span.file for span in spans}
