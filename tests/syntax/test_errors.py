"""Texts that do not follow the grammar: what is said of them, and that nothing makes the parser fall over."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.syntax.corpus import in_protocol
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.syntax import Parser, ast, parse_expression, parse_predicate, parse_role_expression

PARSER = Parser()


def diagnose(text: str) -> Diagnostics:
    return PARSER.module(Source("t.xei", text))[1]


def rendered(text: str) -> str:
    source = Source("t.xei", text)
    return render_full(PARSER.module(source)[1], {"t.xei": source})


def test_messages(markdown: Callable[[Path, Callable[[str], str]], None]) -> None:
    markdown(Path(__file__).with_name("errors.md"), rendered)


@pytest.mark.parametrize(
    "text",
    [
        "protocol p {" + "do {" * 10_000,
        "protocol p {" + "do {" * 10_000 + "}" * 10_001,
        in_protocol("let x = " + "- " * 10_000 + "1"),
        in_protocol("let x = " + "not " * 10_000 + "a"),
        in_protocol("let x = a" + ".b" * 10_000),
        in_protocol("let x = a" + "()" * 10_000),
        in_protocol("let x = " + "[" * 10_000),
        in_protocol("let x = 1" + " + 1" * 10_000),
        in_protocol("object x: " + "not " * 10_000 + "a"),
        in_protocol("if a {} " + "else if a {} " * 5_000),
        in_protocol("let x = " + "9" * 1_000_000),
        in_protocol("let x = " + "9" * 1_000_000 + " mL"),
        in_protocol('note "' + "x" * 1_000_000),
        "x" * 1_000_000,
        "#" * 1_000_000,
        "\0" * 10_000,
        "\ud800",
    ],
    ids=lambda text: f"{text[:24]!r}...",
)
def test_monstrous_texts_get_one_diagnostic(text: str) -> None:
    (found,) = diagnose(text)
    assert found.code in ("XEI0103", "XEI0104", "XEI0107")
    assert len(found.message) < 300


def test_huge_but_flat_texts_are_fine() -> None:
    assert diagnose(in_protocol('note "' + "x" * 1_000_000 + '"')) == ()
    assert diagnose(in_protocol("let x = [" + "1, " * 20_000 + "]")) == ()
    assert diagnose(in_protocol("let x = " + "(" * 150 + "a" + ")" * 150)) == ()
    assert diagnose(in_protocol("let x = " + "(" * 150 + "1 + 1" + ")" * 150 + " + 1")) == ()


def test_control_characters_are_named_not_printed() -> None:
    shown = rendered(in_protocol("wait \x1b[31m5 s"))
    assert "\x1b" not in shown
    assert "`U+001B` is no part of the language" in shown
    assert "<U+001B>[31m5 s" in shown


def test_ordinary_nesting_is_fine() -> None:
    assert diagnose(in_protocol("do { " * 20 + "home()" + " }" * 20)) == ()


@pytest.mark.parametrize(
    ("text", "mended"),
    [
        ("wait 10 minutes", "wait 10 min"),
        ("pour(volume=2.50ul)", "pour(volume=2.50 uL)"),
        ("pour(volume: 2 mL)", "pour(volume=2 mL)"),
        ("repeat 3 { }", "repeat 3 times { }"),
        ("if a && b { }", "if a and b { }"),
        ("if a { } elif b { }", "if a { } else if b { }"),
        ("wait 5 s;", "wait 5 s"),
        ("wait 5 s // let it rest", "wait 5 s # let it rest"),
        ("// first, rest\n wait 5 s", "# first, rest\n wait 5 s"),
        ("pour(a=b, // half\n c=d)", "pour(a=b, # half\n c=d)"),
        ("x = 1", "let x = 1"),
        ("wait 5 s\n x = y", "wait 5 s\n let x = y"),
        ("if x = 1 { }", "if x == 1 { }"),
        ("if a&&b { }", "if a and b { }"),
        ("if a||b { }", "if a or b { }"),
        ("repeat 3{ }", "repeat 3 times { }"),
        ("a();b()", "a() b()"),
        ("let x = y;b()", "let x = y b()"),
        ("let x = 5; m()", "let x = 5\n m()"),
        ("wait 10 min 30 s", "wait 10 min + 30 s"),
        ("let t = 2 * 1 h 30 min", "let t = 2 * (1 h + 30 min)"),
        ("note 'hot'", 'note "hot"'),
        ("note \u201chot\u201d", 'note "hot"'),
        ("warm: start heat()", "start warm: heat()"),
        ("require !a", "require not a"),
    ],
)
def test_safe_fixes_mend(text: str, mended: str) -> None:
    source = Source("t.xei", in_protocol(text))
    (found,) = PARSER.module(source)[1]
    assert found.fix is not None
    assert found.fix.applicability == "safe"
    (edit,) = found.fix.edits
    fixed = source.text[: edit.span.start] + edit.text + source.text[edit.span.end :]
    module, diagnostics = PARSER.module(Source("t.xei", fixed))
    assert diagnostics == ()
    expected, _ = PARSER.module(Source("t.xei", in_protocol(mended)))
    assert ast.equal_up_to_spans(module and module.items, expected and expected.items)


@pytest.mark.parametrize(
    "text",
    [
        "let half = n // 2",
        "let half = n // k",
        "let half = n // (k + 1)",
        "wait 5 s // rest",
        "let half = f(n) // k - 1",
    ],
)
def test_what_may_be_a_division_is_no_comment_for_sure(text: str) -> None:
    (found,) = diagnose(in_protocol(text))
    assert found.fix is not None
    assert found.fix.applicability == "unsafe"


def test_quantities_of_other_dimensions_are_not_added() -> None:
    (found,) = diagnose(in_protocol("wait 10 min 5 mL"))
    assert found.fix is None


@pytest.mark.parametrize(
    "member",
    [
        "for x in1 { }",
        "for x inner { }",
        "repeat 3 times2 { }",
        "if nota { } elsex { }",
        "waitx 5 s",
        "wait5 s",
    ],
)
def test_keywords_are_whole_words(member: str) -> None:
    assert [diagnostic.code for diagnostic in diagnose(in_protocol(member))] == ["XEI0104"]


@pytest.mark.parametrize("parse", [parse_predicate, parse_expression, parse_role_expression])
@pytest.mark.parametrize("text", ["", "a b", "(", "protocol p { }", "a :=", "\n"])
def test_other_entrances_report_too(parse: Callable[[Source], tuple[object, Diagnostics]], text: str) -> None:
    node, diagnostics = parse(Source("bank.yaml", text))
    assert node is None
    assert [diagnostic.code for diagnostic in diagnostics] == ["XEI0104"]
