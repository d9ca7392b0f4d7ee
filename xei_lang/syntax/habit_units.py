"""Numbers and units as lab notes have them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from xei_lang.quantity import Dimension, QuantityError, parse_quantity, suggest_unit
from xei_lang.syntax.habit import Habit, instead
from xei_lang.syntax.lexer import STRAY, Token

_TIMES_G = re.compile(r"[xX\N{MULTIPLICATION SIGN}][ \t]*g(?!\w)")
_CELSIUS = re.compile(r"[ \t]*[cC](?:elsius)?(?!\w)")
_PART = re.compile(r"\.[0-9]+(?:[ \t]*[A-Za-z]+(?![\w(:=]))?")
_COMMA_PART = re.compile(r",[0-9]+(?:[ \t]*[A-Za-z]+(?![\w(:=]))?")
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
    for number, unit in _numbers(before, token, text):
        if number.kind != "NUMBER" or unit.kind not in ("NAME", STRAY):
            continue
        rate = _RATE.match(text, unit.start)
        for written in (rate[0] if rate else "", unit.text):
            better = _better(written)
            if better is not None:
                end = unit.start + len(written)
                return _unit_habit(f"{number.text} {better}", written, number.start, end)
    return None


def _better(written: str) -> str | None:
    """The unit that is meant, also where only one side of a rate is wrong."""
    if not written:
        return None
    above, slash, below = written.partition("/")
    known = suggest_unit(written)
    if known is not None or not slash:
        return known
    return suggest_unit(f"{suggest_unit(above) or above}/{suggest_unit(below) or below}")


def _spaced(before: Sequence[Token], token: Token, text: str) -> Habit | None:
    """`3000 x g`, `37 deg C`: units that are written apart."""
    for number, word in _numbers(before, token, text):
        apart, unit = (_TIMES_G, "xg") if number.kind == "NUMBER" else (_CELSIUS, "degC")
        found = apart.match(text, word.start)
        if found is not None and (unit == "xg" or number.text.endswith("deg")):
            digits = number.text.removesuffix("deg").rstrip()
            written = text[number.start + len(digits) : found.end()].strip()
            return _unit_habit(f"{digits} {unit}", written, number.start, found.end())
    return None


def _numbers(before: Sequence[Token], token: Token, text: str) -> Iterator[tuple[Token, Token]]:
    """A number and the word behind it on its line: the wrong token, or the one before it."""
    for number, word in ((before[-1:], token), (before[-2:-1], before[-1] if before else token)):
        is_number = bool(number) and number[0].kind in ("NUMBER", "QUANTITY")
        if is_number and "\n" not in text[number[0].end : word.start]:
            yield number[0], word


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
    if not before or before[-1].end != token.start:
        part = _PART.match(text, token.start)
        if part is None:
            return None
        return instead(part[0], f"0{part[0]}", token.start, "write a zero before the point")
    first = before[-1]
    part = _COMMA_PART.match(text, token.start)
    if part is None or first.kind != "NUMBER":
        return None
    written = first.text + part[0]
    right = f"{first.text}.{part[0][1:]}"
    return instead(written, right, first.start, "decimals stand behind a point", certain=False)


def _unit_habit(mended: str, written: str, start: int, end: int) -> Habit:
    label = f"expected `{mended.rpartition(' ')[2]}`"
    return Habit(f"`{written}` is not a unit", label, start, end, (f"write `{mended}`",), mended)
