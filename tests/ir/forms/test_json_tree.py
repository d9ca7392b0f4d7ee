"""The reader of JSON takes what the library takes, gives the same, and knows where all of it stands."""

from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.diagnostics import Source
from xei_lang.ir.forms.json_reader import MAX_DEPTH, read_json
from xei_lang.ir.forms.json_string import MAX_TEXT
from xei_lang.ir.forms.json_tree import JsonNode

SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**40), 10**40),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(st.characters(exclude_categories=["Cs"])),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner), st.dictionaries(st.text(max_size=5), inner)),
    max_leaves=20,
)
PIECES = ["{", "}", "[", "]", ",", ":", " ", "\n", '"a"', '"b', '"', "\\n", "\\", "1", "-", "0", ".5", "e3",
          "true", "null", "NaN", "Infinity", "'", "//", "\u00b5", "\t", "None", "1e400", "\x00"]  # fmt: skip


def read(text: str) -> tuple[JsonNode | None, list[str]]:
    node, said = read_json(Source("p.json", text))
    assert all(item.span is not None and 0 <= item.span.start <= item.span.end <= len(text) for item in said)
    return node, [item.code for item in said]


def strict(text: str) -> Any:
    """What the library reads; ValueError also for what it takes and JSON does not have."""

    def no_constant(word: str) -> None:
        raise ValueError(word)

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        if len(dict(pairs)) < len(pairs):
            raise ValueError("a key twice")
        return dict(pairs)

    def finite(word: str) -> float:
        if abs(float(word)) == float("inf"):
            raise ValueError(word)
        return float(word)

    return json.loads(text, parse_constant=no_constant, object_pairs_hook=once, parse_float=finite)


def nodes(node: JsonNode) -> list[JsonNode]:
    inner = [*node.items.values(), *node.elements]
    return [node, *(found for item in inner for found in nodes(item))]


@given(value=VALUES, ascii_only=st.booleans(), indent=st.sampled_from([None, 0, 3]))
def test_any_value_is_read_with_its_places(value: Any, ascii_only: bool, indent: int | None) -> None:
    text = json.dumps(value, ensure_ascii=ascii_only, indent=indent)
    node, said = read(text)
    assert said == []
    assert node is not None
    assert repr(node.plain()) == repr(value)
    for item in nodes(node):
        assert repr(json.loads(text[item.span.start : item.span.end])) == repr(item.plain())
        for key, span in item.keys.items():
            assert json.loads(text[span.start : span.end]) == key


@settings(max_examples=600)
@given(pieces=st.lists(st.sampled_from(PIECES), max_size=14))
def test_it_takes_what_the_library_takes(pieces: list[str]) -> None:
    text = "".join(pieces)
    try:
        value = strict(text)
    except ValueError:
        node, said = read(text)
        assert said
        return
    node, said = read(text)
    assert said == []
    assert node is not None
    assert repr(node.plain()) == repr(value)


@settings(max_examples=300)
@given(text=st.text())
def test_no_text_makes_it_raise(text: str) -> None:
    node, said = read(text)
    assert (node is None) <= bool(said)


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("", "XEI0110", ""),
        ("{} x", "XEI0110", "x"),
        ("[1 2]", "XEI0110", "2"),
        ('{"a" 1}', "XEI0110", "1"),
        ("{a: 1}", "XEI0110", "a"),
        ("[True]", "XEI0110", "True"),
        ("[1] // note", "XEI0110", "//"),
        ("[01]", "XEI0110", "01"),
        ("[+1]", "XEI0110", "+1"),
        ("[1,]", "XEI0110", "]"),
        ('["a', "XEI0110", '"'),
        ('["a\x01"]', "XEI0110", "\x01"),
        (r'["\x41"]', "XEI0110", r"\x"),
        (r'["\ud800"]', "XEI0110", r'"\ud800"'),
        ('{"a": 1, "b": 2, "a": 3}', "XEI0110", '"a"'),
        ("[1e999]", "XEI0110", "1e999"),
        ("[" + "9" * 301 + "]", "XEI0110", "9" * 301),
        ("[" * (MAX_DEPTH + 1) + "]" * (MAX_DEPTH + 1), "XEI0107", "["),
        ("[" * 1_000_000, "XEI0107", "["),
        ('{"a":' * 1_000_000, "XEI0107", "{"),
        ('["' + "x" * (MAX_TEXT + 1) + '"]', "XEI0107", '"' + "x" * (MAX_TEXT + 1) + '"'),
    ],
    ids=lambda value: str(value)[:12],
)
def test_each_fault_is_said_at_its_place(text: str, code: str, place: str) -> None:
    _, (said,) = read_json(Source("p.json", text))
    assert said.code == code
    assert said.span is not None
    assert text[said.span.start : said.span.end] == place
    assert len(said.message) < 200


def test_surrogate_pairs_are_characters() -> None:
    node, said = read(r'"\ud83e\uddea"')
    assert said == []
    assert node is not None
    assert node.value == "\U0001f9ea"


def test_what_stands_twice_keeps_its_first_value() -> None:
    node, _ = read('{"a": 1, "a": 2}')
    assert node is not None
    assert node.plain() == {"a": 1}
