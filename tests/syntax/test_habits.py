"""Miswritings by habit: one diagnostic for each, that names it, and its mend where there is one."""

from __future__ import annotations

import pytest

from tests.syntax.corpus import in_protocol
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.syntax import Parser, ast

PARSER = Parser()

MENDED = {
    "wait for 10 min": "wait 10 min",
    "wait 10 mins": "wait 10 min",
    "pour(volume=2ul)": "pour(volume=2 uL)",
    "pour(rate=5 ul/s)": "pour(rate=5 uL/s)",
    "spin(force=3000 x g)": "spin(force=3000 xg)",
    "spin(force=3000 \u00d7 g)": "spin(force=3000 xg)",
    "heat(to=37 deg C)": "heat(to=37 degC)",
    "wait .5 min": "wait 0.5 min",
    "repeat 3x { home() }": "repeat 3 times { home() }",
    "a, b = (1, 2)": "let a, b = (1, 2)",
    "let (a, b) = (1, 2)": "let a, b = (1, 2)",
    "for (a, b) in pairs(xs) { home() }": "for a, b in pairs(xs) { home() }",
    "repeat n { home() }": "repeat n times { home() }",
    "if a then { home() }": "if a { home() }",
    "for x in xs do { home() }": "for x in xs { home() }",
    "if a { } elsif b { }": "if a { } else if b { }",
    "if a { } elseif b { }": "if a { } else if b { }",
    "if a || b { home() }": "if a or b { home() }",
    "if a => b { home() }": "if a >= b { home() }",
    "if a <> b { home() }": "if a != b { home() }",
    "if a \u2265 b { home() }": "if a >= b { home() }",
    "if a \u2264 b { home() }": "if a <= b { home() }",
    "if a \u2260 b { home() }": "if a != b { home() }",
    "let x = 2 \u00d7 a": "let x = 2 * a",
    "let x = a \u2212 b": "let x = a - b",
    "for i = 1 .. 8 { home() }": "for i in 1 .. 8 { home() }",
    "for i in 1 to 8 { home() }": "for i in 1 .. 8 { home() }",
    "for i in 1...8 { home() }": "for i in 1 .. 8 { home() }",
    "for i in 1 \u2026 8 { home() }": "for i in 1 .. 8 { home() }",
    "let x := 5": "let x = 5",
    "var x = 5": "let x = 5",
    "const x = 5": "let x = 5",
    "Wait 10 min": "wait 10 min",
    "FOR x IN xs { home() }": "for x in xs { home() }",
    "sleep 10 s": "wait 10 s",
    "wait\u00a010 min": "wait 10 min",
    "1. home()": "home()",
    "2) home()": "home()",
    "- home()": "home()",
    "\u2022 home()": "home()",
    "note \u201chot\u201d": 'note "hot"',
    "stop 'it is hot'": 'stop "it is hot"',
    "assert volume(a) > 5 mL": "require volume(a) > 5 mL",
}

UNSURE = {
    "wait 1,5 min": "wait 1.5 min",
    "for i in 1 \u2013 8 { home() }": "for i in 1 .. 8 { home() }",
}

TOLD = {
    "while a { home() }": "loops are bounded",
    "return x": "gives nothing back",
    "x += 1": "keeps its value",
    "x++": "keeps its value",
    "let x: Int = 5": "leave the type out",
    "let x = a ** 2": "no power",
    "let x = 2^3": "no power",
    "let x = a % b": "no remainder",
    "let x = 1e3 * a": "no exponent",
    "let x = { a: 1 }": "no dictionaries",
    'pour(volumes={"A1": 2 mL})': "no dictionaries",
    "wait 10 \u00b1 1 min": "write a range",
    "wait ~10 min": "write a range",
    "move(a -> b)": "named arguments",
    'note f"well {i}"': "as it is written",
    "for i in 0..<8 { home() }": "both of its ends",
    "try { home() }": "no exceptions",
    "if a ? b { home() }": "a choice is written",
    "/* rest */ home()": "a comment is a line",
    'let s = """doc"""': "one pair of quotes",
}


def one(text: str) -> Diagnostic:
    (found,) = PARSER.module(Source("t.xei", text))[1]
    assert found.code == "XEI0104"
    return found


def fixed(text: str, applicability: str) -> str:
    """The text with fixes applied until nothing is wrong, each of the kind that is expected."""
    for _ in range(5):
        _, said = PARSER.module(Source("t.xei", text))
        if not said:
            return text
        fix = said[0].fix
        assert fix is not None, said[0]
        assert fix.applicability == applicability, said[0]
        (edit,) = fix.edits
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    raise AssertionError(said)


def assert_mends(written: str, meant: str, applicability: str) -> None:
    text = fixed(in_protocol(written), applicability)
    mended, _ = PARSER.module(Source("t.xei", text))
    expected, said = PARSER.module(Source("t.xei", in_protocol(meant)))
    assert said == ()
    assert ast.equal_up_to_spans(mended and mended.items, expected and expected.items), text


@pytest.mark.parametrize(("written", "meant"), MENDED.items())
def test_safe_mends(written: str, meant: str) -> None:
    assert_mends(written, meant, "safe")


@pytest.mark.parametrize(("written", "meant"), UNSURE.items())
def test_mends_that_are_a_guess(written: str, meant: str) -> None:
    assert_mends(written, meant, "unsafe")


@pytest.mark.parametrize(("written", "words"), TOLD.items())
def test_habits_without_a_mend_are_named(written: str, words: str) -> None:
    found = one(in_protocol(written))
    assert words in " ".join((found.message, found.label, *found.help)), found


@pytest.mark.parametrize("written", MENDED)
def test_what_stands_around_is_kept(written: str) -> None:
    """After a habit the text is read as it was meant: the steps around it are all there."""
    text = in_protocol(f"a: home()\n  {written}\n  z: home()")
    module, said = PARSER.module(Source("t.xei", text))
    assert said
    assert module is not None
    labels = [node.label.id for node in ast.walk(module) if isinstance(node, ast.Step) and node.label]
    assert labels[0] == "a"
    assert labels[-1] == "z"


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("def wash() { home() }", "procedure wash() { home() }"),
        ("function wash() { home() }", "procedure wash() { home() }"),
        ('include "caps.xei"\nprotocol p { }', 'import "caps.xei"\nprotocol p { }'),
    ],
)
def test_habits_at_the_top_of_a_file(text: str, right: str) -> None:
    mended, _ = PARSER.module(Source("t.xei", fixed(text, "safe")))
    expected, _ = PARSER.module(Source("t.xei", right))
    assert ast.equal_up_to_spans(mended and mended.items, expected and expected.items)


def test_two_habits_in_one_line_are_two_mistakes() -> None:
    found = PARSER.module(Source("t.xei", in_protocol("pour(volume=2 ul, rate=3 \u00b5L/s)")))[1]
    assert [diagnostic.message for diagnostic in found] == ["`ul` is not a unit", "`\u00b5L/s` is not a unit"]
