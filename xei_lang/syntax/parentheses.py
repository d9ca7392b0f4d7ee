"""Finding the parenthesis that stays open inside of a call over several lines, by how its end is indented.

The `)` on a line of its own then closes that one, and the grammar notices at the step below; but it stands
below the line of the call that was meant.
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

from xei_lang.syntax.cursor import Cursor
from xei_lang.syntax.layout import begins_line, indent
from xei_lang.syntax.lexer import Token

_KINDS = {"(": ("RPAR", ")"), "[": ("RSQB", "]")}


@dataclass(frozen=True, slots=True)
class Unclosed:
    """A bracket that lacks its end at the place `end`, and what closes those that are open now."""

    opener: Token
    end: int
    closing: tuple[Token, ...]


def find_unclosed(cursor: Cursor) -> Unclosed | None:
    """The bracket that took the end of the call around it, where a line begins that cannot go on."""
    done, text = cursor.done, cursor.text
    if len(done) < 2 or not begins_line(cursor.tokens, cursor.at, text):
        return None
    last, before, opened = done[-1].token, done[-2].token, done[-1].opened
    if last.text not in (")", "]") or opened is None or "\n" not in text[before.end : last.start]:
        return None
    inner, width = opened[0], indent(last, text)
    if indent(inner, text) <= width:
        return None
    closing: list[Token] = []
    around = cursor.opened
    while around is not None and around[0].text in _KINDS:
        kind, sign = _KINDS[around[0].text]
        closing.append(Token(kind, sign, last.end, last.end))
        if indent(around[0], text) == width:
            return Unclosed(inner, _end(cursor, inner), tuple(closing))
        around = around[1]
    return None


def _end(cursor: Cursor, opener: Token) -> int:
    """Behind the last token of a bracket's line, but for a comma."""
    index = bisect_left(cursor.done, opener.start, key=lambda done: done.token.start)
    before, last = opener, opener
    while "\n" not in cursor.text[last.end : cursor.done[index + 1].token.start]:
        index += 1
        before, last = last, cursor.done[index].token
    return before.end if last.text == "," else last.end
