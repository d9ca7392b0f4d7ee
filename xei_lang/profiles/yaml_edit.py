"""Values of one mapping of a YAML text replaced in place, and an entry put at the head of one of its lists.

Nothing else changes, to the byte: comments, order and everything else of the file stay. Keys that the mapping
lacks are added behind its last value.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

from xei_lang.diagnostics import Source
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node, Path

_PLAIN = re.compile(r"-?[0-9]+(\.[0-9]+)? [A-Za-z][A-Za-z0-9/]*|measured|estimated|placeholder|bound|std")
"""Texts that need no quotes: quantities, and the words that tolerances and transforms have."""


def edit(
    source: Source, path: Path, values: Mapping[str, str], entry: Mapping[str, object] | None = None
) -> str | None:
    """The text with these values (YAML on one line) in the mapping at a path, and `entry` first in its list
    `history`; None where it would not read back as just that.
    """
    root, faults = read_yaml(source.file, source.text)
    node = _at(root, path) if root and not faults else None
    if root is None or node is None or node.kind != "map" or not node.items:
        return None
    text = _replaced(source.text, node, values, entry)
    again, faults = read_yaml(source.file, text)
    if again is None or faults or again.plain() != _expected(root, path, values, entry):
        return None
    return text


def flow(value: object) -> str:
    """A plain value as YAML on one line."""
    if isinstance(value, Mapping):
        items: Mapping[object, object] = value  # pyright: ignore[reportUnknownVariableType]
        return "{" + ", ".join(f"{key}: {flow(one)}" for key, one in items.items()) + "}"
    if isinstance(value, list | tuple):
        elements: list[object] = list(value)  # pyright: ignore[reportUnknownArgumentType]
        return "[" + ", ".join(flow(one) for one in elements) + "]"
    if isinstance(value, float):
        # With a point and a signed exponent: any other form is a text to some readers of YAML.
        short = f"{value:.6e}"
        return short if float(short) == value else f"{value:.17e}"
    if isinstance(value, str):
        return value if _PLAIN.fullmatch(value) else json.dumps(value, ensure_ascii=not value.isprintable())
    return json.dumps(value)


def plain_at(source: Source, path: Path) -> Mapping[str, object] | None:
    """The mapping at a path of a YAML text, without places; None where there is none."""
    root, faults = read_yaml(source.file, source.text)
    node = _at(root, path) if root and not faults else None
    if node is None or node.kind != "map":
        return None
    return {key: item.plain() for key, item in node.items.items()}


def _at(root: Node | None, path: Path) -> Node | None:
    node = root
    for step in path:
        node = node.child(step) if node else None
    return node


def _replaced(text: str, node: Node, values: Mapping[str, str], entry: Mapping[str, object] | None) -> str:
    """Replace from the end of the text on, so that earlier offsets hold."""
    places = {key: _place(text, node, key) for key in node.items}
    edits = [(start, end, values[key]) for key, (start, end) in places.items() if key in values]
    added = {key: value for key, value in values.items() if key not in node.items}
    listed = node.items.get("history")
    if entry is not None and listed is not None and listed.kind == "list":
        edits.append(_first_of(text, listed, flow(entry)))
    elif entry is not None:
        added["history"] = f"[{flow(entry)}]"
    if added:
        edits.append(_behind(text, node, max(end for _, end in places.values()), added))
    for start, end, value in sorted(edits, reverse=True):
        space = " " if text[start - 1] == ":" else ""
        text = text[:start] + space + value + text[end:]
    return text


def _first_of(text: str, listed: Node, entry: str) -> tuple[int, int, str]:
    """The edit that makes an entry the first of a list."""
    start = listed.span.start
    if text[start] == "[":
        return start + 1, start + 1, f"{entry}, " if listed.elements else entry
    column = start - (text.rfind("\n", 0, start) + 1)
    return start, start, f"- {entry}{_newline(text)}{' ' * column}"


def _behind(text: str, node: Node, last: int, added: Mapping[str, str]) -> tuple[int, int, str]:
    """The edit that adds keys behind the last value of a mapping, which ends at `last`."""
    if text[node.span.start] == "{":
        return last, last, "".join(f", {key}: {value}" for key, value in added.items())
    first = min(key.start for key in node.keys.values())
    indent = " " * (first - (text.rfind("\n", 0, first) + 1))
    lines: list[str] = []
    for key, value in added.items():
        # A list of entries grows: each has a line of its own.
        is_history = key == "history"
        lines.append(f"{indent}{key}:" if is_history else f"{indent}{key}: {value}")
        lines += [f"{indent}  - {value[1:-1]}"] if is_history else []
    # Behind a comment on the last value's line, and not between the two.
    line_end = text.find("\n", last)
    last = len(text) if line_end < 0 else line_end - (text[line_end - 1] == "\r")
    return last, last, "".join(f"{_newline(text)}{line}" for line in lines)


def _newline(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


def _place(text: str, node: Node, key: str) -> tuple[int, int]:
    """Where the value of a key stands, from behind the key's colon and space to its last character."""
    value = node.items[key]
    end = value.span.start + len(text[value.span.start : value.span.end].rstrip())
    if value.kind == "scalar" or text[value.span.start] in "[{":
        return value.span.start, end
    # A block begins on a line of its own, where its one-line form might stand too far left.
    return text.index(":", node.keys[key].end) + 1, end


def _expected(
    root: Node, path: Path, values: Mapping[str, str], entry: Mapping[str, object] | None
) -> object:
    """The whole file's values with the mapping's replaced: what the edited text must read back as."""
    written, _ = read_yaml("values", "".join(f"{key}: {value}\n" for key, value in values.items()))
    added = {key: node.plain() for key, node in written.items.items()} if written else {}

    def changed(node: Node, rest: Path) -> dict[str, object]:
        here = {key: item.plain() for key, item in node.items.items()}
        if rest:
            key = str(rest[0])
            return {**here, key: changed(node.items[key], rest[1:])}
        if entry is not None:
            former = here.get("history", [])
            here["history"] = [dict(entry), *(former if isinstance(former, list) else [])]
        return {**here, **added}

    return changed(root, path)
