"""Finding the brace that is missing, or one too many, by how lines are indented.

The grammar notices a lost brace at the end of the file or at the next definition; the one who wrote it has
left the place in the indentation.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from xei_lang.syntax.layout import begins_line, indent, looks_like_statement
from xei_lang.syntax.lexer import Token
from xei_lang.syntax.tables import END

_HEADERS = frozenset(
    ["for", "repeat", "if", "keep", "pause", "do", "parallel", "protocol", "procedure", "else"]
)
_BEHIND_BLOCK = frozenset(["within", "after"])
_FEW = 3
_LINES_FOR_EACH = 8
"""Where more faults show than one in so many lines, it is the indentation that has no order."""


@dataclass(frozen=True, slots=True)
class BraceFault:
    """A `}` is missing before `tokens[index]`, the one there is too many, or a `{` is missing before it.

    `opener` is the open brace that is meant, None where a line only ought to have had one.
    """

    kind: Literal["missing", "extra", "opening"]
    index: int
    opener: Token | None
    indent: int


@dataclass(slots=True)
class _Open:
    """A block that is open: indentation and number of its line, its brace, how far its lines stand in.

    `fault` is there for a block whose brace is missing; `loose` if only the indentation says that it exists;
    `branches` if it holds blocks, and nothing else.
    """

    indent: int
    line: int
    token: Token | None
    inner: int = -1
    fault: BraceFault | None = None
    loose: bool = False
    branches: bool = False


def find_brace_faults(tokens: Sequence[Token], text: str) -> tuple[BraceFault, ...]:
    """Faults in the order of the text; none where the braces are even, or the indentation has no order."""
    search = _Search(tokens, text)
    search.run()
    missing, extra = search.missing, search.extra
    allowed = abs(search.balance) + max(1, search.lines // _LINES_FOR_EACH)
    if len(missing) + len(extra) > allowed:
        return ()
    for fault in list(extra):
        pair = next(
            (m for m in reversed(missing) if m.indent == fault.indent and m.index < fault.index), None
        )
        if pair is not None:
            missing.remove(pair)
            extra.remove(fault)
    faults = missing if search.balance > 0 else extra
    if len(faults) > abs(search.balance):
        faults = []
    faults = sorted([*faults, *search.openings], key=lambda fault: fault.index)
    return tuple(faults) if len(faults) <= max(_FEW, search.lines // _LINES_FOR_EACH) else ()


class _Search:
    """One walk over the lines, with the blocks that are open by their indentation."""

    def __init__(self, tokens: Sequence[Token], text: str) -> None:
        self._tokens = tokens
        self._text = text
        self._open: list[_Open] = []
        self._depth = 0
        self._unit = 0
        self.missing: list[BraceFault] = []
        self.extra: list[BraceFault] = []
        self.openings: list[BraceFault] = []
        self.lines = 0
        self.balance = 0
        """Open braces less closing ones, with those counted that a header ought to have."""

    def run(self) -> None:
        tokens = self._tokens
        starts = [i for i in range(len(tokens)) if begins_line(tokens, i, self._text)]
        self.lines = len(starts)
        widths = [indent(tokens[i], self._text) for i in starts]
        steps = Counter(inner - outer for outer, inner in pairwise(widths) if inner > outer)
        self._unit = min(steps, key=lambda step: (-steps[step], step), default=0)
        for number, begin in enumerate(starts):
            end = starts[number + 1] if number + 1 < len(starts) else len(tokens)
            self._line(begin, end, number)

    def _line(self, begin: int, end: int, number: int) -> None:
        tokens = self._tokens
        first = tokens[begin]
        width = 0 if first.kind == END else indent(first, self._text)
        begins = looks_like_statement(tokens, begin) or first.text in ("{", "}")
        if first.text == "else" and tokens[begin - 1].text != "}":
            width = self._lost_before_else(begin, width)
        if begins or first.kind == END:
            self._depth = 0
        if self._depth == 0:
            # What continues a statement stands at least as far in: a line that does not is behind its block.
            if not begins and self._stands_before(width):
                self._missing(begin)
            if first.text not in _BEHIND_BLOCK:
                self._dedent(begin, width, first)
            if begins or self._in_parallel():
                self._stands_in(begin, width, number)
        header = self._lost_opening(begin, end, width)
        if header == "inline":
            self._push(width, number, None)
        for index in range(begin, end):
            self._token(index, begin, width, number)
        if header == "below":
            self._push(width, number, None)
            self.openings.append(BraceFault("opening", end, None, width))

    def _lost_before_else(self, index: int, width: int) -> int:
        """Close the block that an `else` follows; gives the indentation of that block."""
        while self._open and self._open[-1].indent > width:
            self._missing(index)
        if not self._open:
            return width
        width = self._open[-1].indent
        self._missing(index)
        return width

    def _missing(self, index: int) -> None:
        opened = self._open.pop()
        if not opened.loose:
            place = self._where(index, opened)
            self.missing.append(BraceFault("missing", place, opened.token, opened.indent))

    def _dedent(self, index: int, width: int, first: Token) -> None:
        """Close what the indentation of a line says is closed."""
        least = width + 1 if first.text == "}" else width
        if first.kind == END:
            least = 0
        while self._open and self._open[-1].indent >= least:
            self._missing(index)

    def _stands_before(self, width: int) -> bool:
        """Whether a line stands further out than the statements of the innermost block."""
        return bool(self._open) and width < self._open[-1].inner

    def _in_parallel(self) -> bool:
        """Whether a block can stand here, and nothing else."""
        return bool(self._open) and self._open[-1].branches

    def _stands_in(self, index: int, width: int, number: int) -> None:
        """Open a block where a line stands further in than those before, or where only blocks can stand."""
        if not self._open or self._tokens[index].text in ("{", "}", ""):
            return
        top = self._open[-1]
        if top.inner < 0:
            top.inner = min(width, top.indent + self._unit) if width - top.indent == 2 * self._unit else width
        if width > top.inner or self._in_parallel():
            fault = BraceFault("opening", index, None, top.inner)
            self._open.append(_Open(top.inner, number, None, width, fault, loose=True))

    def _where(self, index: int, opened: _Open) -> int:
        """Before the line; within that of the open brace if an `else` shows the end of its block there."""
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
            self._push(width, number, token, branches=self._tokens[index - 1].text == "parallel")
        elif token.text == "}":
            self._close(index, begin, width, number)

    def _push(self, width: int, number: int, token: Token | None, *, branches: bool = False) -> None:
        self.balance += 1
        self._open.append(_Open(width, number, token, branches=branches))

    def _close(self, index: int, begin: int, width: int, number: int) -> None:
        self.balance -= 1
        top = self._open[-1] if self._open else None
        if index == begin:
            fits = top is not None and top.indent == width
        else:
            doubled = self._tokens[index - 1].text == "}" and top is not None and top.line != number
            fits = top is not None and not doubled
        if fits:
            opened = self._open.pop()
            if opened.loose and opened.fault is not None:
                self.openings.append(opened.fault)
                self.balance += 1
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
        if end >= len(tokens) or tokens[end].kind == END:
            return ""
        return "below" if self._is_body(end, width, words[0]) else ""

    def _is_body(self, begin: int, width: int, header: str) -> bool:
        """Whether the line below a header that has no brace is the first of its block, or its end."""
        first = self._tokens[begin]
        below = indent(first, self._text)
        if first.text == "}":
            return below == width
        if first.text == "{":
            return below > width and header == "parallel"
        starts = looks_like_statement(self._tokens, begin) or not self._has_opening(begin)
        return below > width and starts

    def _has_opening(self, begin: int) -> bool:
        """Whether a line holds an open brace, as the second line of a long header does."""
        for index in range(begin, len(self._tokens)):
            if index > begin and begins_line(self._tokens, index, self._text):
                break
            if self._tokens[index].text == "{":
                return True
        return False
