"""A YAML value that knows where everything in it stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from xei_lang.diagnostics import Span

Scalar = str | int | float | bool | None
Path = tuple[str | int, ...]


@dataclass(slots=True)
class Node:
    """A value of a file: a mapping (`items`, and in `keys` the place of each key), a list (`elements`) or a
    `scalar`.

    `span` covers the value. A tree is built once, by `yaml_reader`, and only read after that.
    """

    kind: Literal["map", "list", "scalar"]
    span: Span
    scalar: Scalar = None
    items: dict[str, Node] = field(default_factory=dict[str, "Node"])
    keys: dict[str, Span] = field(default_factory=dict[str, Span])
    elements: list[Node] = field(default_factory=list["Node"])

    def plain(self) -> object:
        """The value without places: dict, list, str, int, float, bool or None."""
        if self.kind == "map":
            return {key: node.plain() for key, node in self.items.items()}
        if self.kind == "list":
            return [node.plain() for node in self.elements]
        return self.scalar

    def child(self, step: str | int) -> Node | None:
        """The value under a key or at an index, or None."""
        if isinstance(step, int):
            return self.elements[step] if 0 <= step < len(self.elements) else None
        return self.items.get(step)

    def find(self, path: Path) -> Node:
        """The value at a path, or the deepest one on the way to it."""
        node = self
        for step in path:
            below = node.child(step)
            if below is None:
                return node
            node = below
        return node

    def span_of(self, *path: str | int) -> Span:
        """What to show for a path: a mapping by its key, anything else by its value."""
        node = self.find(path)
        if node.kind == "map" and path and isinstance(path[-1], str):
            return self.find(path[:-1]).keys.get(path[-1], node.span)
        return node.span

    def key_span(self, *path: str | int) -> Span:
        """Where the last key of a path stands; for an index, the value."""
        key = path[-1]
        parent = self.find(path[:-1])
        return parent.keys.get(key, parent.span) if isinstance(key, str) else self.find(path).span
