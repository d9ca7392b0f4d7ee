"""The form for people: headline, source lines with what is marked in them, rule, notes, help."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics
from xei_lang.diagnostics.render.terminal import columns, paint, visible, visible_lines
from xei_lang.diagnostics.span import Source, Sources, Span

_LONGEST_LINE = 200
_AROUND = 80


def render_full(diagnostics: Diagnostics, sources: Sources, color: bool = False) -> str:
    """All diagnostics in their order, a blank line between them; empty for none.

    A span in a file that is not among the sources is shown by its file's name only. Nothing from a source, a
    name or a message can reach the terminal as an escape code.
    """
    return "\n".join(_diagnostic(diagnostic, sources, color) for diagnostic in diagnostics)


@dataclass(frozen=True, slots=True)
class _Mark:
    """What is marked on one line: characters `[start, end)`, and the label, on the last line of a span."""

    line: int
    start: int
    end: int
    label: str
    is_primary: bool


def _diagnostic(diagnostic: Diagnostic, sources: Sources, color: bool) -> str:
    severity = diagnostic.severity
    head = paint(f"{severity}[{diagnostic.code}]", severity, color)
    headline, *more = visible_lines(diagnostic.message)
    lines = [f"{head}{paint(f': {headline}', 'bold', color)}", *(f"  {line}" for line in more)]
    files = _marks_by_file(diagnostic, sources)
    width = max((len(str(mark.line)) for _, marks in files for mark in marks), default=1)
    for index, (file, marks) in enumerate(files):
        if index and files[index - 1][1]:
            lines.append(_gutter("", width, color))
        arrow = paint(f"{' ' * width}{'-->' if index == 0 else ':::'}", "gutter", color)
        lines.append(f"{arrow} {_where(file, marks, sources, diagnostic)}")
        if marks:
            lines.append(_gutter("", width, color))
            lines.extend(_source_lines(sources[file], marks, width, severity, color))
    footer = list(_footer(diagnostic, width, color))
    if footer and any(marks for _, marks in files):
        lines.append(_gutter("", width, color))
    return "\n".join([*lines, *footer]) + "\n"


def _marks_by_file(diagnostic: Diagnostic, sources: Sources) -> list[tuple[str, list[_Mark]]]:
    """The marks of each file, the primary span's file first, then in the order of the labels."""
    if diagnostic.span is None:
        return []
    spans = [(diagnostic.span, diagnostic.label, True)]
    spans.extend((label.span, label.message, False) for label in diagnostic.labels)
    files: dict[str, list[_Mark]] = {}
    for span, label, is_primary in spans:
        marks = files.setdefault(span.file, [])
        if span.file in sources:
            marks.extend(_marks(sources[span.file], span, label, is_primary))
    return [(file, sorted(marks, key=_order)) for file, marks in files.items()]


def _order(mark: _Mark) -> tuple[int, int, int, bool]:
    return mark.line, mark.start, mark.end, mark.is_primary


def _marks(source: Source, span: Span, label: str, is_primary: bool) -> Iterator[_Mark]:
    """One mark for a span within a line; for a longer one its first line and, with the label, its last."""
    first = source.position(span.start)
    last = source.position(max(span.start, span.end - 1))
    if last.line == first.line:
        yield _Mark(first.line, first.column - 1, last.column - (span.end <= span.start), label, is_primary)
        return
    yield _Mark(first.line, first.column - 1, len(source.line(first.line)), "", is_primary)
    text = source.line(last.line)
    indent = min(len(text) - len(text.lstrip()), last.column - 1)
    yield _Mark(last.line, indent, last.column, label, is_primary)


def _where(file: str, marks: Iterable[_Mark], sources: Sources, diagnostic: Diagnostic) -> str:
    span = diagnostic.span
    source = sources.get(file)
    if source is None:
        said = [label.message for label in diagnostic.labels if label.span.file == file]
        if span is not None and span.file == file:
            said.insert(0, diagnostic.label)
        return ": ".join(visible(part) for part in (file, *said) if part)
    if span is not None and span.file == file:
        position = source.position(span.start)
        return f"{visible(file)}:{position.line}:{position.column}"
    first = next(iter(marks))
    return f"{visible(file)}:{first.line}:{first.start + 1}"


def _source_lines(
    source: Source, marks: list[_Mark], width: int, severity: str, color: bool
) -> Iterator[str]:
    for number in sorted({mark.line for mark in marks}):
        here = [mark for mark in marks if mark.line == number]
        text = source.line(number)
        begin, end = _window(text, here)
        left = "..." if begin else ""
        right = "..." if end < len(text) else ""
        shown = f"{left}{visible(text[begin:end])}{right}".rstrip()
        yield f"{_gutter(str(number), width, color)} {shown}".rstrip()
        for mark in here:
            start = min(max(mark.start, begin), end)
            before = columns(left + visible(text[begin:start]))
            length = max(1, columns(visible(text[start : min(mark.end, end)])))
            style = severity if mark.is_primary else "gutter"
            label, *more = visible_lines(mark.label)
            line = ("^" if mark.is_primary else "-") * length
            gutter = _gutter("", width, color)
            yield f"{gutter} {' ' * before}{paint(f'{line} {label}'.rstrip(), style, color)}"
            for part in more:
                yield f"{gutter} {' ' * (before + length + 1)}{paint(part, style, color)}"


def _window(text: str, marks: list[_Mark]) -> tuple[int, int]:
    """Which part of a line to show: all of it, but for very long ones."""
    if len(text) <= _LONGEST_LINE:
        return 0, len(text)
    begin = max(0, min(mark.start for mark in marks) - _AROUND)
    return begin, min(len(text), begin + 2 * _AROUND)


def _gutter(number: str, width: int, color: bool) -> str:
    return paint(f"{number.rjust(width)} |", "gutter", color)


def _footer(diagnostic: Diagnostic, width: int, color: bool) -> Iterator[str]:
    for note in diagnostic.notes:
        kind, text = ("rule", note.removeprefix("rule: ")) if note.startswith("rule: ") else ("note", note)
        yield from _footer_item(kind, text, width, color)
    for text in diagnostic.help:
        yield from _footer_item("help", text, width, color)


def _footer_item(kind: str, text: str, width: int, color: bool) -> Iterator[str]:
    first, *more = visible_lines(text)
    indent = " " * (width + 1)
    yield f"{indent}{paint('=', 'gutter', color)} {paint(f'{kind}:', 'bold', color)} {first}"
    for line in more:
        yield f"{indent}{' ' * (len(kind) + 4)}{line}".rstrip()
