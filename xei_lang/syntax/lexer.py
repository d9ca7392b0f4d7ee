"""Cutting a text into tokens by one regular expression that is put together from the grammar's terminals."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from xei_lang.syntax.tables import END, Tables


class Token(NamedTuple):
    """A terminal as it stands in the text: characters `[start, end)`."""

    kind: str
    text: str
    start: int
    end: int


WORD = "NAME"
SPACE = "SPACE"
COMMENT = "COMMENT"
SIGN = "SIGN"
STRAY = "STRAY"
"""The kind of a token for what is no token at all: a character, or a number that runs into a word."""

_STRAY = re.compile(r"\"[^\n]*|[0-9.]+\w*|[^\W\d]\w*|&&|\|\||//|[\u00b0\u00d7]\w*|.", re.DOTALL)


class Scanner:
    """Finds the token at a place. The same match skips the white space before it, which halves the work."""

    def __init__(self, tables: Tables) -> None:
        space = dict(tables.patterns)[SPACE]
        named = [f"(?P<{name}>{pattern})" for name, pattern in tables.patterns if name != SPACE]
        signs = "|".join(
            re.escape(sign) for sign in sorted(tables.signs, key=lambda sign: (-len(sign), sign))
        )
        self._signs = tables.signs
        self._space = re.compile(f"(?:{space})?")
        self._match = re.compile(f"(?:{space})?(?:{'|'.join(named)}|(?P<{SIGN}>{signs}))").match

    def tokens(self, text: str, position: int = 0) -> Iterator[Token]:
        """The tokens from a place on, comments among them; the last is END. Keywords are still names here."""
        find, signs = self._match, self._signs
        while True:
            match = find(text, position)
            if match is None:
                token = self._other(text, position)
                yield token
                if token.kind == END:
                    return
                position = token.end
                continue
            kind = match.lastgroup or ""
            start, position = match.span(kind)
            written = match[kind]
            yield Token(signs[written] if kind == SIGN else kind, written, start, position)

    def _other(self, text: str, position: int) -> Token:
        """The end of the text, or what stands where no token begins, as people would point at it."""
        space = self._space.match(text, position)
        position = space.end() if space else position
        match = _STRAY.match(text, position)
        return Token(STRAY, match[0], position, match.end()) if match else Token(END, "", position, position)
