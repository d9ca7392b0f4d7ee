"""Where a recovery stands in a text: what is taken, what comes, and what was hurt on the way."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from typing import NamedTuple

from xei_lang.diagnostics import Source, Span
from xei_lang.syntax.layout import line_end
from xei_lang.syntax.lexer import COMMENT, STRAY, Scanner, Token
from xei_lang.syntax.stack import Machine, Stack
from xei_lang.syntax.tables import END

STATEMENT, ITEM = "WAIT", "PROTOCOL"
"""Terminals that may follow wherever a statement may begin, and wherever a definition may."""

_BRACE = re.compile(r"\s*([{}])\s*(#.*)?$")


class Done(NamedTuple):
    """A token that is taken, the stack that it met, and the brackets that were open then."""

    token: Token
    before: Stack
    opened: Opened


Opened = tuple[Token, "Opened", int] | None
"""The innermost open bracket, those around it, and how many braces are among them all."""


class Cursor:
    """The tokens taken so far and those that come, which a recovery changes at its place `at`.

    `damaged` collects what was mended or left out; at the token `resumed_at` something was left out before.
    """

    def __init__(self, source: Source, machine: Machine, scanner: Scanner) -> None:
        self.source = source
        self.text = source.text
        self.machine = machine
        self.scanner = scanner
        scanned = list(scanner.tokens(source.text))
        self._comments = [token for token in scanned if token.kind == COMMENT]
        self.tokens = [part for token in scanned if token.kind != COMMENT for part in _parts(token)]
        self.at = 0
        self.done: list[Done] = []
        self.stack = machine.start
        self.opened: Opened = None
        self.damaged: list[Span] = []
        self.resumed_at = -1
        self._start = (0, 0, -1)
        """For so many open braces: where the statement began, and how many tokens were taken then."""

    def take(self, token: Token, stack: Stack, kind: str) -> None:
        """Take a token that `Machine.step` lets follow."""
        if token.kind != kind:
            token = token._replace(kind=kind)
        self.done.append(Done(token, self.stack, self.opened))
        self.stack = stack
        if token.text in ("(", "[", "{"):
            self.opened = (token, self.opened, braces(self.opened) + (token.text == "{"))
        elif token.text in (")", "]", "}") and self.opened is not None:
            self.opened = self.opened[1]

    def give_back(self, length: int) -> None:
        """Only the first `length` tokens stay taken."""
        if length < len(self.done):
            _, self.stack, self.opened = self.done[length]
            del self.done[length:]
            most, start, until = self._start
            self._start = (most, start, min(until, length) if start < length else -1)

    def put_in(self, tokens: tuple[Token, ...]) -> bool:
        """Take tokens that do not stand in the text; False where one cannot follow."""
        for token in tokens:
            stepped = self.machine.step(self.stack, token)
            if stepped is None:
                return False
            self.take(token, *stepped)
        return True

    def below(self, length: int) -> Stack:
        """The stack that holds the first `length` tokens."""
        return self.done[length].before if length < len(self.done) else self.stack

    def opened_at(self, length: int) -> Opened:
        """The brackets that were open behind the first `length` tokens."""
        return self.done[length].opened if length < len(self.done) else self.opened

    def statement_start(self) -> int:
        """How many tokens stand before the statement or definition that was begun, its label among it."""
        most = braces(self.opened)
        known, start, until = self._start
        if known != most or until > len(self.done):
            until, start = -1, 0
        for length in range(len(self.done), until, -1):
            stack = self.below(length)
            if (
                braces(self.opened_at(length)) <= most
                and not (length and self.done[length - 1].token.text == ":")
                and any(self.machine.shift(stack, kind) is not None for kind in (STATEMENT, ITEM))
            ):
                start = length
                break
        self._start = (most, start, len(self.done))
        return start

    def hurt(self, begin: int, end: int) -> None:
        """Note as damaged the statement around, as far as it reaches over the given part."""
        length = self.statement_start()
        if length < len(self.done):
            begin = min(begin, self.done[length].token.start)
        self.damaged.append(Span(self.source.file, begin, line_end(self.text, max(begin, end))))

    def skip(self, length: int, index: int) -> None:
        """Leave out all from the first `length` tokens to the one at `index`."""
        self.hurt(
            self.done[length].token.start if length < len(self.done) else self.tokens[self.at].start,
            self.tokens[max(self.at, index - 1)].start,
        )
        self.give_back(length)
        self.at = index
        self.resumed_at = index

    def tokens_from(self, position: int) -> list[Token]:
        """What comes from a place on; scanned anew as far as it lies inside of a token."""
        index = bisect_left(self.tokens, position, lo=self.at, key=lambda token: token.start)
        fresh: list[Token] = []
        covered = self.tokens[index - 1].end if index > self.at else position
        if covered > position:
            fresh = [
                token
                for token in self.scanner.tokens(self.text[:covered], position)
                if token.kind not in (END, COMMENT)
            ]
        return [*fresh, *self.tokens[index:]]

    def with_comments(self) -> Iterator[Token]:
        """All that is taken, with the comments of the text in their places."""
        waiting = iter(self._comments)
        comment = next(waiting, None)
        for done in self.done:
            while comment is not None and comment.start < done.token.start:
                yield comment
                comment = next(waiting, None)
            yield done.token


def _parts(token: Token) -> tuple[Token, ...]:
    """A text that is not closed gives back the brace at the end of its line, which likely is none of it."""
    if token.kind != STRAY or token.text[0] != '"' or (match := _BRACE.search(token.text, 1)) is None:
        return (token,)
    kind = "LBRACE" if match[1] == "{" else "RBRACE"
    place = token.start + match.start(1)
    text = token.text[: match.start()]
    return (
        token._replace(text=text, end=token.start + len(text)),
        Token(kind, match[1], place, place + 1),
    )


def braces(opened: Opened) -> int:
    """How many braces are open."""
    return 0 if opened is None else opened[2]
