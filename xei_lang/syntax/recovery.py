"""Going on behind a syntax error, so that one run shows every mistake, each once.

What does not follow the grammar is mended or left out, token by token, until the whole file follows it; the
driver then builds the tree of what remains. In this order:

1. braces that are missing or too many, where the indentation shows it (braces.py);
2. a bracket that stays open inside of a call over several lines (parentheses.py);
3. a habit that is known, with what was meant by it (habits.py);
4. one token put in, left out or replaced, if the text then goes on (repairs.py);
5. an argument, or else a statement, left out: on to the next comma, statement or closing brace.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from dataclasses import dataclass, replace

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span
from xei_lang.syntax.braces import find_brace_faults
from xei_lang.syntax.cursor import Cursor
from xei_lang.syntax.faults import (
    Site,
    explain,
    explain_brace,
    explain_habit,
    explain_unclosed,
    too_many,
)
from xei_lang.syntax.habit import Habit
from xei_lang.syntax.habits import find_habit
from xei_lang.syntax.layout import (
    begins_line,
)
from xei_lang.syntax.leaving_out import leave_out, leave_out_argument
from xei_lang.syntax.lexer import COMMENT, Scanner, Token
from xei_lang.syntax.nesting import MAX_FAULTS
from xei_lang.syntax.parentheses import Unclosed, find_unclosed
from xei_lang.syntax.repairs import LOOK, Repair, find_repair
from xei_lang.syntax.stack import Machine
from xei_lang.syntax.tables import END

_MAX_MENDS = 1_000
_BEFORE = 10
_BRACE = re.compile(r"\s*([{}])\s*(#.*)?$")
_STATEMENT, _ITEM = "WAIT", "PROTOCOL"


@dataclass(frozen=True, slots=True)
class Recovered:
    """Tokens that follow the grammar, comments among them, or None where nothing does.

    `damaged` are the parts of the text that were mended or left out: what they say is not to be trusted. A
    brace that was mended damages the whole text, although its words stand as they were written: only the
    parts in `changed` hold others.
    """

    tokens: tuple[Token, ...] | None
    diagnostics: Diagnostics
    damaged: tuple[Span, ...]
    changed: tuple[Span, ...]


def recover(source: Source, machine: Machine, scanner: Scanner) -> Recovered:
    """Find every mistake in a text that does not follow the grammar."""
    return _Recovery(source, machine, scanner).run()


class _Recovery:
    def __init__(self, source: Source, machine: Machine, scanner: Scanner) -> None:
        self._cursor = Cursor(source, machine, scanner)
        self._source = source
        self._found: list[Diagnostic] = []
        self._quiet_lines: set[int] = set()
        self._doubtful = -1
        self._braces_mended = False
        self._mends = 0

    def run(self) -> Recovered:
        self._mend_braces()
        while True:
            token = self._cursor.tokens[self._cursor.at]
            stepped = self._cursor.machine.step(self._cursor.stack, token)
            if stepped is not None:
                self._cursor.take(token, *stepped)
                if token.kind == END:
                    return self._recovered(whole=True)
                self._cursor.at += 1
            elif len(self._found) >= MAX_FAULTS or self._mends >= _MAX_MENDS:
                self._found.append(too_many(self._source, token.start, token.end, len(self._found)))
                return self._recovered(whole=False)
            elif not self._mend():
                return self._recovered(whole=False)

    def _recovered(self, *, whole: bool) -> Recovered:
        tokens = None
        if whole:
            tokens = tuple(self._cursor.with_comments())
        found = sorted(self._found, key=lambda diagnostic: diagnostic.span.start if diagnostic.span else 0)
        changed = tuple(self._cursor.damaged)
        whole_text = (Span(self._source.file, 0, len(self._cursor.text)),) if self._braces_mended else ()
        return Recovered(tokens, tuple(found), (*whole_text, *changed), changed)

    # ---- braces ----

    def _mend_braces(self) -> None:
        faults = find_brace_faults(self._cursor.tokens, self._cursor.text)
        for fault in reversed(faults):
            said = explain_brace(self._source, fault, self._cursor.tokens)
            token = self._cursor.tokens[fault.index]
            elsewhere = token.kind == END or (said.span is not None and said.span.start == token.start)
            self._report(said, quieten=fault.kind != "missing" or not elsewhere)
            if fault.kind == "extra":
                del self._cursor.tokens[fault.index]
            else:
                place = self._cursor.tokens[fault.index - 1].end
                kind, sign = ("LBRACE", "{") if fault.kind == "opening" else ("RBRACE", "}")
                self._cursor.tokens.insert(fault.index, Token(kind, sign, place, place))
        self._braces_mended = bool(faults)

    # ---- one mistake ----

    def _mend(self) -> bool:
        """Report the token that cannot follow and get past it; False where nothing follows any more."""
        self._mends += 1
        unclosed = find_unclosed(self._cursor)
        if unclosed is not None and self._close(unclosed):
            return True
        before = tuple(done.token for done in self._cursor.done[-_BEFORE:])
        token = self._cursor.tokens[self._cursor.at]
        quiet = self._cursor.at == self._cursor.resumed_at or self._is_quiet(token) or self._in_doubt()
        pairs = [(done.token, done.before) for done in self._cursor.done[-_BEFORE:]]
        repair = find_repair(
            self._cursor.machine,
            self._cursor.scanner,
            self._cursor.text,
            pairs,
            self._cursor.stack,
            self._cursor.tokens,
            self._cursor.at,
        )
        habit = find_habit(before, token, self._cursor.text)
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
        return leave_out_argument(self._cursor) or leave_out(self._cursor)

    def _close(self, unclosed: Unclosed) -> bool:
        """Close the call whose `)` went to a bracket inside of it."""
        length = len(self._cursor.done)
        self._cursor.hurt(unclosed.opener.start, unclosed.closing[0].start)
        self._cursor.put_in(unclosed.closing)
        if len(self._cursor.done) == length:
            return False
        if not self._line_is_quiet(unclosed.opener.start):
            self._report(explain_unclosed(self._source, unclosed.opener, unclosed.end))
        return True

    def _is_better(self, repair: Repair | None, habit: Habit) -> bool:
        """Whether a repair explains more than a habit does."""
        if repair is None or not repair.whole:
            return False
        return repair.at_break or (habit.mend is not None and not self._reaches(habit, LOOK))

    def _site(self, before: tuple[Token, ...], repair: Repair | None) -> Site:
        """Where the mistake is: at the wrong token, or at the line break that lacks something before it."""
        stack, opened, index = self._cursor.stack, self._cursor.opened, self._cursor.at
        if repair is not None and repair.kind == "insert" and repair.back:
            done = self._cursor.done[len(self._cursor.done) - repair.back]
            follows = done.token.start and len(before) > repair.back
            if follows and "\n" in self._cursor.text[before[-repair.back - 1].end : done.token.start]:
                at_break = replace(repair, back=0)
                earlier = before[: -repair.back]
                return Site(
                    self._cursor.machine, done.before, earlier, done.token, True, done.opened, at_break
                )
        first = begins_line(self._cursor.tokens, index, self._cursor.text)
        return Site(self._cursor.machine, stack, before, self._cursor.tokens[index], first, opened, repair)

    def _in_doubt(self) -> bool:
        """Whether the statement that was begun holds a mistake that was not wholly mended."""
        length = self._cursor.statement_start()
        return length < len(self._cursor.done) and self._cursor.done[length].token.start <= self._doubtful

    def _is_quiet(self, place: Token | Habit) -> bool:
        return self._line_is_quiet(place.start)

    def _line_is_quiet(self, position: int) -> bool:
        return self._source.line_number(position) in self._quiet_lines

    def _report(self, diagnostic: Diagnostic, *, quieten: bool = True) -> None:
        self._found.append(diagnostic)
        if quieten and diagnostic.span is not None:
            self._quiet_lines.add(self._source.line_number(diagnostic.span.start))

    # ---- 3 and 4: mends that keep the statement ----

    def _mended(self, habit: Habit) -> tuple[int, tuple[Token, ...], list[Token]]:
        """How many tokens stay before a habit, what is meant by it, and what comes behind."""
        length = bisect_left(self._cursor.done, habit.start, key=lambda done: done.token.start)
        mended = tuple(
            replaced._replace(start=habit.start, end=habit.end)
            for replaced in self._cursor.scanner.tokens(habit.mend or "")
            if replaced.kind not in (END, COMMENT)
        )
        return length, mended, self._cursor.tokens_from(max(habit.end, habit.through))

    def _reaches(self, habit: Habit, most: int) -> bool:
        """Whether the text follows the grammar behind a habit's mend, for so many tokens."""
        if habit.mend is None:
            return False
        length, mended, rest = self._mended(habit)
        base = self._cursor.done[length].before if length < len(self._cursor.done) else self._cursor.stack
        window = (*mended, *rest[:most])
        return self._cursor.machine.run(base, window, 0, len(window))[1] == len(window)

    def _follow(self, habit: Habit) -> bool:
        """Put what was meant in the place of what was written, if the text then goes on at all."""
        if not self._reaches(habit, 1):
            return False
        length, mended, rest = self._mended(habit)
        self._cursor.hurt(habit.start, habit.end)
        self._cursor.give_back(length)
        self._cursor.tokens[self._cursor.at :] = ()
        self._cursor.tokens.extend((*mended, *rest))
        return True

    def _apply(self, repair: Repair) -> bool:
        wrong = self._cursor.tokens[self._cursor.at]
        length = len(self._cursor.done) - repair.back
        first = self._cursor.done[length].token if repair.back else wrong
        self._cursor.give_back(length)
        self._cursor.hurt(min(repair.blamed.start, first.start), wrong.end)
        self._cursor.at += repair.drop
        return self._cursor.put_in(repair.tokens)
