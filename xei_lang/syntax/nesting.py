"""Bounds on a text: how deep its tree may be, so that what walks it later may do so recursively, and how many
mistakes of it are told.
"""

from __future__ import annotations

from typing import Any

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.syntax.ast import children

MAX_NESTING = 150
MAX_FAULTS = 100
"""After so many the rest of the file is left unread: they have a cause of their own, such as a wrong file."""

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


def too_deeply_nested(span: Span) -> Diagnostic:
    """What is said of such a place."""
    return Diagnostic(
        "XEI0107",
        f"this is nested more than {MAX_NESTING} levels deep",
        span,
        help=("move the inner part into a `procedure`, or name parts of a long expression with `let`",),
    )
