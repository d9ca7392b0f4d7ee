"""Looking at a syntax tree without knowing its classes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from xei_lang.diagnostics import Span


def children(node: Any) -> Iterator[Any]:
    """The nodes right below a node, in the order of its fields; what has no span is no node."""
    for name in node.__slots__:
        value = getattr(node, name)
        for part in value if isinstance(value, tuple) else (value,):  # pyright: ignore[reportUnknownVariableType]
            if hasattr(part, "span"):  # pyright: ignore[reportUnknownArgumentType]
                yield part


def walk(node: Any) -> Iterator[Any]:
    """The node and all below it, each before what it holds; safe for trees of any depth."""
    waiting = [node]
    while waiting:
        current = waiting.pop()
        yield current
        waiting.extend(reversed(list(children(current))))


def equal_up_to_spans(left: object, right: object) -> bool:
    """Whether two trees say the same thing, wherever it stands."""
    waiting: list[tuple[Any, Any]] = [(left, right)]
    while waiting:
        a, b = waiting.pop()
        if type(a) is not type(b):
            return False
        if isinstance(a, Span):
            continue
        if isinstance(a, tuple):
            if len(a) != len(b):  # pyright: ignore[reportUnknownArgumentType]
                return False
            waiting.extend(zip(a, b, strict=True))  # pyright: ignore[reportUnknownArgumentType]
        elif hasattr(a, "span"):
            waiting.extend((getattr(a, name), getattr(b, name)) for name in a.__slots__)
        elif a != b:
            return False
    return True
