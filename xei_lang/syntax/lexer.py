"""Cutting a text into tokens by one regular expression that is put together from the grammar's terminals."""

from __future__ import annotations

import re
from typing import NamedTuple

from xei_lang.syntax.tables import Tables


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
        self._space = re.compile(f"(?:{space})?")
        self.match = re.compile(f"(?:{space})?(?:{'|'.join(named)}|(?P<{SIGN}>{signs}))").match

    def skip_space(self, text: str, position: int) -> int:
        """The first place from `position` on that is not white space."""
        match = self._space.match(text, position)
        return match.end() if match else position

    def stray(self, text: str, position: int) -> Token:
        """What stands at a place where no token begins, as people would point at it."""
        match = _STRAY.match(text, position)
        assert match is not None
        return Token(STRAY, match[0], position, match.end())
