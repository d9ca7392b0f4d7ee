"""Reading JSON (RFC 8259) into a tree.

Strict: what JSON does not have is a diagnostic and no guess. Two keys of one name, numbers beyond a double,
half surrogate pairs, texts of absurd length and deep nesting are refused as well, because they have no one
meaning or none that a plan could need.
"""

from __future__ import annotations

import math
import re

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label, Source, Span
from xei_lang.ir.forms.json_cursor import NUMBER, WORD, WORDS, BrokenError, Cursor, short
from xei_lang.ir.forms.json_string import read_string
from xei_lang.ir.forms.json_tree import JsonNode

MAX_DEPTH = 60
_MAX_DIGITS = 300


def read_json(source: Source) -> tuple[JsonNode | None, Diagnostics]:
    """The tree of a text; None where it breaks off at its first error of syntax.

    Where only single values are wrong (a key that stands twice, a number that is too large), the tree is
    there and they are diagnostics.
    """
    cursor = Cursor(source)
    try:
        root = _value(cursor, 0)
        cursor.space()
        if not cursor.is_over():
            cursor.fail("the end of the text")
    except BrokenError as broken:
        return None, (*cursor.found, broken.diagnostic)
    return root, tuple(cursor.found)


def _value(cursor: Cursor, depth: int) -> JsonNode:
    """The value that stands next, inside of `depth` others."""
    cursor.space()
    start, first = cursor.at, cursor.text[cursor.at : cursor.at + 1]
    if first == '"':
        text = read_string(cursor)
        return JsonNode("string", cursor.since(start), text)
    if first in ("{", "["):
        return _container(cursor, first, depth + 1)
    number = NUMBER.match(cursor.text, start)
    word = WORD.match(cursor.text, start)
    if number and word and word.end() <= number.end():
        return _number(cursor, number)
    if word and word[0] in WORDS:
        cursor.at = word.end()
        kind, value = WORDS[word[0]]
        return JsonNode(kind, cursor.since(start), value)
    return cursor.fail("a value")


def _number(cursor: Cursor, found: re.Match[str]) -> JsonNode:
    cursor.at = found.end()
    span = Span(cursor.file, *found.span())
    digits = found.end() - found.start() - len(found["part"])
    value = math.inf if digits > _MAX_DIGITS else float(found[0]) if found["part"] else int(found[0])
    if value in (math.inf, -math.inf):
        cursor.say("a number is too large", span, "more than a floating-point number can be")
        value = 0
    return JsonNode("number", span, value)


def _container(cursor: Cursor, opening: str, depth: int) -> JsonNode:
    start = cursor.at
    cursor.at += 1
    if depth > MAX_DEPTH:
        message = f"values are nested more than {MAX_DEPTH} levels deep"
        raise BrokenError(Diagnostic("XEI0107", message, cursor.since(start), "one level too many"))
    node = JsonNode("object" if opening == "{" else "array", cursor.since(start))
    closing = "}" if opening == "{" else "]"
    more = not cursor.take(closing)
    while more:
        if opening == "{":
            _member(cursor, node, depth)
        else:
            node.elements.append(_value(cursor, depth))
        more = cursor.take(",")
        if not more and not cursor.take(closing):
            cursor.fail(f"`,` or `{closing}`")
    node.span = cursor.since(start)
    return node


def _member(cursor: Cursor, node: JsonNode, depth: int) -> None:
    cursor.space()
    start = cursor.at
    if cursor.text[start : start + 1] != '"':
        cursor.fail("a key in double quotes")
    name = read_string(cursor)
    span = cursor.since(start)
    if not cursor.take(":"):
        cursor.fail("`:`")
    value = _value(cursor, depth)
    if name in node.keys:
        labels = (Label(node.keys[name], "first given here"),)
        cursor.say(f"`{short(name)}` stands twice", span, "given again here", labels)
        return
    node.keys[name], node.items[name] = span, value
