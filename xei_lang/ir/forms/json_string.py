"""Reading a string of JSON: what stands between two quotes, with its escapes.

Half of a surrogate pair is no character, and a text of absurd length none that a plan could need: both are
said, and reading goes on.
"""

from __future__ import annotations

import re

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.ir.forms.json_cursor import BrokenError, Cursor

MAX_TEXT = 100_000

_PLAIN = re.compile(r'[^"\\\x00-\x1f]*')
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


def read_string(cursor: Cursor) -> str:
    """The text whose opening quote stands here. Raises BrokenError where it has no end."""
    start, parts = cursor.at, list[str]()
    cursor.at += 1
    while True:
        plain = _PLAIN.match(cursor.text, cursor.at)
        assert plain is not None
        parts.append(plain[0])
        cursor.at = plain.end()
        if cursor.text[cursor.at : cursor.at + 1] == "\\":
            parts.append(_escape(cursor))
        elif cursor.here('"'):
            break
        else:
            raise BrokenError(_unclosed(cursor, start))
    return _sound(cursor, "".join(parts), cursor.since(start))


def _unclosed(cursor: Cursor, start: int) -> Diagnostic:
    if cursor.is_over() or cursor.text[cursor.at] in "\r\n":
        quote = Span(cursor.file, start, start + 1)
        return Diagnostic("XEI0110", "a text is not closed", quote, "begins here, and ends with the line")
    here = Span(cursor.file, cursor.at, cursor.at + 1)
    help_ = (f"write `\\u{ord(cursor.text[cursor.at]):04x}`",)
    return Diagnostic("XEI0110", "a text holds a control character", here, help=help_)


def _escape(cursor: Cursor) -> str:
    start = cursor.at
    cursor.at += 1
    found = _UNICODE.match(cursor.text, cursor.at)
    if found:
        cursor.at = found.end()
        return chr(int(found[0][1:], 16))
    character = cursor.text[cursor.at : cursor.at + 1]
    if character not in _ESCAPES:
        span = Span(cursor.file, start, min(start + 2, len(cursor.text)))
        raise BrokenError(Diagnostic("XEI0110", "an escape that JSON does not have", span))
    cursor.at += 1
    return _ESCAPES[character]


def _sound(cursor: Cursor, text: str, span: Span) -> str:
    if not text.isascii():
        try:
            text = text.encode("utf-16-le", "surrogatepass").decode("utf-16-le")
        except UnicodeDecodeError:
            cursor.say("a text holds half of a surrogate pair", span, "no character is written so")
            text = text.encode("ascii", "replace").decode("ascii")
    if len(text) > MAX_TEXT:
        message = f"a text has {len(text)} characters"
        cursor.found.append(Diagnostic("XEI0107", message, span, f"expected at most {MAX_TEXT}"))
        return text[:80]
    return text
