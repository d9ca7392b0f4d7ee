"""What hands write by habit from other languages and from lab notes, told apart from a mere wrong token."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from xei_lang.diagnostics import Edit, Fix, Span
from xei_lang.quantity import Dimension, QuantityError, parse_quantity, suggest_unit
from xei_lang.syntax.layout import line_end
from xei_lang.syntax.lexer import STRAY, Token


@dataclass(frozen=True, slots=True)
class Habit:
    """A known miswriting at characters `[start, end)`, with the text to put there if that mends it.

    `certain` says that the mend can mean nothing else than what was meant. The text is read on behind
    `through`, or behind the habit itself.
    """

    message: str
    label: str
    start: int
    end: int
    help: tuple[str, ...] = ()
    mend: str | None = None
    certain: bool = True
    through: int = 0

    def fix(self, file: str) -> Fix | None:
        """The mend as an edit."""
        if self.mend is None:
            return None
        edit = Edit(Span(file, self.start, self.end), self.mend)
        return Fix("safe" if self.certain else "unsafe", (edit,))


_SIGNS = {"&": "and", "|": "or"}
_QUOTES = "'\N{LEFT SINGLE QUOTATION MARK}\N{RIGHT SINGLE QUOTATION MARK}\u201c\u201d"
_VALUES = frozenset({"NAME", "NUMBER", "QUANTITY", "STRING", "RPAR", "RSQB"})
_PROSE = re.compile(r"[ \t]*[A-Za-z][\w'-]*[.,:;!?]?[ \t]+[A-Za-z]")
"""Two words with nothing between them but a space, as no expression has them."""
_CONDITIONS = frozenset({"if", "require", "until", "keep", "given", "and", "or", "not"})
_QUOTED = re.compile(f'[{_QUOTES}]([^{_QUOTES}"\\\\\n]*)[{_QUOTES}](?!\\w)')


def find_habit(before: list[Token], token: Token, text: str) -> Habit | None:
    """The habit behind a wrong token, given what stands before it; None where none is known."""
    found = _unit(before, token, text)
    if found is not None:
        return found
    if token.text == "/" and "/" in (text[token.start - 1 : token.start], text[token.end : token.end + 1]):
        return _slashes(before, token, text)
    if token.text in _SIGNS:
        doubled = text.startswith(token.text, token.end)
        right = _SIGNS[token.text]
        habit = _instead(token.text * (1 + doubled), right, token.start, f"write `{right}`")
        return replace(habit, mend=_apart(right, habit, text))
    if token.text == ";":
        return _semicolon(before, token, text)
    if token.kind == STRAY:
        return _stray(token, text)
    return (_around_name(before, token, text) or _around_keyword(before, token, text)) if before else None


def _slashes(before: list[Token], token: Token, text: str) -> Habit:
    """A comment of C; behind a value it may be a division of Python, unless several words follow."""
    start = token.start - (text[token.start - 1 : token.start] == "/")
    before = [other for other in before if other.end <= start]
    end = line_end(text, start)
    begins_line = not text[text.rfind("\n", 0, start) + 1 : start].strip()
    behind_value = bool(before) and before[-1].kind in _VALUES and not begins_line
    certain = not behind_value or bool(_PROSE.match(text, start + 2, end))
    return replace(_instead("//", "#", start, "write `#`"), through=end, certain=certain)


def _semicolon(before: list[Token], token: Token, text: str) -> Habit:
    """Left out, but what it held apart stays apart: `5; m()` is no quantity, `a;b` no single word."""
    rest = text[token.end : line_end(text, token.end)].strip()
    mend = ""
    if before and before[-1].kind == "NUMBER" and rest:
        line = text.rfind("\n", 0, token.start) + 1
        mend = "\n" + text[line : line + len(text[line:]) - len(text[line:].lstrip())]
    habit = Habit(
        "`;` has no place in a protocol",
        "not needed",
        token.start,
        token.end,
        ("leave it out: a step ends where the next begins",),
    )
    return replace(habit, mend=mend or _apart("", habit, text))


def _apart(mend: str, habit: Habit, text: str) -> str:
    """A mend with a space where it would otherwise grow together with a word beside it."""
    left, right = text[: habit.start][-1:], text[habit.end :][:1]
    if not mend:
        return " " if _is_word(left) and _is_word(right) else ""
    before = " " if _is_word(left) and _is_word(mend[0]) else ""
    behind = " " if _is_word(right) and _is_word(mend[-1]) else ""
    return f"{before}{mend}{behind}"


def _is_word(char: str) -> bool:
    return char.isalnum() or char == "_"


def _around_name(before: list[Token], token: Token, text: str) -> Habit | None:
    previous = before[-1]
    if token.text == ":" and previous.kind == "NAME" and len(before) > 1 and before[-2].text in "(,":
        message = f"the argument `{previous.text}` is given with `:`"
        return Habit(message, "expected `=`", token.start, token.end, (f"write `{previous.text}=...`",), "=")
    if token.text == "=" and previous.kind == "NAME":
        return _equals(before, token, text)
    if token.kind == "COMPARISON" and any(other.kind == "COMPARISON" for other in before[-4:-1]):
        return Habit(
            "comparisons are not chained",
            "a second comparison",
            token.start,
            token.end,
            ("write two of them: `a < b and b < c`",),
        )
    if token.kind == "QUANTITY" and previous.kind == "QUANTITY":
        return _two_quantities(before, token, text)
    return None


def _equals(before: list[Token], token: Token, text: str) -> Habit:
    """`x = 1` as a statement of Python, or for a comparison."""
    name = before[-1]
    earlier = before[-2] if len(before) > 1 else None
    if earlier is not None and earlier.text in _CONDITIONS:
        return Habit("`=` compares nothing", "expected `==`", token.start, token.end, ("write `==`",), "==")
    begins = earlier is None or earlier.text in "{}" or "\n" in text[earlier.end : name.start]
    return Habit(
        f"`{name.text}` is given a value without `let`",
        "no assignment can stand here",
        name.start,
        token.end,
        (f"write `let {name.text} = ...`; a name keeps its value",),
        f"let {name.text} =" if begins else None,
    )


def _two_quantities(before: list[Token], token: Token, text: str) -> Habit:
    """`10 min 30 s`; in brackets where an operator beside it would take only one of the two."""
    first = before[-1]
    beside = before[-2].text if len(before) > 1 else ""
    follows = text[token.end :].lstrip()[:1]
    mended = f"{first.text} + {token.text}"
    dimension = _dimension(first.text)
    same = dimension is not None and dimension == _dimension(token.text)
    bound = beside in ("*", "/", "-") or follows in ("*", "/")
    return Habit(
        f"`{first.text} {token.text}` is two quantities",
        "expected one quantity",
        first.start,
        token.end,
        (f"write `{mended}`",),
        (f"({mended})" if bound else mended) if same else None,
    )


def _dimension(text: str) -> Dimension | None:
    try:
        return parse_quantity(text).dimension
    except QuantityError:
        return None


def _around_keyword(before: list[Token], token: Token, text: str) -> Habit | None:
    previous = before[-1]
    if token.text == "{" and len(before) > 1 and before[-2].text == "repeat":
        habit = Habit("`repeat` lacks its `times`", "expected `times`", token.start, token.end)
        return replace(habit, mend=_apart("times {", habit, text))
    if previous.text == "elif":
        return Habit(
            "`elif` is no word here", "expected `else if`", previous.start, previous.end, (), "else if"
        )
    if previous.text == "start" and len(before) > 2 and before[-2].text == ":":
        label = before[-3]
        return Habit(
            "the label of a `start` stands behind that word",
            "expected a label after `start`",
            label.start,
            previous.end,
            (f"write `start {label.text}: {token.text}`",),
            f"start {label.text}:",
        )
    return None


def _unit(before: list[Token], token: Token, text: str) -> Habit | None:
    """`2 ul`, `10 minutes`, `5 µL`: a number, then on the same line a word that is nearly a unit.

    A wrong unit may pass for the name of the next step, so that the token after it is the one that fails.
    """
    for number, unit in ((before[-1:], token), (before[-2:-1], before[-1] if before else token)):
        if not number or number[0].kind != "NUMBER" or "\n" in text[number[0].end : unit.start]:
            continue
        better = suggest_unit(unit.text)
        if better is not None and unit.kind in ("NAME", STRAY):
            return _unit_habit(f"{number[0].text} {better}", unit.text, number[0].start, unit)
    if token.kind == STRAY and token.text[0].isdigit():
        written = token.text.lstrip("0123456789.")
        digits = token.text.removesuffix(written)
        better = suggest_unit(written)
        if better is not None:
            return _unit_habit(f"{digits} {better}", written, token.start, token)
    return None


def _unit_habit(mended: str, written: str, start: int, unit: Token) -> Habit:
    return Habit(
        f"`{written}` is not a unit",
        f"expected `{mended.rpartition(' ')[2]}`",
        start,
        unit.end,
        (f"write `{mended}`",),
        mended,
    )


def _stray(token: Token, text: str) -> Habit | None:
    if token.text[0] == '"':
        return Habit(
            "a text is not closed",
            'expected `"` before the end of the line',
            token.start,
            token.end,
            ("a text stays on one line",),
            _closed(token.text),
            certain=False,
        )
    if token.text[0] in _QUOTES:
        return _quotes(token, text)
    if token.text == "!":
        return _instead("!", "not ", token.start, "write `not`")
    if token.text[0].isdigit():
        return Habit(
            f"`{_short(token.text)}` is neither a number nor a name",
            "a name begins with a letter",
            token.start,
            token.end,
        )
    shown = token.text if token.text.isprintable() else f"U+{ord(token.text[0]):04X}"
    return Habit(f"`{_short(shown)}` is no part of the language", "cannot stand here", token.start, token.end)


def _closed(written: str) -> str:
    """A text that was not closed, closed before the brackets and braces at the end of its line."""
    text = written.rstrip(" \t\r)]},{")
    return f'{text}"{written[len(text) :]}'


def _quotes(token: Token, text: str) -> Habit:
    habit = Habit("a text stands in straight double quotes", 'expected `"`', token.start, token.start + 1)
    whole = _QUOTED.match(text, token.start)
    return replace(habit, end=whole.end(), mend=f'"{whole[1]}"') if whole else habit


def _instead(written: str, right: str, start: int, advice: str) -> Habit:
    message = f"`{written}` has no such use here"
    return Habit(message, f"expected `{right.strip()}`", start, start + len(written), (advice,), right)


def _short(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
