"""`# xei: allow XEI0501 because ...`: a comment that silences a warning of the statement that it belongs to.

It belongs to the statement or declaration that begins on its line, else to the next one.
"""

from __future__ import annotations

import re

from xei_lang.diagnostics import CATALOGUE, Diagnostic, Diagnostics, Source, Span
from xei_lang.syntax.ast import Comment, Module, walk

_ALLOW = re.compile(r"#+\s*xei:\s*allow\b\s*(?P<code>\w*)\s*(?:because\b\s*(?P<reason>.*))?")
_EXAMPLE = "write `# xei: allow XEI0501 because ...` with the reason"


def allowed(module: Module, source: Source, found: Diagnostics) -> Diagnostics:
    """What is left of the diagnostics, with a warning for each allow without a reason or an effect."""
    asked = [(comment, match) for comment in module.comments if (match := _ALLOW.match(comment.text))]
    if not asked:
        return found
    starts = sorted({(node.span.start, -node.span.end) for node in walk(module) if _is_whole(node)})
    silenced: set[Diagnostic] = set()
    said: list[Diagnostic] = []
    for comment, match in asked:
        hit = _hit(comment, match["code"], _extent(comment, source, starts), found)
        if not (match["reason"] or "").strip():
            said.append(
                _warning("XEI0502", "this allow gives no reason", comment.span, "expected `because ...`")
            )
        elif not hit:
            said.append(_without_effect(match["code"], comment.span))
        else:
            silenced.update(hit)
    return (*(item for item in found if item not in silenced), *said)


def _is_whole(node: object) -> bool:
    """Whether a node is a statement, a declaration, a parameter or an import."""
    names = ("Step", "Let", "Require", "Note", "Unmapped", "Param", "ObjectDecl", "Given", "GivenContains")
    return type(node).__name__ in (*names, "Import", "ImportTable", "Procedure", "Protocol")


def _extent(comment: Comment, source: Source, starts: list[tuple[int, int]]) -> Span:
    line = source.text.rfind("\n", 0, comment.span.start) + 1
    here = [item for item in starts if line <= item[0] < comment.span.start]
    after = here or [item for item in starts if item[0] > comment.span.start]
    start, end = after[0] if after else (0, 0)
    return Span(source.file, start, -end)


def _hit(comment: Comment, code: str, extent: Span, found: Diagnostics) -> list[Diagnostic]:
    return [
        item
        for item in found
        if item.code == code
        and item.severity == "warning"
        and item.span is not None
        and item.span.file == comment.span.file
        and extent.start <= item.span.start < extent.end
    ]


def _without_effect(code: str, span: Span) -> Diagnostic:
    entry = CATALOGUE.get(code)
    if entry is None:
        return _warning("XEI0503", f"there is no diagnostic `{code}`", span, "allows nothing")
    if entry.severity != "warning":
        return _warning("XEI0503", f"`{code}` is no warning and cannot be allowed", span, "allows nothing")
    return _warning("XEI0503", f"nothing here gives `{code}`", span, "allows nothing", "take the comment out")


def _warning(code: str, message: str, span: Span, label: str, help: str = _EXAMPLE) -> Diagnostic:
    return Diagnostic(code, message, span, label, help=(help,))
