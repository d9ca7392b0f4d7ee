from __future__ import annotations

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.forms.canonical import dumps, line

values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=20,
)


@given(values)
def test_what_is_written_reads_back(value: Any) -> None:
    assert json.loads(dumps(value)) == value
    assert json.loads(line(value)) == value


@given(values)
def test_a_line_holds_no_line_break(value: Any) -> None:
    assert not {"\n", "\r"} & set(line(value))


def test_scalars_share_a_line_and_nesting_is_indented() -> None:
    text = dumps({"version": 1, "rows": [[0.1, 1e-9], (2, None)], "empty": {}, "name": "Fläche"})
    assert text.splitlines() == [
        "{",
        ' "version": 1,',
        ' "rows": [',
        "  [0.1, 1e-09],",
        "  [2, null]",
        " ],",
        ' "empty": {},',
        ' "name": "Fläche"',
        "}",
    ]
    assert text.endswith("}\n")


@pytest.mark.parametrize("number", [float("nan"), float("inf"), -float("inf")])
def test_a_number_without_a_word_in_json_is_refused(number: float) -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        dumps({"rows": [[number]]})
    with pytest.raises(ValueError, match="JSON compliant"):
        line([number])


def test_only_text_can_be_a_key() -> None:
    wrong: Any = {"rows": [{1: "one"}]}
    with pytest.raises(TypeError):
        dumps(wrong)
    with pytest.raises(TypeError):
        line(wrong)
