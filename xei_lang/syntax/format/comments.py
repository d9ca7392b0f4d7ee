"""The words of a file in their order, with the comments between them.

A comment stays between the two words where it was written. The one exception: a comma goes before a comment,
so that no line begins with it.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.syntax import ast
from xei_lang.syntax.format.layout import BLANK, EMPTY, HARD, Doc, Remark, cat
from xei_lang.syntax.lexer import Token


@dataclass(frozen=True, slots=True, eq=False)
class _Met:
    """A comment, and whether an empty line stands before it."""

    comment: ast.Comment
    own_line: bool
    blank: bool

    def remark(self) -> Remark:
        return Remark(self.comment.text, self.own_line)


class Cursor:
    """Goes through a file's words, each once; a word that is taken brings the comments before it."""

    def __init__(self, text: str, tokens: list[Token], comments: tuple[ast.Comment, ...]) -> None:
        self._text = text
        self._tokens = tokens
        self._closing = _pairs(tokens)
        self._gaps = self._between(comments)
        self._index = 0
        self._waiting: list[_Met] = list(self._gaps.get(0, ()))

    def _between(self, comments: tuple[ast.Comment, ...]) -> dict[int, list[_Met]]:
        """The comments by the index of the word behind them."""
        gaps: dict[int, list[_Met]] = {}
        ends = [token.end for token in self._tokens]
        for comment in comments:
            start = comment.span.start
            gap = bisect_right(ends, start)
            own_line = gap == 0 or "\n" in self._text[ends[gap - 1] : start]
            gaps.setdefault(gap, []).append(_Met(comment, own_line, self._blank_before(start)))
        return gaps

    def _blank_before(self, position: int) -> bool:
        """Whether an empty line stands before a place."""
        breaks = 0
        while position and self._text[position - 1].isspace():
            position -= 1
            breaks += self._text[position] == "\n"
        return breaks > 1

    # ---- looking ----

    @property
    def next(self) -> str:
        """The word that comes next; nothing at the end of the file."""
        return self._tokens[self._index].text if self._index < len(self._tokens) else ""

    def is_bare(self) -> bool:
        """Whether there is no comment between the next word, a bracket, and the one that closes it."""
        first, last = self._index + 1, self._closing[self._index]
        return not any(gap in self._gaps for gap in range(first, last + 1))

    def brackets_around(self, span: Span, *, is_word: bool, own: bool) -> list[bool]:
        """The `(` that open here around all of a node and nothing more, outermost first.

        Each says whether a comment stands right before its `)`. The span of a node counts them, unless the
        node is a single word; `own` is for a node that begins with a bracket of its own, which is left out.
        """
        opened: list[int] = []
        index = self._index
        while index < len(self._tokens) and self._tokens[index].text == "(":
            closing = self._closing[index]
            if opened:
                around = closing == self._closing[opened[-1]] - 1
            else:
                around = span.start == self._tokens[index].start and span.end == self._tokens[closing].end
            if not (around or is_word):
                break
            opened.append(index)
            index += 1
        kept = opened[:-1] if own else opened
        return [self._closing[index] in self._gaps for index in kept]

    # ---- taking ----

    def take(self, expected: str = "", *, written: str = "") -> Doc:
        """The next word, or what is `written` for it, behind the comments before it."""
        if not self._waiting:
            text = self._advance(expected)
            return written or text
        remarks = self.remarks()
        text = self._advance(expected)
        return cat(remarks, written or text)

    def remarks(self) -> Doc:
        """The comments before the next word alone."""
        remarks = [met.remark() for met in self._waiting]
        self._waiting = []
        return cat(*remarks)

    def comma(self) -> Doc:
        """A comma. The comments before it come behind it, but a `##` would then document what follows."""
        if any(met.comment.is_doc for met in self._waiting):
            return self.take(",")
        return self._advance(",")

    def skip(self, expected: str) -> None:
        """Leave the next word out, not the comments before it."""
        self._advance(expected)

    def _advance(self, expected: str) -> str:
        text = self.next
        assert text, "the tree has more words than the text"
        assert expected in ("", text), f"the tree has `{expected}` where the text has `{text}`"
        self._index += 1
        self._waiting += self._gaps.get(self._index, ())
        return text

    def trailing(self) -> Doc:
        """The comment that stands behind the last word, on its line."""
        if self._waiting and not self._waiting[0].own_line:
            return self._waiting.pop(0).remark()
        return EMPTY

    def leading(self, *, first: bool, apart: bool = False) -> Doc:
        """What stands before a statement: its comments, and empty lines where there were any.

        There is none before the `first` of a block. With `apart` there is one in any case, as far up as may
        be.
        """
        blanks = [met.blank for met in self._waiting]
        if self._index < len(self._tokens):
            blanks.append(self._blank_before(self._tokens[self._index].start))
        if first:
            blanks[:1] = [False]
        elif apart and not any(blanks):
            blanks[0] = True
        docs: list[Doc] = []
        for blank, met in zip(blanks, self._waiting, strict=False):
            docs += [BLANK if blank else HARD, met.remark()]
        docs.append(BLANK if blanks[len(self._waiting) :] == [True] else HARD)
        self._waiting = []
        return cat(*docs)

    def ending(self, *, first: bool) -> Doc:
        """The comments before the end of a block or file."""
        docs: list[Doc] = []
        for index, met in enumerate(self._waiting):
            docs += [BLANK if met.blank and not (first and index == 0) else HARD, met.remark()]
        self._waiting = []
        return cat(*docs)


def _pairs(tokens: list[Token]) -> dict[int, int]:
    """The index of the bracket that closes each opening one."""
    opened: list[int] = []
    pairs: dict[int, int] = {}
    for index, token in enumerate(tokens):
        if token.text in "([{":
            opened.append(index)
        elif token.text in ")]}":
            pairs[opened.pop()] = index
    return pairs
