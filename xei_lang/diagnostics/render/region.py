"""Where a span stands, in the lines and columns that forms for programs share."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics.span import Sources, Span


@dataclass(frozen=True, slots=True)
class Region:
    """Lines and columns from 1, columns in characters, the end exclusive."""

    line: int
    column: int
    end_line: int
    end_column: int


def region_of(span: Span | None, sources: Sources) -> Region | None:
    """The region of a span; None for what has no place, or stands in a file that is not among the sources."""
    source = None if span is None else sources.get(span.file)
    if span is None or source is None:
        return None
    start, end = source.position(span.start), source.position(max(span.start, span.end))
    return Region(start.line, start.column, end.line, end.column)
