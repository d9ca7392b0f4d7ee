"""Bad input of every kind through the front end: diagnostics within bounds, and never an exception.

`tests/bench/fuzz_atheris.py` does the same for as long as one likes.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.syntax import corpus
from xei_lang.diagnostics import Source
from xei_lang.diagnostics.render.full import render_full
from xei_lang.pipeline import Request, check_request
from xei_lang.syntax import Parser, read_source

ROOT = Path(__file__).parents[2]
PROTOCOLS = [path.read_text(encoding="utf-8") for path in sorted((ROOT / "protocols").glob("*.xei"))]
TEXTS = [*PROTOCOLS, corpus.WHOLE, *map(corpus.in_protocol, corpus.MEMBERS.values())]
PIECES = [
    *"{}()[],:;=.'\"#\n\t\0\x1b\u202e\u00b5\u00d7 ",
    *(
        "..",
        "5 ul",
        "1e9",
        "//",
        "&&",
        "for",
        "wait for",
        "else",
        "repeat 1000000000 times {",
        "protocol",
        "import",
    ),
    *(
        '"\x1b[31m"',
        "9" * 30,
        "A1",
        "True",
        "range(8)",
        "within",
        "after",
        "let x =",
        '/* "',
        "if a {",
        "} else {",
    ),
]
PARSER = Parser()


def front(text: str) -> str:
    """Everything that a check of this text says, as a terminal shows it."""
    source = Source("fuzz.xei", text)
    request = Request(source, profile_folder=ROOT / "profiles" / "openarm_bench", open_bindings=True)
    said = check_request(request)
    shown = render_full(said, {"fuzz.xei": source})
    assert not any(char in shown for char in "\x1b\x07\x08\x7f\u202e")
    for diagnostic in said:
        span = diagnostic.span
        if span is not None and span.file == "fuzz.xei":
            assert 0 <= span.start <= span.end <= len(text)
    return shown


@st.composite
def mutated(draw: st.DrawFn) -> str:
    text = draw(st.sampled_from(TEXTS))
    for _ in range(draw(st.integers(1, 8))):
        begin = draw(st.integers(0, len(text)))
        end = min(len(text), begin + draw(st.integers(0, 20)))
        put = draw(st.one_of(st.sampled_from(PIECES), st.just(text[begin:end] * 2), st.text(max_size=3)))
        text = text[:begin] + put + text[end:]
    return text


@settings(max_examples=250, suppress_health_check=[HealthCheck.too_slow])
@given(mutated())
def test_no_mutated_protocol_gets_through_the_front_end_by_an_exception(text: str) -> None:
    front(text)


@settings(max_examples=200)
@given(st.lists(st.sampled_from(PIECES), max_size=60).map(" ".join))
def test_no_heap_of_pieces_raises(text: str) -> None:
    front(text)


@settings(max_examples=100)
@given(data=st.binary(max_size=200))
def test_no_bytes_raise(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.mktemp("fuzz") / "a.xei"
    path.write_bytes(data)
    source, said = read_source(path, "a.xei")
    assert (source is None) == bool(said)
    if source is not None:
        front(source.text)


def large() -> Iterator[tuple[str, str]]:
    """Texts of 100 kB, by the trouble that they make."""
    unit = "  a: pour(source=b, target=c, volume=2 mL) within 30 s\n"
    whole = "protocol p {\n" + unit * (100_000 // len(unit)) + "}\n"
    yield "commas lost", whole.replace(",", "")
    yield "brackets lost", whole.replace(")", "")
    yield "brackets twice", whole.replace("(", "((")
    yield "quotes", whole.replace("=", '="')
    yield "habits", whole.replace("mL", "ml;")
    yield "colons", whole.replace("=", ":")
    yield "one line", whole.replace("\n", " ").replace(",", "")
    yield "blocks", "protocol p {\n" + "do {\n" * 20_000
    yield "blocks of one line", "protocol p {" + "do {" * 25_000
    yield "closed", "}" * 100_000
    yield "braces", "{ " * 50_000
    yield "brackets", "protocol p { let x = " + "([" * 50_000
    yield "a list of slips", "protocol p { let x = [" + "1 " * 50_000
    yield "an else without end", "protocol p { if a { } " + "else if a { } " * 7_000 + "else"
    yield "indented", "\n".join(" " * (i % 400) + "do {" for i in range(480))
    yield "strays", "$" * 100_000
    yield "odd spaces", "protocol p {" + " \u00a0" * 50_000
    yield "slashes", "//" * 50_000
    yield "open texts", '"\n' * 50_000
    yield "loops without end", corpus.in_protocol("repeat 1000000000 times { wait 1 s }\n" * 2_500)


@pytest.mark.parametrize(("name", "text"), list(large()), ids=lambda value: value[:24])
def test_100_kilobytes_come_to_an_end(name: str, text: str) -> None:
    """A search without bounds would not leave these texts in a lifetime; speed is for benchmarks."""
    front(text)
    assert len(text) > 50_000, name


@pytest.mark.parametrize("count", [1, 50, 10_000])
@pytest.mark.parametrize("text", ["{", "}", "do {", "(", "[", "if a {", "parallel {", '"', "'", "not "])
def test_ten_thousand_of_anything(text: str, count: int) -> None:
    for before in ("", "protocol p {\n", "protocol p {\n  let x = "):
        front(before + text * count)
