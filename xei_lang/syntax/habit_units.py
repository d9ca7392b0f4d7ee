"""Numbers and units as lab notes have them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from xei_lang.quantity import Dimension, QuantityError, parse_quantity, suggest_unit
from xei_lang.syntax.habit import Habit, instead
from xei_lang.syntax.lexer import STRAY, Token

_RATE = re.compile(r"\S+?/[A-Za-z]+[0-9]?(?![\w/])|\w+\^2|\w+/s\N{SUPERSCRIPT TWO}")


def find_unit_habit(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`2 ul`, `3000 x g`, `10 min 30 s`, `1,5 mL`, `.5 mL`, `1e3`; None where none of them stands here."""
    return (
        _spaced(before, token, text)
        or _unit(before, token, text)
        or _joined(token)
        or _two_quantities(before, token, text)
        or _decimal(before, token, text)
    )


def _unit(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """A number, then on the same line a word that is nearly a unit.

    A wrong unit may pass for the name of the next step, so that the token after it is the one that fails.
    """
    for number, unit in ((before[-1:], token), (before[-2:-1], before[-1] if before else token)):
        if not number or number[0].kind != "NUMBER" or "\n" in text[number[0].end : unit.start]:
            continue
        if unit.kind not in ("NAME", STRAY):
            continue
        rate = _RATE.match(text, unit.start)
        for written in (rate[0] if rate else "", unit.text):
            better = suggest_unit(written)
            if better is not None and written:
                end = unit.start + len(written)
                return _unit_habit(f"{number[0].text} {better}", written, number[0].start, end)
    return None


def _spaced(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`3000 x g`, `37 deg C`: units that are written apart."""
    last = [*before[-3:], token]
    for unit, words, number in (
        ("xg", ("x", "g"), "NUMBER"),
        ("xg", ("\N{MULTIPLICATION SIGN}", "g"), "NUMBER"),
    ):
        for at in range(len(last) - 2):
            one, two, three = last[at : at + 3]
            if (
                one.kind == number
                and (two.text, three.text) == words
                and "\n" not in text[one.start : three.end]
            ):
                return _unit_habit(f"{one.text} {unit}", f"{two.text} {three.text}", one.start, three.end)
    for at in range(len(last) - 1):
        one, two = last[at : at + 2]
        if (
            one.kind == "QUANTITY"
            and one.text.endswith("deg")
            and two.text in ("C", "c", "Celsius", "celsius")
        ):
            number = one.text.removesuffix("deg").strip()
            return _unit_habit(f"{number} degC", f"deg {two.text}", one.start, two.end)
    return None


def _joined(token: Token) -> Habit | None:
    """`2ul`, `37\N{DEGREE SIGN}C`, `1e3`: what the scanner could not take apart."""
    if token.kind != STRAY or not token.text[0].isdigit():
        return None
    written = token.text.lstrip("0123456789.")
    digits = token.text.removesuffix(written)
    better = suggest_unit(written)
    if better is not None:
        return _unit_habit(f"{digits} {better}", written, token.start, token.end)
    if re.fullmatch(r"[0-9.]+[eE][0-9]*", token.text):
        help_ = ("write the number out, or take a smaller or larger unit",)
        return Habit("numbers have no exponent", "an exponent", token.start, token.end, help_)
    return None


def _two_quantities(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`10 min 30 s`; in brackets where an operator beside it would take only one of the two."""
    if not before or token.kind != "QUANTITY" or before[-1].kind != "QUANTITY":
        return None
    first = before[-1]
    if "\n" in text[first.end : token.start]:
        return None
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


def _decimal(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`1,5 mL` and `.5 mL`."""
    following = text[token.end : token.end + 1]
    if token.text == "." and following.isdigit():
        return instead(".", "0.", token.start, "write a zero before the point")
    if token.text == "," and following.isdigit() and before and before[-1].end == token.start:
        if before[-1].kind == "NUMBER":
            return instead(",", ".", token.start, "decimals stand behind a point", certain=False)
    return None


def _unit_habit(mended: str, written: str, start: int, end: int) -> Habit:
    label = f"expected `{mended.rpartition(' ')[2]}`"
    return Habit(f"`{written}` is not a unit", label, start, end, (f"write `{mended}`",), mended)
