"""Annotations of a GitHub workflow: one command a line, which its runner shows beside the code.

The form is that of "Workflow commands for GitHub Actions", section "Setting an error message". The runner
shows ten annotations of each kind a step, so errors come first.
"""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics
from xei_lang.diagnostics.render.region import region_of
from xei_lang.diagnostics.render.terminal import visible, visible_lines
from xei_lang.diagnostics.span import Sources

_COMMANDS = {"error": "error", "warning": "warning", "info": "notice"}
_RANK = ("error", "warning", "info")


def render_github(diagnostics: Diagnostics, sources: Sources) -> str:
    """Errors, then warnings, then the rest, each in their order; label, notes and help follow the message."""
    ranked = sorted(diagnostics, key=lambda item: _RANK.index(item.severity))
    return "".join(f"{_command(diagnostic, sources)}\n" for diagnostic in ranked)


def _command(diagnostic: Diagnostic, sources: Sources) -> str:
    properties = ",".join(f"{name}={value}" for name, value in _properties(diagnostic, sources))
    said = "%0A".join(_data(line) for line in _lines(diagnostic))
    return f"::{_COMMANDS[diagnostic.severity]} {properties}::{said}"


def _properties(diagnostic: Diagnostic, sources: Sources) -> Iterator[tuple[str, str]]:
    if diagnostic.span is not None:
        yield "file", _property(diagnostic.span.file)
    region = region_of(diagnostic.span, sources)
    if region is not None:
        yield "line", str(region.line)
        if region.end_line == region.line:
            # Columns are understood on a single line only.
            yield "col", str(region.column)
            yield "endColumn", str(region.end_column)
        else:
            yield "endLine", str(region.end_line)
    yield "title", diagnostic.code


def _lines(diagnostic: Diagnostic) -> Iterator[str]:
    yield from visible_lines(diagnostic.message)
    if diagnostic.label:
        yield from visible_lines(diagnostic.label)
    for note in diagnostic.notes:
        yield from visible_lines(note if note.startswith("rule: ") else f"note: {note}")
    for text in diagnostic.help:
        yield from visible_lines(f"help: {text}")


def _data(text: str) -> str:
    return text.replace("%", "%25")


def _property(text: str) -> str:
    return _data(visible(text)).replace(":", "%3A").replace(",", "%2C")
