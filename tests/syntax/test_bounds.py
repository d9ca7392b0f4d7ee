"""Texts that ask for too much: bounded, told, and never an exception, in the parser and the formatter."""

from __future__ import annotations

import pytest

from tests.syntax.corpus import in_protocol
from xei_lang.diagnostics import Source
from xei_lang.syntax import Parser
from xei_lang.syntax.format import Formatter
from xei_lang.syntax.nesting import MAX_FAULTS, MAX_NESTING

PARSER, FORMATTER = Parser(), Formatter()


def codes(text: str) -> list[str]:
    return [item.code for item in PARSER.module(Source("t.xei", text))[1]]


@pytest.mark.parametrize("pair", ["()", "[]", "( # a comment\n)"])
@pytest.mark.parametrize("count", [MAX_NESTING + 5, 10_000])
def test_brackets_in_brackets_have_a_bound(pair: str, count: int) -> None:
    opening, closing = pair[:-1], pair[-1]
    for typed in ("let x = {}", "object a: {}"):
        inner = "1" if "let" in typed else "tube"
        text = in_protocol(typed.format(opening * count + inner + closing * count))
        found = codes(text)
        assert found
        assert set(found) <= {"XEI0107", "XEI0104", "XEI0109"}
        assert FORMATTER.format(Source("t.xei", text))[0] is None


def test_brackets_side_by_side_have_none() -> None:
    assert codes(in_protocol("let x = [" + ", ".join(["((1))"] * 400) + "]")) == []
    assert codes(in_protocol("let x = [" + ", ".join(["((1 + 2) * 3)"] * 400) + "]")) == []


def test_brackets_up_to_the_bound_are_formatted() -> None:
    deep = MAX_NESTING
    text, found = FORMATTER.format(
        Source("t.xei", in_protocol("let x = " + "(" * deep + "1 + 2" + ")" * deep))
    )
    assert text is not None, found
    assert "let x = 1 + 2\n" in text


def test_wrong_escapes_are_told_up_to_a_bound() -> None:
    found = codes(in_protocol('note "' + "\\q" * 5_000 + '"'))
    assert found == ["XEI0104"] * MAX_FAULTS + ["XEI0109"]


def test_a_statement_that_is_begun_again_and_again_is_found_once() -> None:
    """What recovery remembers of a statement's beginning holds after parts of it were given back."""
    items = ", ".join("1 *" if number % 7 == 3 else "2" for number in range(60))
    _, said = PARSER.module(Source("t.xei", in_protocol(f"let x = [{items}]\nwait = 1\nlet y = [1, * 2]")))
    assert {item.code for item in said} == {"XEI0104"}
