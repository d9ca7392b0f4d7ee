"""Finding the brace that is missing, or one too many, by how lines are indented.

The grammar notices a lost brace at the end of the file or at the next definition; the one who wrote it has
left the place in the indentation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from xei_lang.syntax.layout import begins_line, indent, looks_like_statement
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.tables import END

_HEADERS = frozenset("for repeat if keep pause do parallel protocol procedure else".split())
_FEW = 3
_LINES_FOR_EACH = 8
"""Where more faults show than one in so many lines, it is the indentation that has no order."""


@dataclass(frozen=True, slots=True)
class BraceFault:
    """A `}` is missing before `tokens[index]`, or the one there is too many.

    `opener` is the open brace that is meant, None where a line only ought to have had one.
    """

    kind: Literal["missing", "extra"]
    index: int
    opener: Token | None
    indent: int


@dataclass(frozen=True, slots=True)
class _Open:
    indent: int
    line: int
    token: Token | None


def find_brace_faults(tokens: Sequence[Token], text: str) -> tuple[BraceFault, ...]:
    """Faults in the order of the text; none where the braces are even, or the indentation has no order."""
    search = _Search(tokens, text)
    search.run()
    missing, extra = search.missing, search.extra
    for fault in list(extra):
        pair = next((m for m in reversed(missing) if m.indent == fault.indent and m.index < fault.index), None)
        if pair is not None:
            missing.remove(pair)
            extra.remove(fault)
    faults = tuple(missing if search.balance > 0 else extra)
    most = min(abs(search.balance), max(_FEW, search.lines // _LINES_FOR_EACH))
    return faults if len(faults) <= most else ()


class _Search:
    """One walk over the lines, with the blocks that are open by their indentation."""

    def __init__(self, tokens: Sequence[Token], text: str) -> None:
        self._tokens = tokens
        self._text = text
        self._open: list[_Open] = []
        self._depth = 0
        self.missing: list[BraceFault] = []
        self.extra: list[BraceFault] = []
        self.lines = 0
        self.balance = 0
        """Open braces less closing ones, with those counted that a header ought to have."""

    def run(self) -> None:
        tokens = self._tokens
        starts = [i for i in range(len(tokens)) if begins_line(tokens, i, self._text)]
        self.lines = len(starts)
        for number, begin in enumerate(starts):
            end = starts[number + 1] if number + 1 < len(starts) else len(tokens)
            self._line(begin, end, number)

    def _line(self, begin: int, end: int, number: int) -> None:
        tokens = self._tokens
        first = tokens[begin]
        width = 0 if first.kind == END else indent(first, self._text)
        begins = looks_like_statement(tokens, begin) or first.text in ("{", "}")
        if begins or first.kind == END:
            self._depth = 0
        if self._depth == 0 and (begins or first.kind == END):
            self._dedent(begin, width, first)
        header = self._lost_opening(begin, end, width)
        if header == "inline":
            self._push(width, number, None)
        for index in range(begin, end):
            self._token(index, begin, width, number)
        if header == "below":
            self._push(width, number, None)

    def _dedent(self, index: int, width: int, first: Token) -> None:
        """Close what the indentation of a line says is closed."""
        least = width + 1 if first.text == "}" else width
        if first.kind == END:
            least = 0
        while self._open and self._open[-1].indent >= least:
            opened = self._open.pop()
            self.missing.append(BraceFault("missing", self._where(index, opened), opened.token, opened.indent))

    def _where(self, index: int, opened: _Open) -> int:
        """Before the line; within the line of the open brace if all of its block is there, as at its `else`."""
        token = opened.token
        if token is None or "\n" in self._text[token.start : self._tokens[index - 1].start]:
            return index
        for other in range(index - 1, 0, -1):
            if self._tokens[other].start < token.start:
                break
            if self._tokens[other].text == "else" and self._tokens[other - 1].text != "}":
                return other
        return index

    def _token(self, index: int, begin: int, width: int, number: int) -> None:
        token = self._tokens[index]
        if token.text in ("(", "["):
            self._depth += 1
        elif token.text in (")", "]"):
            self._depth = max(0, self._depth - 1)
        elif token.text == "{":
            self._push(width, number, token)
        elif token.text == "}":
            self._close(index, begin, width, number)

    def _push(self, width: int, number: int, token: Token | None) -> None:
        self.balance += 1
        self._open.append(_Open(width, number, token))

    def _close(self, index: int, begin: int, width: int, number: int) -> None:
        self.balance -= 1
        top = self._open[-1] if self._open else None
        if index == begin:
            fits = top is not None and top.indent == width
        else:
            doubled = self._tokens[index - 1].text == "}" and top is not None and top.line != number
            fits = top is not None and not doubled
        if fits:
            self._open.pop()
        else:
            self.extra.append(BraceFault("extra", index, None, width))

    def _lost_opening(self, begin: int, end: int, width: int) -> Literal["", "inline", "below"]:
        """Whether a line begins a block but has no brace: the block then stands behind it, or below."""
        tokens = self._tokens
        words = [token.text for token in tokens[begin:end]]
        closing = words[0] == "}"
        if closing:
            words = words[1:]
        elif words[1:2] == [":"]:
            words = words[2:]
        if not words or words[0] not in _HEADERS or "{" in words:
            return ""
        if "}" in words:
            return "inline"
        if end >= len(tokens) or tokens[end].kind == END or tokens[end].text == "{":
            return ""
        return "below" if indent(tokens[end], self._text) > width else ""
