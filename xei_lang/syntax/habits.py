"""What hands write by habit from other languages and from lab notes, told apart from a mere wrong token."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from xei_lang.syntax.habit import Habit, instead
from xei_lang.syntax.habit_signs import find_sign_habit
from xei_lang.syntax.habit_units import find_unit_habit
from xei_lang.syntax.habit_words import find_pair_habit, find_word_habit
from xei_lang.syntax.layout import line_end
from xei_lang.syntax.lexer import Token


def find_habit(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """The habit behind a wrong token, given what stands before it; None where none is known."""
    found = (
        find_unit_habit(before, token, text)
        or find_pair_habit(before, token, text)
        or find_sign_habit(before, token, text)
        or find_word_habit(before, token)
        or (_around_name(before, token, text) if before else None)
    )
    return None if found is None else _kept_apart(found, text)


def _around_name(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    previous = before[-1]
    if token.text == ":" and previous.kind == "NAME" and _are_of_let(before):
        return Habit(
            f"`{previous.text}` is given a type, which a `let` does not have",
            "expected `=`",
            token.start,
            token.end,
            ("leave the type out: a `let` has that of its value",),
        )
    if token.text == ":" and previous.kind == "NAME" and len(before) > 1 and before[-2].text in "(,":
        message = f"the argument `{previous.text}` is given with `:`"
        return Habit(message, "expected `=`", token.start, token.end, (f"write `{previous.text}=...`",), "=")
    if token.text in ("(", ",", "["):
        return _several_names(previous, token, text)
    if token.text in ("=", ":=", "+=", "-=") and previous.kind == "NAME":
        return _assignment(before, token, text)
    if token.kind == "COMPARISON" and any(other.kind == "COMPARISON" for other in before[-4:-1]):
        return Habit(
            "comparisons are not chained",
            "a second comparison",
            token.start,
            token.end,
            ("write two of them: `a < b and b < c`",),
        )
    return None


def _are_of_let(before: Sequence[Token]) -> bool:
    """Whether the last token is a name of `let a, b`."""
    place = len(before) - 2
    while place > 0 and before[place].text == "," and before[place - 1].kind == "NAME":
        place -= 2
    return place >= 0 and before[place].text == "let"


_NAMES = r"[A-Za-z_]\w*(?:[ \t]*,[ \t]*[A-Za-z_]\w*){0,7}"
_ENCLOSED = re.compile(rf"[(\[][ \t]*({_NAMES})[ \t]*,?[ \t]*[)\]](?=[ \t]*(?:=|in\b))")
_ASSIGNED = re.compile(rf"({_NAMES})[ \t]*=(?!=)")


def _several_names(previous: Token, token: Token, text: str) -> Habit | None:
    """`let (a, b) = pair`, `for (a, b) in pairs`, and `a, b = pair` as in Python."""
    if previous.text in ("let", "for"):
        found = _ENCLOSED.match(text, token.start)
        message = f"the names of a `{previous.text}` stand without parentheses"
        help_ = (f"write `{previous.text} {found[1]}`",) if found else ()
        return found and Habit(message, "expected a name", found.start(), found.end(), help_, found[1])
    line = text[text.rfind("\n", 0, previous.start) + 1 : previous.start]
    found = _ASSIGNED.match(text, previous.start) if token.text == "," and not line.strip(" \t{}") else None
    if found is None or found.end(1) == previous.end or _closes_a_call(text, found.end()):
        return None
    names, help_ = found[1], f"write `let {found[1]} = ...`; a name keeps its value"
    message, label = f"`{names}` are given values without `let`", "no assignment can stand here"
    return Habit(message, label, found.start(), found.end(), (help_,), f"let {names} =")


_CONDITIONS = frozenset({"if", "require", "until", "keep", "given", "and", "or", "not"})


def _assignment(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`x = 1` as a statement of Python, or for a comparison; `x += 1`; `for i = 1 .. 8`."""
    name = before[-1]
    earlier = before[-2] if len(before) > 1 else None
    if earlier is not None and earlier.text == "for" and token.text == "=":
        return instead("=", "in", token.start, "write `in`")
    if earlier is not None and earlier.text == "let":
        return instead(token.text, "=", token.start, "write `=`") if token.text == ":=" else None
    if token.text != "=":
        help_ = ("a name keeps its value; make a new one with `let`",)
        message = f"`{name.text}` cannot be changed by `{token.text}`"
        return Habit(message, "no assignment can stand here", name.start, token.end, help_)
    if earlier is not None and earlier.text in _CONDITIONS:
        return Habit("`=` compares nothing", "expected `==`", token.start, token.end, ("write `==`",), "==")
    if earlier is not None and earlier.text == "measure":
        help_ = (f"say what it measures: `measure {name.text}: Temperature = ...`",)
        return Habit(
            f"`{name.text}` is measured without a type", "expected `:`", name.start, token.end, help_
        )
    return _without_let(earlier, name, token, text)


def _without_let(earlier: Token | None, name: Token, token: Token, text: str) -> Habit | None:
    if _closes_a_call(text, token.end):
        return None
    begins = earlier is None or earlier.text in "{}" or "\n" in text[earlier.end : name.start]
    return Habit(
        f"`{name.text}` is given a value without `let`",
        "no assignment can stand here",
        name.start,
        token.end,
        (f"write `let {name.text} = ...`; a name keeps its value",),
        f"let {name.text} =" if begins else None,
    )


_PARENTHESIS = re.compile(r'"[^"\n]*"|[()]')
_FAR = 1_000


def _closes_a_call(text: str, start: int) -> bool:
    """Whether a `)` that nothing has opened follows on the line: a step that lacks its `(` then."""
    depth = 0
    for found in _PARENTHESIS.finditer(text, start, min(line_end(text, start), start + _FAR)):
        depth += (found[0] == "(") - (found[0] == ")")
        if depth < 0:
            return True
    return False


def _kept_apart(habit: Habit, text: str) -> Habit:
    """A mend with a space where it would otherwise grow together with a word beside it."""
    left, right = text[: habit.start][-1:], text[habit.end :][:1]
    mend = habit.mend
    if mend is None:
        return habit
    if not mend:
        return replace(habit, mend=" ") if _is_word(left) and _is_word(right) else habit
    before = " " if _is_word(left) and _is_word(mend[0]) else ""
    behind = " " if _is_word(right) and _is_word(mend[-1]) else ""
    return replace(habit, mend=f"{before}{mend}{behind}") if before or behind else habit


def _is_word(char: str) -> bool:
    return char.isalnum() or char == "_"
