"""Going on behind a syntax error, so that one run shows every mistake, each once.

What does not follow the grammar is mended or left out, token by token, until the whole file follows it; the
driver then builds the tree of what remains. In this order:

1. braces that are missing or too many, where the indentation shows it (braces.py);
2. a habit that is known, with what was meant by it (habits.py);
3. one token put in, left out or replaced, if the text then goes on (repairs.py);
4. an argument, or else a statement, left out: on to the next comma, statement or closing brace.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span
from xei_lang.syntax.braces import find_brace_faults
from xei_lang.syntax.faults import Site, explain, explain_brace, explain_habit, too_many
from xei_lang.syntax.habit import Habit
from xei_lang.syntax.habits import find_habit
from xei_lang.syntax.layout import (
    begins_line,
    indent,
    is_nearly_statement,
    line_end,
    looks_like_statement,
)
from xei_lang.syntax.lexer import COMMENT, STRAY, Scanner, Token
from xei_lang.syntax.repairs import LOOK, Repair, find_repair
from xei_lang.syntax.stack import Machine, Stack
from xei_lang.syntax.tables import END

MAX_FAULTS = 100
"""After so many the rest of the file is left unread: they have a cause of their own, such as a wrong file."""

_MAX_MENDS = 1_000
_BEFORE = 10
_BRACE = re.compile(r"\s*([{}])\s*(#.*)?$")
_STATEMENT, _ITEM = "WAIT", "PROTOCOL"


class _Done(NamedTuple):
    """A token that is taken, the stack that it met, and the brackets that were open then."""

    token: Token
    before: Stack
    opened: Opened


Opened = tuple[Token, "Opened", int] | None
"""The innermost open bracket, those around it, and how many braces are among them all."""


@dataclass(frozen=True, slots=True)
class Recovered:
    """Tokens that follow the grammar, comments among them, or None where nothing does.

    `damaged` are the parts of the text that were mended or left out: what they say is not to be trusted.
    """

    tokens: tuple[Token, ...] | None
    diagnostics: Diagnostics
    damaged: tuple[Span, ...]


def recover(source: Source, machine: Machine, scanner: Scanner) -> Recovered:
    """Find every mistake in a text that does not follow the grammar."""
    return _Recovery(source, machine, scanner).run()


class _Recovery:
    def __init__(self, source: Source, machine: Machine, scanner: Scanner) -> None:
        self._source = source
        self._text = source.text
        self._machine = machine
        self._scanner = scanner
        scanned = list(scanner.tokens(source.text))
        self._comments = [token for token in scanned if token.kind == COMMENT]
        self._tokens = [part for token in scanned if token.kind != COMMENT for part in _parts(token)]
        self._at = 0
        self._done: list[_Done] = []
        self._stack = machine.start
        self._opened: Opened = None
        self._found: list[Diagnostic] = []
        self._damaged: list[Span] = []
        self._quiet_lines: set[int] = set()
        self._quiet_at = -1
        self._doubtful = -1
        self._mends = 0

    def run(self) -> Recovered:
        self._mend_braces()
        while True:
            token = self._tokens[self._at]
            stepped = self._machine.step(self._stack, token)
            if stepped is not None:
                self._take(token, *stepped)
                if token.kind == END:
                    return self._recovered(whole=True)
                self._at += 1
            elif len(self._found) >= MAX_FAULTS or self._mends >= _MAX_MENDS:
                self._found.append(too_many(self._source, token, len(self._found)))
                return self._recovered(whole=False)
            elif not self._mend():
                return self._recovered(whole=False)

    def _recovered(self, *, whole: bool) -> Recovered:
        tokens = None
        if whole:
            tokens = tuple(self._with_comments())
        found = sorted(self._found, key=lambda diagnostic: diagnostic.span.start if diagnostic.span else 0)
        return Recovered(tokens, tuple(found), tuple(self._damaged))

    def _with_comments(self) -> Iterator[Token]:
        waiting = iter(self._comments)
        comment = next(waiting, None)
        for done in self._done:
            while comment is not None and comment.start < done.token.start:
                yield comment
                comment = next(waiting, None)
            yield done.token

    # ---- taking and giving back ----

    def _take(self, token: Token, stack: Stack, kind: str) -> None:
        if token.kind != kind:
            token = token._replace(kind=kind)
        self._done.append(_Done(token, self._stack, self._opened))
        self._stack = stack
        if token.text in ("(", "[", "{"):
            self._opened = (token, self._opened, _braces(self._opened) + (token.text == "{"))
        elif token.text in (")", "]", "}") and self._opened is not None:
            self._opened = self._opened[1]

    def _give_back(self, length: int) -> None:
        """Only the first `length` tokens stay taken."""
        if length < len(self._done):
            _, self._stack, self._opened = self._done[length]
            del self._done[length:]

    def _put_in(self, tokens: tuple[Token, ...]) -> bool:
        for token in tokens:
            stepped = self._machine.step(self._stack, token)
            if stepped is None:
                return False
            self._take(token, *stepped)
        return True

    # ---- braces ----

    def _mend_braces(self) -> None:
        faults = find_brace_faults(self._tokens, self._text)
        for fault in reversed(faults):
            said = explain_brace(self._source, fault, self._tokens)
            token = self._tokens[fault.index]
            elsewhere = token.kind == END or (said.span is not None and said.span.start == token.start)
            self._report(said, quieten=fault.kind != "missing" or not elsewhere)
            if fault.kind == "extra":
                del self._tokens[fault.index]
            else:
                place = self._tokens[fault.index - 1].end
                kind, sign = ("LBRACE", "{") if fault.kind == "opening" else ("RBRACE", "}")
                self._tokens.insert(fault.index, Token(kind, sign, place, place))
        if faults:
            self._damaged.append(Span(self._source.file, 0, len(self._text)))

    # ---- one mistake ----

    def _mend(self) -> bool:
        """Report the token that cannot follow and get past it; False where nothing follows any more."""
        self._mends += 1
        before = tuple(done.token for done in self._done[-_BEFORE:])
        token = self._tokens[self._at]
        quiet = self._at == self._quiet_at or self._is_quiet(token) or self._in_doubt()
        pairs = [(done.token, done.before) for done in self._done[-_BEFORE:]]
        repair = find_repair(
            self._machine, self._scanner, self._text, pairs, self._stack, self._tokens, self._at
        )
        habit = find_habit(before, token, self._text)
        if habit is not None and not self._is_better(repair, habit):
            if not quiet and not self._is_quiet(habit):
                self._report(explain_habit(self._source, habit), quieten=False)
            if habit.mend is not None and self._follow(habit):
                return True
            self._quiet_lines.add(self._source.line_number(token.start))
            quiet = True
        if not quiet:
            said = explain(self._source, self._site(before, repair))
            if said.span is None or not self._line_is_quiet(said.span.start):
                self._report(said)
        self._doubtful = token.start if repair is None else self._doubtful
        if repair is not None and self._apply(repair):
            return True
        return self._leave_out_argument() or self._leave_out()

    def _is_better(self, repair: Repair | None, habit: Habit) -> bool:
        """Whether a repair explains more than a habit does."""
        if repair is None or not repair.whole:
            return False
        return repair.at_break or (habit.mend is not None and not self._reaches(habit, LOOK))

    def _site(self, before: tuple[Token, ...], repair: Repair | None) -> Site:
        """Where the mistake is: at the wrong token, or at the line break that lacks something before it."""
        stack, opened, index = self._stack, self._opened, self._at
        if repair is not None and repair.kind == "insert" and repair.back:
            done = self._done[len(self._done) - repair.back]
            follows = done.token.start and len(before) > repair.back
            if follows and "\n" in self._text[before[-repair.back - 1].end : done.token.start]:
                at_break = replace(repair, back=0)
                earlier = before[: -repair.back]
                return Site(self._machine, done.before, earlier, done.token, True, done.opened, at_break)
        first = begins_line(self._tokens, index, self._text)
        return Site(self._machine, stack, before, self._tokens[index], first, opened, repair)

    def _in_doubt(self) -> bool:
        """Whether the statement that was begun holds a mistake that was not wholly mended."""
        length = self._statement_start()
        return length < len(self._done) and self._done[length].token.start <= self._doubtful

    def _is_quiet(self, place: Token | Habit) -> bool:
        return self._line_is_quiet(place.start)

    def _line_is_quiet(self, position: int) -> bool:
        return self._source.line_number(position) in self._quiet_lines

    def _report(self, diagnostic: Diagnostic, *, quieten: bool = True) -> None:
        self._found.append(diagnostic)
        if quieten and diagnostic.span is not None:
            self._quiet_lines.add(self._source.line_number(diagnostic.span.start))

    def _hurt(self, begin: int, end: int) -> None:
        """Note as damaged the statement around, as far as it reaches over the given part."""
        length = self._statement_start()
        if length < len(self._done):
            begin = min(begin, self._done[length].token.start)
        self._damaged.append(Span(self._source.file, begin, line_end(self._text, max(begin, end))))

    # ---- 2 and 3: mends that keep the statement ----

    def _mended(self, habit: Habit) -> tuple[int, tuple[Token, ...], list[Token]]:
        """How many tokens stay before a habit, what is meant by it, and what comes behind."""
        length = bisect_left(self._done, habit.start, key=lambda done: done.token.start)
        mended = tuple(
            replaced._replace(start=habit.start, end=habit.end)
            for replaced in self._scanner.tokens(habit.mend or "")
            if replaced.kind not in (END, COMMENT)
        )
        return length, mended, self._tokens_from(max(habit.end, habit.through))

    def _reaches(self, habit: Habit, most: int) -> bool:
        """Whether the text follows the grammar behind a habit's mend, for so many tokens."""
        if habit.mend is None:
            return False
        length, mended, rest = self._mended(habit)
        base = self._done[length].before if length < len(self._done) else self._stack
        window = (*mended, *rest[:most])
        return self._machine.run(base, window, 0, len(window))[1] == len(window)

    def _follow(self, habit: Habit) -> bool:
        """Put what was meant in the place of what was written, if the text then goes on at all."""
        if not self._reaches(habit, 1):
            return False
        length, mended, rest = self._mended(habit)
        self._hurt(habit.start, habit.end)
        self._give_back(length)
        self._tokens[self._at :] = ()
        self._tokens.extend((*mended, *rest))
        return True

    def _tokens_from(self, position: int) -> list[Token]:
        """What comes from a place on; scanned anew as far as it lies inside of a token."""
        index = bisect_left(self._tokens, position, lo=self._at, key=lambda token: token.start)
        fresh: list[Token] = []
        covered = self._tokens[index - 1].end if index > self._at else position
        if covered > position:
            fresh = [
                token
                for token in self._scanner.tokens(self._text[:covered], position)
                if token.kind not in (END, COMMENT)
            ]
        return [*fresh, *self._tokens[index:]]

    def _apply(self, repair: Repair) -> bool:
        wrong = self._tokens[self._at]
        self._hurt(min(repair.blamed.start, wrong.start), wrong.end)
        self._give_back(len(self._done) - repair.back)
        self._at += repair.drop
        return self._put_in(repair.tokens)

    # ---- 4: leaving out ----

    def _leave_out_argument(self) -> bool:
        """Drop an argument of a call or an item of a list, with its comma."""
        length = len(self._done)
        depth = self._opened
        if depth is None or depth[0].text == "{":
            return False
        while length and self._done[length - 1].token is not depth[0]:
            done = self._done[length - 1]
            if done.token.text == "," and done.opened == depth:
                break
            length -= 1
        base = self._done[length].before if length < len(self._done) else self._stack
        level = 0
        for index in range(self._at, len(self._tokens)):
            text = self._tokens[index].text
            if text in ("{", "}", "") or (
                looks_like_statement(self._tokens, index) and begins_line(self._tokens, index, self._text)
            ):
                return False
            if level == 0 and text in (",", ")", "]"):
                begin = index + (text == ",")
                if self._machine.run(base, self._tokens, begin, 3)[1] < 3:
                    return False
                self._skip(length, begin)
                return True
            level += (text in ("(", "[")) - (text in (")", "]"))
        return False

    def _skip(self, length: int, index: int) -> None:
        self._hurt(
            self._done[length].token.start if length < len(self._done) else self._tokens[self._at].start,
            self._tokens[max(self._at, index - 1)].start,
        )
        self._give_back(length)
        self._at = index
        self._quiet_at = index

    def _leave_out(self) -> bool:
        """Drop what was begun, or only what follows, and go on where a statement or definition can begin."""
        length = self._statement_start()
        stack = self._done[length].before if length < len(self._done) else self._stack
        header = self._header(length, stack)
        base = stack
        for token in header:
            stepped = self._machine.step(base, token)
            assert stepped is not None
            base = stepped[0]
        for index in range(self._at, len(self._tokens)):
            if index > self._at and self._goes_on(self._stack, index):
                self._skip(len(self._done), index)
                return True
            if self._goes_on(base, index):
                self._skip(length, index)
                return self._put_in(header)
            if self._stands_outside(base, index):
                self._skip(length, index)
                brace = self._tokens[index]
                opening = Token("LBRACE", "{", brace.start, brace.start)
                return self._put_in((*header, *self._block_header(length, base, brace), opening))
            if self._tokens[index].text == "{":
                alone = index > self._at and begins_line(self._tokens, index, self._text)
                if alone and self._machine.shift(self._stack, _STATEMENT) is not None:
                    self._skip(len(self._done), index)
                    self._quiet_at = -1
                    return True
                block = self._block_header(length, stack, self._tokens[index])
                self._skip(length, index)
                return self._put_in((*header, *block))
        return self._close_all(length)

    def _goes_on(self, stack: Stack, index: int) -> bool:
        """Whether a new statement, or the end of a block, stands at `index` and can follow."""
        token = self._tokens[index]
        if token.kind == END:
            return self._machine.step(stack, token) is not None
        if token.text != "}" and not (
            begins_line(self._tokens, index, self._text)
            and (looks_like_statement(self._tokens, index) or is_nearly_statement(self._tokens, index))
        ):
            return False
        return self._machine.run(stack, self._tokens, index, 1)[1] == 1

    def _stands_outside(self, stack: Stack, index: int) -> bool:
        """Whether a statement stands outside of all definitions, as behind a brace that closes too early."""
        tokens = self._tokens
        return (
            self._machine.shift(stack, _ITEM) is not None
            and begins_line(tokens, index, self._text)
            and indent(tokens[index], self._text) > 0
            and looks_like_statement(tokens, index)
        )

    def _statement_start(self) -> int:
        """How many tokens stand before the statement or definition that was begun."""
        braces = _braces(self._opened)
        for length in range(len(self._done), -1, -1):
            stack = self._done[length].before if length < len(self._done) else self._stack
            opened = self._done[length].opened if length < len(self._done) else self._opened
            if _braces(opened) <= braces and any(
                self._machine.shift(stack, kind) is not None for kind in (_STATEMENT, _ITEM)
            ):
                return length
        return 0

    def _header(self, length: int, stack: Stack) -> tuple[Token, ...]:
        """What keeps the blocks that the dropped part has opened, so that their braces still close something."""
        outer = self._done[length].opened if length < len(self._done) else self._opened
        lost = _braces(self._opened) - _braces(outer)
        header: list[Token] = []
        for number in range(lost):
            opening = self._tokens[self._at]
            header.extend(self._block_header(length, stack, opening) if number == 0 else ())
            header.append(Token("LBRACE", "{", opening.start, opening.start))
        return tuple(header) if lost == 1 else ()

    def _block_header(self, length: int, stack: Stack, brace: Token) -> tuple[Token, ...]:
        """What a block can stand behind, and an `else` behind it; at the top of a file a definition's words."""
        at = brace.start
        index = bisect_left(self._tokens, brace.end, lo=self._at, key=lambda token: token.start)
        if self._tokens[index].text == "{" and self._machine.shift(stack, "PARALLEL") is not None:
            return (Token("PARALLEL", "parallel", at, at),)
        if self._machine.shift(stack, "IF") is not None:
            return (Token("IF", "if", at, at), Token("TRUE", "true", at, at))
        name = Token("NAME", f"left_out_{at}", at, at)
        words = [done.token.text for done in self._done[length:]]
        if words[:1] == ["protocol"]:
            return (Token("PROTOCOL", "protocol", at, at), name)
        return (
            Token("PROCEDURE", "procedure", at, at),
            name,
            Token("LPAR", "(", at, at),
            Token("RPAR", ")", at, at),
        )

    def _close_all(self, length: int) -> bool:
        """At the end of the file: close what is open, with the statement that was begun left out."""
        self._skip(length, len(self._tokens) - 1)
        end = self._tokens[-1]
        while self._opened is not None:
            if not self._put_in((Token("RBRACE", "}", end.start, end.start),)):
                return False
        return self._machine.step(self._stack, end) is not None


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


def _braces(opened: Opened) -> int:
    return 0 if opened is None else opened[2]
