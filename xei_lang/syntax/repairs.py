"""Small changes that let a text go on where it fails: a token put in, left out, replaced or moved by one.

What is tried is ranked by how far the text then follows the grammar, and after that by how likely the slip
is.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from xei_lang.diagnostics import did_you_mean
from xei_lang.syntax.layout import begins_line, looks_like_statement
from xei_lang.syntax.lexer import COMMENT, STRAY, WORD, Scanner, Token
from xei_lang.syntax.stack import Machine, Stack
from xei_lang.syntax.tables import END, Tables

LOOK = 12
"""How many tokens further a text must follow the grammar for a repair to be as good as any."""
_ENOUGH = 3
_BACK = 3
_SIGNS = frozenset("()[]{}:=,.;")
_FILLERS = {"NAME": "_", "NUMBER": "1", "STRING": '""', "QUANTITY": "1 s", "COMPARISON": "==", "UPDATE": ":="}
_COSTS = {")": 1, "]": 1, ",": 1, ":": 1, "=": 1, "(": 2, "{": 2, "..": 2, "}": 6, ".": 4}
_DELETE_CLOSING = 4
"""More than a name that is put in before it: without its end, an argument list goes on in the next line."""
_WORD_COST, _NAME_COST, _OTHER_COST = 3, 3, 5
_LINE_START = 3
"""How much likelier it is that a line breaks off where the next one looks like the start of a step."""


@dataclass(frozen=True, slots=True)
class Repair:
    """Take back `back` tokens, put `tokens` in their place, and leave out `drop` of those that come."""

    kind: Literal["insert", "delete", "replace", "swap"]
    back: int
    tokens: tuple[Token, ...]
    drop: int
    cost: int
    blamed: Token
    """The token that is put in, left out, or replaced."""
    meant: str = ""
    """What was probably meant in the place of `blamed`."""
    at_break: bool = False
    """Whether the token was put in at the end of a line whose last statement breaks off."""
    whole: bool = False
    """Whether the text follows the grammar behind it as far as was looked."""


def find_repair(
    machine: Machine,
    scanner: Scanner,
    text: str,
    done: Sequence[tuple[Token, Stack]],
    stack: Stack,
    tokens: Sequence[Token],
    at: int,
) -> Repair | None:
    """The best repair where `tokens[at]` cannot follow `stack`; None where none lets the text go on.

    `done` holds the tokens before, each with the stack that it met.
    """
    best: tuple[int, int] | None = None
    found: Repair | None = None
    for candidate in _candidates(machine, scanner, text, done, stack, tokens, at):
        base = done[len(done) - candidate.back][1] if candidate.back else stack
        begin = at + candidate.drop
        window = (*candidate.tokens, *tokens[begin : begin + LOOK])
        reached = machine.run(base, window, 0, len(window))[1]
        gain = reached - len(candidate.tokens) + (LOOK if reached == len(window) else 0)
        read = reached - 1 if candidate.at_break else gain
        if read < min(_ENOUGH, len(tokens) - begin):
            continue
        rank = (gain, -candidate.cost)
        if best is None or rank > best:
            best, found = rank, replace(candidate, whole=reached == len(window))
    return found


def _candidates(
    machine: Machine,
    scanner: Scanner,
    text: str,
    done: Sequence[tuple[Token, Stack]],
    stack: Stack,
    tokens: Sequence[Token],
    at: int,
) -> Iterator[Repair]:
    wrong = tokens[at]
    if wrong.kind == STRAY and wrong.text[0] == '"':
        yield from _closed_texts(scanner, text, wrong, done)
        return
    first = begins_line(tokens, at, text) if at else True
    opens_statement = first and looks_like_statement(tokens, at)
    yield from _insertions(machine, stack, (), wrong, 0, first, opens_statement)
    if wrong.kind != END and not opens_statement and wrong.text not in ("{", "}"):
        twice = bool(done) and done[-1][0].text == wrong.text
        yield Repair(
            "delete", 0, (), 1, _DELETE_CLOSING if wrong.text in (")", "]") and not twice else 2, wrong
        )
        yield from _replacements(machine, stack, (), wrong, 0)
        yield from _swaps(machine, text, done, tokens, at)
    yield from _breaks(machine, text, done, wrong)
    for back in range(1, min(_BACK, len(done)) + 1):
        old, before = done[len(done) - back]
        if old.text in ("{", "}") or old.start == old.end:
            return
        later = tuple(token for token, _ in done[len(done) - back + 1 :])
        yield from _insertions(machine, before, later, old, back, False)
        yield Repair("delete", back, later, 0, 2 + back, old)
        yield from _replacements(machine, before, later, old, back)


def _swaps(
    machine: Machine, text: str, done: Sequence[tuple[Token, Stack]], tokens: Sequence[Token], at: int
) -> Iterator[Repair]:
    """Two tokens of a line in the wrong order; a word of the language that begins its line stays there."""
    wrong, following = tokens[at], tokens[at + 1]
    if following.kind != END and following.text not in ("{", "}") and not begins_line(tokens, at + 1, text):
        yield Repair("swap", 0, _swapped(wrong, following), 2, 3, wrong)
    if not done or done[-1][0].text in ("{", "}") or begins_line(tokens, at, text):
        return
    last = done[-1][0]
    starts = len(done) > 1 and "\n" in text[done[-2][0].end : last.start]
    if not (starts and last.text in machine.tables.words):
        yield Repair("swap", 1, _swapped(last, wrong), 1, 4, wrong)


def _breaks(
    machine: Machine, text: str, done: Sequence[tuple[Token, Stack]], wrong: Token
) -> Iterator[Repair]:
    """A step at the start of a line that passed for more of the line before: that one lacks something."""
    for back in range(1, len(done)):
        old, before = done[len(done) - back]
        if "\n" not in text[done[len(done) - back - 1][0].end : old.start]:
            continue
        if old.kind != WORD:
            return
        keyword = machine.tables.words.get(old.text)
        if keyword is not None or (back == 1 and wrong.text in ("(", ":")):
            word = old._replace(kind=keyword or WORD)
            later = tuple(token for token, _ in done[len(done) - back + 1 :])
            for repair in _insertions(machine, before, later, word, back, False):
                yield replace(repair, at_break=True, cost=repair.cost - back - _LINE_START)
        return


def _insertions(
    machine: Machine,
    stack: Stack,
    later: tuple[Token, ...],
    token: Token,
    back: int,
    first: bool,
    opens_statement: bool = False,
) -> Iterator[Repair]:
    spelled = spelling(machine.tables)
    for kind in sorted(machine.expected(stack) - {END}):
        written = spelled.get(kind, "")
        new = Token(kind, written, token.start, token.start)
        cost = _COSTS.get(written, _WORD_COST if written.isalpha() else _OTHER_COST)
        if kind == WORD:
            cost = _NAME_COST
        if first and written == "{":
            cost = 0
        if opens_statement and written in (")", "]"):
            cost = 0  # What looks like a statement could as well be one more argument.
        after = (token, *later) if back else ()
        yield Repair("insert", back, (new, *after), 0, cost + back, new, written)


def _replacements(
    machine: Machine, stack: Stack, later: tuple[Token, ...], token: Token, back: int
) -> Iterator[Repair]:
    drop = 0 if back else 1
    expected = machine.expected(stack)
    spelled = spelling(machine.tables)
    known = {spelled[kind]: kind for kind in expected if kind in spelled}
    if token.text.isidentifier():
        for word in did_you_mean(token.text, [word for word in known if word.isalpha() and word != "_"])[:1]:
            if word != token.text:
                new = Token(known[word], word, token.start, token.end)
                yield Repair("replace", back, (new, *later), drop, 1 + back, token, word)
    elif token.text in _SIGNS or token.kind == STRAY:
        for sign in sorted(known):
            if sign in _SIGNS and sign not in "{}" and not (token.text == "=" and sign == "."):
                new = Token(known[sign], sign, token.start, token.end)
                yield Repair("replace", back, (new, *later), drop, 3 + back, token, sign)


def _closed_texts(
    scanner: Scanner, text: str, wrong: Token, done: Sequence[tuple[Token, Stack]]
) -> Iterator[Repair]:
    """A text that is not closed may end before any bracket or comma, or with its line.

    Or it is its first quote that is missing, before one of the last words.
    """
    cuts = [index for index, char in enumerate(wrong.text) if index and char in ",)]}"][:8]
    for cost, cut in enumerate((*reversed(cuts), len(wrong.text))):
        written = wrong.text[:cut].rstrip()
        closed = _text(written + '"', wrong.start, wrong.start + len(written))
        rest = _rest(scanner, text, wrong, cut)
        yield Repair("replace", 0, (closed, *rest), 1, cost, wrong)
    rest = _rest(scanner, text, wrong, 1)
    yield Repair("delete", 0, rest, 1, 9, wrong)
    for back in range(1, min(_BACK, len(done)) + 1):
        first = done[len(done) - back][0]
        if "\n" in text[first.start : wrong.start]:
            return
        whole = _text(f'"{text[first.start : wrong.start]}"', first.start, wrong.start + 1)
        yield Repair("replace", back, (whole, *rest), 1, back, wrong)


def _swapped(left: Token, right: Token) -> tuple[Token, ...]:
    start, end = left.start, right.end
    return right._replace(start=start, end=end), left._replace(start=start, end=end)


def _text(written: str, start: int, end: int) -> Token:
    return Token("STRING", written, start, end)


def _rest(scanner: Scanner, text: str, wrong: Token, cut: int) -> tuple[Token, ...]:
    found = scanner.tokens(text[: wrong.end], wrong.start + cut)
    return tuple(token for token in found if token.kind not in (END, COMMENT))


def spelling(tables: Tables) -> dict[str, str]:
    """A way to write each terminal: keywords and signs themselves, the others by an example."""
    return {kind: text for text, kind in (tables.words | tables.signs).items()} | _FILLERS
