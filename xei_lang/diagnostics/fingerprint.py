"""A name for a diagnostic that stays while lines move: what a baseline and code scanners recognise it by."""

from __future__ import annotations

import hashlib

from xei_lang.diagnostics.diagnostic import Diagnostic, Diagnostics
from xei_lang.diagnostics.span import Sources


def fingerprints(diagnostics: Diagnostics, sources: Sources) -> tuple[str, ...]:
    """For each diagnostic the hash of its code, its line's text and which of the like in its file it is.

    White space in a line does not count, nor do lines above it. What has no line is known by its message.
    The file's name does not count either: whoever compares fingerprints has the file beside them.
    """
    seen: dict[tuple[str, str, str], int] = {}
    found: list[str] = []
    for diagnostic in diagnostics:
        key = (
            "" if diagnostic.span is None else diagnostic.span.file,
            diagnostic.code,
            _text(diagnostic, sources),
        )
        seen[key] = seen.get(key, 0) + 1
        found.append(
            hashlib.sha256("\0".join((*key[1:], str(seen[key]))).encode(errors="replace")).hexdigest()
        )
    return tuple(found)


def _text(diagnostic: Diagnostic, sources: Sources) -> str:
    source = None if diagnostic.span is None else sources.get(diagnostic.span.file)
    if diagnostic.span is None or source is None:
        return diagnostic.message
    return " ".join(source.line(source.line_number(diagnostic.span.start)).split())
