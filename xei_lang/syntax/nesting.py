"""A bound on how deep a tree may be, so that what walks it later may do so recursively."""

from __future__ import annotations

from typing import Any

from xei_lang.diagnostics import Span
from xei_lang.syntax.ast import children

MAX_NESTING = 150
_LEVELS_PER_CHARACTER = 3
"""Upper bound: `do{}` is four characters for a Step, a Do and a Block; `f(x)` four for four levels."""


def too_deep(root: Any) -> Span | None:
    """The place of a node that lies more than MAX_NESTING levels below the root, if there is one.

    Looks only into nodes whose text is long enough to hide such a depth, which in practice are few.
    """
    waiting = [(root, 0)]
    while waiting:
        node, depth = waiting.pop()
        if depth > MAX_NESTING:
            return Span(node.span.file, node.span.start, min(node.span.end, node.span.start + 1))
        length = node.span.end - node.span.start
        if depth + length * _LEVELS_PER_CHARACTER > MAX_NESTING:
            waiting.extend((child, depth + 1) for child in children(node))
    return None
