"""What can be believed of later findings in a file that did not follow the grammar everywhere.

A check of what could be read must not blame the reader for what could not: a name whose declaration was left
out is not unknown, and an argument that was left out is not missing.
"""

from __future__ import annotations

import re

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span

_WORD = re.compile(r"[A-Za-z_]\w*")
_QUOTED = re.compile(r"`([^`]*)`")
_DECLARING = frozenset(
    ["object", "param", "let", "for", "measure", "start", "import", "procedure", "protocol"]
)
_UNKNOWN = frozenset({"XEI0201", "XEI0202", "XEI0211"})
"""A name, skill or step that is not known: it may be what a damaged declaration made."""
_LOCAL = ("XEI02", "XEI03")
"""Names, types and arguments: what one statement says. States, times and warnings hang on all the others."""


def trusted(said: Diagnostics, source: Source, damaged: tuple[Span, ...]) -> Diagnostics:
    """Those findings in `source` that have nothing to do with its damaged parts."""
    lines = {
        line
        for span in damaged
        for line in range(source.line_number(span.start), source.line_number(span.end) + 1)
    }
    words = {word for line in sorted(lines) for word in _WORD.findall(source.line(line))}
    return tuple(item for item in said if _is_apart(item, source, lines, words))


def _is_apart(item: Diagnostic, source: Source, lines: set[int], words: set[str]) -> bool:
    spans = [span for span in (item.span, *(label.span for label in item.labels)) if span is not None]
    if item.severity != "error" or not item.code.startswith(_LOCAL) or not spans:
        return False
    if any(span.file != source.file for span in spans):
        return False
    if item.code in _UNKNOWN and words & _DECLARING:
        return False
    touched = {
        line
        for span in spans
        for line in (source.line_number(span.start), source.line_number(max(span.start, span.end - 1)))
    }
    declared = [text for line in sorted(touched) if _declares(text := source.line(line))]
    texts = [*_QUOTED.findall(item.message), *(source.slice(span) for span in spans), *declared]
    mentioned = {word for text in texts for word in _WORD.findall(text)} - _DECLARING
    return not (touched & lines) and not (mentioned & words)


def _declares(line: str) -> bool:
    first = _WORD.search(line)
    return first is not None and first[0] in _DECLARING
