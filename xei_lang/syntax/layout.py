"""How tokens stand on the page: which begin a line, how far that is indented, what looks like a statement.

White space means nothing to the grammar. Where the grammar fails, it tells what the writer had in mind.
"""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.diagnostics import did_you_mean
from xei_lang.syntax.lexer import WORD, Token

_TAB = 8
_OPERANDS = frozenset({WORD, "STRING", "NUMBER", "QUANTITY"})
_BEGINNINGS = frozenset(
    [
        "wait",
        "start",
        "await",
        "stop",
        "leave",
        "pause",
        "keep",
        "measure",
        "confirm",
        "do",
        "parallel",
        "for",
        "repeat",
        "if",
        "let",
        "require",
        "unmapped",
        "note",
        "profile",
        "param",
        "object",
        "given",
        "protocol",
        "procedure",
        "import",
    ]
)


def begins_line(tokens: Sequence[Token], index: int, text: str) -> bool:
    """Whether a token is the first of its line."""
    return index == 0 or "\n" in text[tokens[index - 1].end : tokens[index].start]


def indent(token: Token, text: str) -> int:
    """The column of the first character of a token's line that is no white space."""
    begin = text.rfind("\n", 0, token.start) + 1
    line = text[begin : token.start]
    return len(line[: len(line) - len(line.lstrip())].expandtabs(_TAB)) if line.strip() else _width(line)


def looks_like_statement(tokens: Sequence[Token], index: int) -> bool:
    """Whether a statement, declaration or definition probably begins here: by its word, as call or label."""
    token = tokens[index]
    if token.kind != WORD and token.text not in _BEGINNINGS:
        return False
    following = tokens[index + 1].text if index + 1 < len(tokens) else ""
    return following in ("(", ":") or (token.text in _BEGINNINGS and following not in ("=", ","))


def is_nearly_statement(tokens: Sequence[Token], index: int) -> bool:
    """Whether a word is nearly one that a statement begins with, and what follows is no operator on it."""
    token = tokens[index]
    if token.kind != WORD or index + 1 >= len(tokens):
        return False
    follows = tokens[index + 1].kind in _OPERANDS or tokens[index + 1].text == "{"
    return follows and bool(did_you_mean(token.text, _BEGINNINGS))


def line_end(text: str, position: int) -> int:
    """Where the line of a place ends, its line break left out."""
    end = text.find("\n", position)
    return len(text) if end < 0 else end


def _width(line: str) -> int:
    return len(line.expandtabs(_TAB))
