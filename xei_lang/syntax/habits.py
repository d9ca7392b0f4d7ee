"""What hands write by habit from other languages and from lab notes, told apart from a mere wrong token."""

from __future__ import annotations

from dataclasses import dataclass, replace

from xei_lang.diagnostics import Edit, Fix, Span
from xei_lang.quantity import suggest_unit
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


_SIGNS = {"&": "and", "|": "or", "/": "#"}
_QUOTES = "'\N{LEFT SINGLE QUOTATION MARK}\N{RIGHT SINGLE QUOTATION MARK}\u201c\u201d"


def find_habit(before: list[Token], token: Token, text: str) -> Habit | None:
    """The habit behind a wrong token, given what stands before it; None where none is known."""
    found = _unit(before, token, text)
    if found is not None:
        return found
    if token.text == "/" and before and before[-1].text == "/" and before[-1].end == token.start:
        return replace(
            _instead("//", "#", before[-1].start, "write `#`"), through=line_end(text, token.end)
        )
    if token.text in _SIGNS:
        doubled = text.startswith(token.text, token.end)
        right = _SIGNS[token.text]
        if doubled or right != "#":
            return _instead(token.text * (1 + doubled), right, token.start, f"write `{right}`")
    if token.kind == STRAY:
        return _stray(token)
    return (_around_name(before, token) or _around_keyword(before, token)) if before else None


def _around_name(before: list[Token], token: Token) -> Habit | None:
    previous = before[-1]
    if token.text == ":" and previous.kind == "NAME" and len(before) > 1 and before[-2].text in "(,":
        message = f"the argument `{previous.text}` is given with `:`"
        return Habit(message, "expected `=`", token.start, token.end, (f"write `{previous.text}=...`",), "=")
    if token.text == "=" and previous.kind == "NAME":
        return Habit(
            f"`{previous.text}` is given a value without `let`",
            "no assignment can stand here",
            previous.start,
            token.end,
            (f"write `let {previous.text} = ...`; a name keeps its value",),
        )
    if token.kind == "COMPARISON" and any(other.kind == "COMPARISON" for other in before[-4:-1]):
        return Habit(
            "comparisons are not chained",
            "a second comparison",
            token.start,
            token.end,
            ("write two of them: `a < b and b < c`",),
        )
    if token.kind == "QUANTITY" and previous.kind == "QUANTITY":
        whole = f"{previous.text} {token.text}"
        return Habit(
            f"`{whole}` is two quantities",
            "expected one quantity",
            previous.start,
            token.end,
            (f"write `{previous.text} + {token.text}`",),
        )
    return None


def _around_keyword(before: list[Token], token: Token) -> Habit | None:
    previous = before[-1]
    if token.text == "{" and len(before) > 1 and before[-2].text == "repeat":
        return Habit("`repeat` lacks its `times`", "expected `times`", token.start, token.end, (), "times {")
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


def _stray(token: Token) -> Habit | None:
    if token.text == ";":
        return Habit(
            "`;` has no place in a protocol",
            "not needed",
            token.start,
            token.end,
            ("leave it out: a step ends where the next begins",),
            "",
        )
    if token.text[0] == '"':
        return Habit(
            "a text is not closed",
            'expected `"` before the end of the line',
            token.start,
            token.end,
            ("a text stays on one line",),
        )
    if token.text[0] in _QUOTES:
        return Habit("a text stands in straight double quotes", 'expected `"`', token.start, token.start + 1)
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


def _instead(written: str, right: str, start: int, advice: str) -> Habit:
    message = f"`{written}` has no such use here"
    return Habit(message, f"expected `{right.strip()}`", start, start + len(written), (advice,), right)


def _short(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."
