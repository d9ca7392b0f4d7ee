from __future__ import annotations

import pytest

from xei_lang.runtime.answers import parse_answers


def test_answers_are_an_object_of_yes_and_no() -> None:
    assert parse_answers('{"confirm#1": true, "sure?": false}', "a.json") == (
        {"confirm#1": True, "sure?": False},
        (),
    )


@pytest.mark.parametrize(
    "text", ["", "[true]", '{"confirm#1": "yes"}', '{"confirm#1": 1}', "{", "[" * 100_000]
)
def test_anything_else_is_refused_with_the_way_out(text: str) -> None:
    answers, found = parse_answers(text, "a.json")
    assert answers == {}
    assert [item.code for item in found] == ["XEI0916"]


def test_two_answers_to_one_question_are_none() -> None:
    found, (said,) = parse_answers('{"confirm#1": true, "confirm#1": false}', "answers.json")
    assert (found, said.code, said.message) == ({}, "XEI0916", "`confirm#1` is answered twice")
