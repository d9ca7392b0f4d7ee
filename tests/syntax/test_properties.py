"""What holds for any text: spans give back what was written, and no text makes the parser raise."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tests.syntax import corpus
from xei_lang.diagnostics import Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.quantity import parse_quantity
from xei_lang.syntax import Parser, ast

PARSER = Parser()
MEMBERS = [corpus.in_protocol(member) for member in corpus.MEMBERS.values()]
TEXTS = [corpus.WHOLE, *corpus.FILES.values(), *MEMBERS]
PIECES = [*'{}()[],:=."#\n\t\0\x1b ', ":=", "..", "5 mL", "5 ul", "\u00b5", "\U0001f9ea"]
WORDS = ["for", "in", "wait", "not", "and", "start", "else", "protocol", "step", "of", "Volume", "x", "1"]


@given(st.sampled_from(TEXTS))
def test_spans_give_back_the_text(text: str) -> None:
    source = Source("t.xei", text)
    module, _ = PARSER.module(source)
    assert module is not None
    for node in ast.walk(module):
        written = source.slice(node.span)
        match node:
            case ast.Name() | ast.Role():
                assert written == node.id
            case ast.QuantityLit():
                assert parse_quantity(written) == node.value
            case ast.Bool():
                assert written == str(node.value).lower()
            case ast.Comment():
                assert written == node.text
            case ast.StringLit():
                assert written[0] + written[-1] == '""'
            case ast.Block():
                assert written[0] + written[-1] == "{}"
            case ast.Module():
                assert written == text
            case _:
                assert written == written.strip() != ""
        for child in ast.children(node):
            assert node.span.start <= child.span.start <= child.span.end <= node.span.end


@st.composite
def mutated(draw: st.DrawFn) -> str:
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(1, 4))):
        begin = draw(st.integers(0, len(text)))
        end = min(len(text), begin + draw(st.integers(0, 6)))
        text = text[:begin] + draw(st.sampled_from(["", *PIECES, *WORDS])) + text[end:]
    return text


@given(st.one_of(mutated(), st.text(max_size=60), st.lists(st.sampled_from(PIECES + WORDS)).map(" ".join)))
def test_no_text_makes_the_parser_raise(text: str) -> None:
    source = Source("t.xei", text)
    module, diagnostics = PARSER.module(source)
    assert module is not None or diagnostics
    shown = render_full(diagnostics, {"t.xei": source})
    assert "\x1b" not in shown
    for diagnostic in diagnostics:
        assert diagnostic.span is not None
        assert 0 <= diagnostic.span.start <= diagnostic.span.end <= len(text)


@given(mutated())
def test_parsing_is_deterministic(text: str) -> None:
    first, second = (PARSER.module(Source("t.xei", text)) for _ in range(2))
    assert first[1] == second[1]
    assert ast.equal_up_to_spans(first[0], second[0])
