"""What formatting keeps, whatever the text: its meaning, every comment, and what is formatted already."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import HealthCheck, given, settings

from tests.syntax import corpus
from tests.syntax.programs import programs
from tests.syntax.test_properties import mutated
from xei_lang.diagnostics import Source, has_errors
from xei_lang.syntax import Parser, ast
from xei_lang.syntax.format import Formatter
from xei_lang.syntax.lexer import Scanner
from xei_lang.syntax.tables import load_tables

PARSER, FORMATTER, SCANNER = Parser(), Formatter(), Scanner(load_tables())
TEXTS = [corpus.WHOLE, *corpus.FILES.values(), *map(corpus.in_protocol, corpus.MEMBERS.values())]
LAYOUT = frozenset("(),")


def formatted(text: str) -> str:
    result, diagnostics = FORMATTER.format(Source("t.xei", text))
    assert result is not None, [diagnostic.message for diagnostic in diagnostics]
    return result


def module_of(text: str) -> ast.Module:
    module, diagnostics = PARSER.module(Source("t.xei", text))
    assert module is not None, [diagnostic.message for diagnostic in diagnostics]
    return module


def words(text: str) -> list[str]:
    """What stands in a file but for white space, redundant brackets and commas: with numbers as written."""
    return ["".join(token.text.split()) for token in SCANNER.tokens(text) if token.text not in LAYOUT]


def assert_laws(text: str) -> None:
    result = formatted(text)
    before, after = module_of(text), module_of(result)
    assert ast.equal_up_to_spans(before, after)
    assert Counter(comment.text for comment in before.comments) == Counter(
        comment.text for comment in after.comments
    )
    assert words(result) == words(text)
    assert formatted(result) == result
    assert result.endswith("\n")
    assert not result.endswith("\n\n")
    assert not result.startswith("\n")
    assert "\n\n\n" not in result
    assert all(line == line.rstrip() for line in result.split("\n"))


@pytest.mark.parametrize("text", TEXTS)
def test_laws_hold_for_each_construct(text: str) -> None:
    assert_laws(text)


@settings(max_examples=300, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
@given(programs())
def test_laws_hold_for_made_up_programs(text: str) -> None:
    assert_laws(text)


@given(mutated())
def test_no_text_makes_the_formatter_raise(text: str) -> None:
    result, diagnostics = FORMATTER.format(Source("t.xei", text))
    assert (result is None) == has_errors(diagnostics)
    if result is not None:
        assert_laws(text)
