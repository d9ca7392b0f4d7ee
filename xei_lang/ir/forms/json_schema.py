"""Whether a JSON tree follows one of our schemas, each violation with its pointer and its place in the text.

Only the words of JSON Schema (Draft 2020-12) that our own schemas use are known: `KEYWORDS`, and references
into the schema's own `$defs`. A library would know them all, but no places, and would cost more than the rest
of a check; tests hold this one against the library.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.ir.forms.json_tree import JsonNode

Schema = Mapping[str, Any]
Pointer = tuple[str | int, ...]

ANNOTATIONS = ("$schema", "$defs", "title", "description")
_SHOWN = 8
_MOST_TYPES = 3
_NOUNS = {
    "object": "an object",
    "array": "an array",
    "string": "a text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
    "null": "null",
}


@dataclass(frozen=True, slots=True, eq=False)
class Violation:
    """What is wrong at a place of the tree; the pointer as RFC 6901 has it is `pointer_text(pointer)`."""

    pointer: Pointer
    diagnostic: Diagnostic


def violations(root: JsonNode, schema: Schema, code: str) -> Iterator[Violation]:
    """Every violation as a diagnostic of this code, in the order of the tree."""
    yield from _Walk(schema, code).node(root, schema, ())


def pointer_text(pointer: Pointer) -> str:
    """`/skill_calls/0/args`; the empty text for the whole document."""
    return "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in pointer)


def deref(schema: Schema, root: Schema) -> Schema:
    """The schema itself, or the one of `$defs` that it refers to."""
    reference = schema.get("$ref")
    return schema if reference is None else root["$defs"][reference.removeprefix("#/$defs/")]


class _Walk:
    def __init__(self, root: Schema, code: str) -> None:
        self.root = root
        self.code = code

    def node(self, node: JsonNode, schema: Schema, pointer: Pointer) -> Iterator[Violation]:
        schema = deref(schema, self.root)
        for keyword, wanted in schema.items():
            if keyword in _VALUE_RULES:
                said = _VALUE_RULES[keyword](node, wanted)
                if said is not None:
                    yield self._said(said, _start(node), pointer)
                    if keyword == "type":
                        return
        if "if" in schema:
            holds = next(self.node(node, schema["if"], pointer), None) is None
            yield from self.node(node, schema["then" if holds else "else"], pointer)
        if node.kind == "object":
            yield from self._object(node, schema, pointer)
        elif node.kind == "array":
            yield from self._array(node, schema, pointer)

    def _object(self, node: JsonNode, schema: Schema, pointer: Pointer) -> Iterator[Violation]:
        properties: Mapping[str, Schema] = schema.get("properties", {})
        rest: Schema | bool = schema.get("additionalProperties", True)
        missing = [name for name in schema.get("required", ()) if name not in node.items]
        near = {
            name: did_you_mean(name[:40], properties)
            for name in node.items
            if name not in properties and rest is False
        }
        for name in missing:
            if not any(name in names for names in near.values()):
                found = _words(tuple(name[:40] for name in node.items)) or "no key"
                yield self._said((f"`{name}` is missing", f"found {found}"), _start(node), pointer)
        for name, item in node.items.items():
            if name in properties:
                yield from self.node(item, properties[name], (*pointer, name))
            elif name in near:
                said = (f"there is no key `{name[:40]}` here", f"expected {_words(tuple(properties))}")
                at = pointer if set(near[name]) & set(missing) else (*pointer, name)
                yield self._said(said, node.keys[name], at, near[name])
            elif rest is not True and rest is not False:
                yield from self.node(item, rest, (*pointer, name))

    def _array(self, node: JsonNode, schema: Schema, pointer: Pointer) -> Iterator[Violation]:
        first: list[Schema] = schema.get("prefixItems", [])
        rest: Schema | None = schema.get("items")
        for index, item in enumerate(node.elements):
            wanted = first[index] if index < len(first) else rest
            if wanted is not None:
                yield from self.node(item, wanted, (*pointer, index))

    def _said(
        self, said: tuple[str, str], span: Span, pointer: Pointer, near: tuple[str, ...] = ()
    ) -> Violation:
        message, label = said
        where = pointer_text(pointer)
        notes = (f"JSON pointer: {where if len(where) <= 200 else where[:200] + '...'}",) if where else ()
        help_ = (f"did you mean {_words(near)}?",) if near else ()
        return Violation(pointer, Diagnostic(self.code, message, span, label, notes=notes, help=help_))


def _type(node: JsonNode, wanted: str | list[str]) -> tuple[str, str] | None:
    types = [wanted] if isinstance(wanted, str) else wanted
    whole = node.kind == "number" and float(node.value or 0).is_integer()
    if node.kind in types or (whole and "integer" in types):
        return None
    expected = " or ".join(_NOUNS[name] for name in types)
    short = expected if len(types) <= _MOST_TYPES else "a value"
    return f"{_NOUNS[node.kind]} stands where {short} is expected", f"expected {expected}"


def _const(node: JsonNode, wanted: Any) -> tuple[str, str] | None:
    return _enum(node, [wanted])


def _enum(node: JsonNode, wanted: list[Any]) -> tuple[str, str] | None:
    if any(_same(node, value) for value in wanted):
        return None
    expected = _words(tuple(str(value) for value in wanted))
    return f"`{str(node.value)[:40]}` is not known here", f"expected {expected}"


def _same(node: JsonNode, value: Any) -> bool:
    return isinstance(node.value, bool) == isinstance(value, bool) and node.value == value


def _minimum(node: JsonNode, wanted: float) -> tuple[str, str] | None:
    if node.kind != "number" or float(node.value or 0) >= wanted:
        return None
    return f"`{node.value}` is less than {wanted}", f"expected {wanted} or more"


def _min_length(node: JsonNode, wanted: int) -> tuple[str, str] | None:
    short = node.kind == "string" and len(str(node.value)) < wanted
    return ("a text is empty", "expected a text") if short else None


def _min_items(node: JsonNode, wanted: int) -> tuple[str, str] | None:
    return _items(node, wanted) if len(node.elements) < wanted else None


def _max_items(node: JsonNode, wanted: int) -> tuple[str, str] | None:
    return _items(node, wanted) if len(node.elements) > wanted else None


def _items(node: JsonNode, wanted: int) -> tuple[str, str] | None:
    if node.kind != "array":
        return None
    return f"an array has {len(node.elements)} members", f"expected {wanted}"


def _unique(node: JsonNode, _wanted: bool) -> tuple[str, str] | None:
    seen: set[object] = set()
    for item in node.elements:
        if item.kind == "string" and item.value in seen:
            return f"`{str(item.value)[:40]}` stands twice in an array", "expected each once"
        seen.add(item.value)
    return None


_VALUE_RULES: Mapping[str, Callable[[JsonNode, Any], tuple[str, str] | None]] = {
    "type": _type,
    "const": _const,
    "enum": _enum,
    "minimum": _minimum,
    "minLength": _min_length,
    "minItems": _min_items,
    "maxItems": _max_items,
    "uniqueItems": _unique,
}
KEYWORDS = (
    *_VALUE_RULES,
    "$ref",
    "required",
    "properties",
    "additionalProperties",
    "items",
    "prefixItems",
    "if",
    "then",
    "else",
)
"""The words that are understood; `uniqueItems` for arrays of texts, `then` and `else` always both."""


def _start(node: JsonNode) -> Span:
    """A small place for a whole value: of objects and arrays the opening sign."""
    if node.kind in ("object", "array"):
        return Span(node.span.file, node.span.start, node.span.start + 1)
    return node.span


def _words(names: tuple[str, ...]) -> str:
    shown = ", ".join(f"`{name}`" for name in names[:_SHOWN])
    return f"{shown} and {len(names) - _SHOWN} more" if len(names) > _SHOWN else shown
