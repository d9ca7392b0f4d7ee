"""A syntax tree as text for people: a line a node, indented, with where it begins.

Nothing here knows the classes of nodes: a new one is shown as soon as it exists.
"""

from __future__ import annotations

from typing import Any, cast

from xei_lang.diagnostics import Source, Span
from xei_lang.syntax.ast import Module

_INDENT = "  "
_Entry = tuple[int, str, Any]


def to_text(module: Module, source: Source) -> str:
    """The tree, `field: Class line:column value ...`; `source` is the text that the module was parsed from.

    Plain values stand in the line of their node; what is absent (None, no items, an empty text) is left out.
    """
    lines: list[str] = []
    waiting: list[_Entry] = [(0, "", module)]
    while waiting:
        depth, field, node = waiting.pop()
        plain, below = _parts(node)
        place = source.position(node.span.start)
        words = [type(node).__name__, f"{place.line}:{place.column}", *plain]
        lines.append(f"{_INDENT * depth}{field}{' '.join(words)}\n")
        waiting.extend((depth + 1, f"{name}: ", child) for name, child in reversed(below))
    return "".join(lines)


def _parts(node: Any) -> tuple[list[str], list[tuple[str, Any]]]:
    """The values that a node holds as words, and the nodes below it with the names of their fields."""
    plain: list[str] = []
    below: list[tuple[str, Any]] = []
    for name in node.__slots__:
        value: Any = getattr(node, name)
        parts = cast(tuple[Any, ...], value) if isinstance(value, tuple) else (value,)
        for part in parts:
            if hasattr(part, "span"):
                below.append((name, part))
            elif not isinstance(part, Span) and part is not None and part != "":
                plain.append(f"{name}={_word(part)}")
    return plain, below


def _word(value: Any) -> str:
    if isinstance(value, str):
        return repr(value)
    return str(value).lower() if isinstance(value, bool) else str(value)
