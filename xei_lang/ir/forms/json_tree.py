"""JSON as a tree in which every value and every key knows where it stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

from xei_lang.diagnostics import Span

NodeKind = Literal["object", "array", "string", "number", "boolean", "null"]


@dataclass(slots=True, eq=False)
class JsonNode:
    """One value. `value` is that of a string, number, boolean or null; an object has `items` with the spans
    of their names in `keys`, an array has `elements`. Spans of texts cover their quotes.
    """

    kind: NodeKind
    span: Span
    value: str | int | float | bool | None = None
    items: dict[str, JsonNode] = field(default_factory=dict[str, "JsonNode"])
    keys: dict[str, Span] = field(default_factory=dict[str, Span])
    elements: list[JsonNode] = field(default_factory=list["JsonNode"])

    def get(self, name: str) -> JsonNode | None:
        """The value under a key, None also for what is no object."""
        return self.items.get(name)

    def plain(self) -> Any:
        """The value as the library's `json` would give it."""
        if self.kind == "object":
            return {name: item.plain() for name, item in self.items.items()}
        if self.kind == "array":
            return [item.plain() for item in self.elements]
        return self.value
