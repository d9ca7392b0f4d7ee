"""The words that the profile's check refuses as names are those that the parser does not take as names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from xei_lang.diagnostics import Source, has_errors
from xei_lang.profiles.checks.words import NO_VALUES, STATEMENTS
from xei_lang.syntax import Parser, ast

GRAMMAR = (Path(__file__).parents[2] / "grammar" / "xei.lark").read_text(encoding="utf-8")
WORDS = sorted(set(re.findall(r'"([a-z]+)"', GRAMMAR)))
PARSER = Parser()


def parsed(line: str) -> ast.Module | None:
    text = f'protocol p {{\n  profile "lab"\n  {line}\n}}\n'
    module, said = PARSER.module(Source("p.xei", text))
    return None if has_errors(said) else module


def is_name(line: str, word: str) -> bool:
    module = parsed(line)
    return module is not None and any(
        isinstance(node, ast.Name) and node.id == word for node in ast.walk(module)
    )


@pytest.mark.parametrize("word", WORDS)
def test_a_word_is_refused_where_it_cannot_be_written(word: str) -> None:
    assert is_name(f"pick(object={word})", word) == (word not in NO_VALUES)
    called = parsed(f"{word}(object=tube)")
    is_called = called is not None and any(isinstance(node, ast.Call) for node in ast.walk(called))
    assert is_called == (word not in STATEMENTS)
