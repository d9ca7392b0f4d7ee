"""Reading JSON (RFC 8259) into a tree.

Strict: what JSON does not have is a diagnostic and no guess. Two keys of one name, numbers beyond a double,
half surrogate pairs, texts of absurd length and deep nesting are refused as well, because they have no one
meaning or none that a plan could need.
"""

from __future__ import annotations

import math
import re

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label, Source, Span
from xei_lang.ir.forms.json_tree import JsonNode, NodeKind

MAX_DEPTH = 60
MAX_TEXT = 100_000
_MAX_DIGITS = 300

_SPACE = re.compile(r"[ \t\r\n]*")
_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?P<part>(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)")
_PLAIN = re.compile(r'[^"\\\x00-\x1f]*')
_WORD = re.compile(r"[+-]?[\w.]+|//|/\*|.", re.DOTALL)
_UNICODE = re.compile(r"u[0-9a-fA-F]{4}")
_ESCAPES = {
    '"': '"',
    "\\": "\\",
    "/": "/",
    "b": "\b",
    "f": "\f",
    "n": "\n",
    "r": "\r",
    "t": "\t",
}
_WORDS: dict[str, tuple[NodeKind, bool | None]] = {
    "true": ("boolean", True),
    "false": ("boolean", False),
    "null": ("null", None),
}
_HABITS = {
    "'": "texts stand in double quotes",
    "//": "JSON has no comments",
    "/*": "JSON has no comments",
    "#": "JSON has no comments",
    "True": "write `true`",
    "False": "write `false`",
    "None": "write `null`",
    "NaN": "JSON has no word for what is not a number",
    "Infinity": "JSON has no word for infinity",
    "-Infinity": "JSON has no word for infinity",
}


def read_json(source: Source) -> tuple[JsonNode | None, Diagnostics]:
    """The tree of a text; None where it breaks off at its first error of syntax.

    Where only single values are wrong (a key that stands twice, a number that is too large), the tree is
    there and they are diagnostics.
    """
    reader = _Reader(source)
    try:
        root = reader.document()
    except _BrokenError as broken:
        return None, (*reader.found, broken.diagnostic)
    return root, tuple(reader.found)


class _BrokenError(Exception):
    """Reading cannot go on; never leaves this module."""

    def __init__(self, diagnostic: Diagnostic) -> None:
        super().__init__(diagnostic.message)
        self.diagnostic = diagnostic


class _Reader:
    def __init__(self, source: Source) -> None:
        self.file = source.file
        self.text = source.text
        self.at = 0
        self.depth = 0
        self.found: list[Diagnostic] = []

    def document(self) -> JsonNode:
        root = self._value("a value")
        self._space()
        if self.at < len(self.text):
            self._fail("the end of the text")
        return root

    def _value(self, expected: str) -> JsonNode:
        self._space()
        start, first = self.at, self.text[self.at : self.at + 1]
        if first == '"':
            text = self._string()
            return JsonNode("string", self._since(start), text)
        if first in ("{", "["):
            return self._container(first)
        number = _NUMBER.match(self.text, start)
        word = _WORD.match(self.text, start)
        if number and word and word.end() <= number.end():
            return self._number(number)
        if word and word[0] in _WORDS:
            self.at = word.end()
            kind, value = _WORDS[word[0]]
            return JsonNode(kind, self._since(start), value)
        return self._fail(expected)

    def _number(self, found: re.Match[str]) -> JsonNode:
        self.at = found.end()
        span = Span(self.file, *found.span())
        digits = found.end() - found.start() - len(found["part"])
        value = math.inf if digits > _MAX_DIGITS else float(found[0]) if found["part"] else int(found[0])
        if value in (math.inf, -math.inf):
            self._say("a number is too large", span, "more than a floating-point number can be")
            value = 0
        return JsonNode("number", span, value)

    def _container(self, opening: str) -> JsonNode:
        start, self.depth = self.at, self.depth + 1
        self.at += 1
        if self.depth > MAX_DEPTH:
            message = f"values are nested more than {MAX_DEPTH} levels deep"
            raise _BrokenError(Diagnostic("XEI0107", message, self._since(start), "one level too many"))
        node = JsonNode("object" if opening == "{" else "array", self._since(start))
        closing = "}" if opening == "{" else "]"
        more = not self._take(closing)
        while more:
            if opening == "{":
                self._member(node)
            else:
                node.elements.append(self._value("a value"))
            more = self._take(",")
            if not more and not self._take(closing):
                self._fail(f"`,` or `{closing}`")
        node.span = self._since(start)
        self.depth -= 1
        return node

    def _member(self, node: JsonNode) -> None:
        self._space()
        start = self.at
        if self.text[start : start + 1] != '"':
            self._fail("a key in double quotes")
        name = self._string()
        span = self._since(start)
        if not self._take(":"):
            self._fail("`:`")
        value = self._value("a value")
        if name in node.keys:
            labels = (Label(node.keys[name], "first given here"),)
            self._say(f"`{_short(name)}` stands twice", span, "given again here", labels)
            return
        node.keys[name], node.items[name] = span, value

    def _string(self) -> str:
        """The text whose opening quote stands here."""
        start, parts = self.at, list[str]()
        self.at += 1
        while True:
            plain = _PLAIN.match(self.text, self.at)
            assert plain is not None
            parts.append(plain[0])
            self.at = plain.end()
            if self.text[self.at : self.at + 1] == "\\":
                parts.append(self._escape())
            elif self._here('"'):
                break
            else:
                raise _BrokenError(self._unclosed(start))
        text = "".join(parts)
        return self._sound(text, self._since(start))

    def _unclosed(self, start: int) -> Diagnostic:
        if self._is_over() or self.text[self.at] in "\r\n":
            quote = Span(self.file, start, start + 1)
            return Diagnostic("XEI0110", "a text is not closed", quote, "begins here, and ends with the line")
        here = Span(self.file, self.at, self.at + 1)
        help_ = (f"write `\\u{ord(self.text[self.at]):04x}`",)
        return Diagnostic("XEI0110", "a text holds a control character", here, help=help_)

    def _escape(self) -> str:
        start = self.at
        self.at += 1
        found = _UNICODE.match(self.text, self.at)
        if found:
            self.at = found.end()
            return chr(int(found[0][1:], 16))
        character = self.text[self.at : self.at + 1]
        if character not in _ESCAPES or not character:
            span = Span(self.file, start, min(start + 2, len(self.text)))
            raise _BrokenError(Diagnostic("XEI0110", "an escape that JSON does not have", span))
        self.at += 1
        return _ESCAPES[character]

    def _sound(self, text: str, span: Span) -> str:
        if not text.isascii():
            try:
                text = text.encode("utf-16-le", "surrogatepass").decode("utf-16-le")
            except UnicodeDecodeError:
                self._say("a text holds half of a surrogate pair", span, "no character is written so")
                text = text.encode("ascii", "replace").decode("ascii")
        if len(text) > MAX_TEXT:
            message = f"a text has {len(text)} characters"
            self.found.append(Diagnostic("XEI0107", message, span, f"expected at most {MAX_TEXT}"))
            return text[:80]
        return text

    def _take(self, sign: str) -> bool:
        """Whether the next sign is this one, which then is passed."""
        self._space()
        return self._here(sign)

    def _here(self, sign: str) -> bool:
        if not self.text.startswith(sign, self.at):
            return False
        self.at += len(sign)
        return True

    def _space(self) -> None:
        found = _SPACE.match(self.text, self.at)
        assert found is not None
        self.at = found.end()

    def _is_over(self) -> bool:
        return self.at >= len(self.text)

    def _since(self, start: int) -> Span:
        return Span(self.file, start, self.at)

    def _say(self, message: str, span: Span, label: str, labels: tuple[Label, ...] = ()) -> None:
        self.found.append(Diagnostic("XEI0110", message, span, label, labels))

    def _fail(self, expected: str) -> JsonNode:
        self._space()
        found = _WORD.match(self.text, self.at)
        word = _short(found[0]) if found else ""
        span = Span(self.file, self.at, found.end() if found else self.at)
        message = f"`{word}` is not JSON" if word else "the text ends too early"
        if word in _WORDS or _NUMBER.fullmatch(word) or word in '{}[],:"':
            message = f"`{word}` cannot stand here"
        help_ = _HABITS.get(word)
        if word in ("}", "]") and expected.startswith("a "):
            help_ = "JSON has no comma behind the last one"
        raise _BrokenError(
            Diagnostic("XEI0110", message, span, f"expected {expected}", help=(help_,) if help_ else ())
        )


def _short(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:57]}..."
