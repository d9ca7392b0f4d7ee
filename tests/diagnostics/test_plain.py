"""Diagnostics that were put into plain data come back equal, and nothing else comes back as one."""

from __future__ import annotations

import json
import marshal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.diagnostics import CATALOGUE, Diagnostic, Edit, Fix, Label, Span
from xei_lang.diagnostics.plain import from_plain, to_plain

texts = st.text(max_size=8)
spans = st.builds(Span, texts, st.integers(0, 99), st.integers(0, 99))
diagnostics = st.builds(
    Diagnostic,
    st.sampled_from(sorted(CATALOGUE)),
    texts,
    st.none() | spans,
    texts,
    st.lists(st.builds(Label, spans, texts), max_size=2).map(tuple),
    st.lists(texts, max_size=2).map(tuple),
    st.lists(texts, max_size=2).map(tuple),
    st.none()
    | st.builds(
        Fix,
        st.sampled_from(["safe", "unsafe", "display"]),
        st.lists(st.builds(Edit, spans, texts), max_size=2).map(tuple),
    ),
)


@given(st.lists(diagnostics, max_size=3).map(tuple))
def test_they_come_back_equal_through_json_and_marshal(said):
    assert from_plain(json.loads(json.dumps(to_plain(said)))) == said
    assert from_plain(marshal.loads(marshal.dumps(to_plain(said)))) == said


@pytest.mark.parametrize(
    "foreign",
    [
        None,
        1,
        [1],
        [[]],
        [["XEI9999", "m", None, "", [], [], [], None]],
        [["XEI0101", "m", [1], "", [], [], [], None]],
    ],
)
def test_what_is_none_is_refused(foreign):
    with pytest.raises(ValueError, match="no plain form"):
        from_plain(foreign)
