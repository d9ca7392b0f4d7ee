from __future__ import annotations

from dataclasses import replace

import pytest

from tests.runtime.small import handoffs
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.runtime.answers import Answers, check_answers, read_answers


def read(text: str) -> tuple[Answers, Diagnostics]:
    return read_answers(Source("a.json", text))


def spoken_of(text: str, said: Diagnostics) -> list[str]:
    return [text[item.span.start : item.span.end] for item in said if item.span]


def test_answers_are_an_object_of_yes_and_no() -> None:
    answers, said = read('{"confirm#1": true, "sure?": false}')
    assert (answers.given, said) == ({"confirm#1": True, "sure?": False}, ())


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("", "XEI0110", ""),
        ("{", "XEI0110", ""),
        ("[" * 100_000, "XEI0107", "["),
        ("[true]", "XEI0916", "[true]"),
        ('{"confirm#1": "yes"}', "XEI0916", '"yes"'),
        ('{"confirm#1": 1}', "XEI0916", "1"),
    ],
)
def test_anything_else_is_refused_where_it_stands(text: str, code: str, place: str) -> None:
    answers, said = read(text)
    assert answers.given == {}
    assert [item.code for item in said] == [code]
    assert spoken_of(text, said) == [place]


def test_two_answers_to_one_question_are_none() -> None:
    answers, (said,) = read('{"confirm#1": true, "confirm#1": false}')
    assert (answers.given, said.code, said.message) == ({}, "XEI0110", "`confirm#1` stands twice")


def test_answers_by_step_or_by_question_are_to_what_the_plan_asks() -> None:
    answers, said = read('{"confirm#1": true, "is the bench clear?": true}')
    assert (said, check_answers(answers, handoffs().graph)) == ((), ())


@pytest.mark.parametrize(
    ("key", "label", "help"),
    [
        ("confirm#2", "no step has this id, and no question this text", "did you mean `confirm#1`?"),
        ("Is the bench clear", "no step has this id, and no question this text",
         "did you mean `is the bench clear?`?"),
        ("pick#1", "a step that asks nothing", "the plan asks `confirm#1` (is the bench clear?)"),
        ("the incubator is warm", "no step has this id, and no question this text",
         "the plan asks `confirm#1` (is the bench clear?)"),
    ],
)  # fmt: skip
def test_an_answer_to_what_is_not_asked_is_told_with_what_is(key: str, label: str, help: str) -> None:
    text = f'{{"confirm#1": true, "{key}": true}}'
    answers, _ = read(text)
    found = check_answers(answers, handoffs().graph)
    assert [(item.code, item.label, item.help) for item in found] == [("XEI0917", label, (help,))]
    assert spoken_of(text, found) == [f'"{key}"']


def test_a_plan_that_asks_nothing_says_so() -> None:
    graph = handoffs().graph
    silent = replace(graph, goals=tuple(goal for goal in graph.goals if goal.kind != "confirm"))
    (said,) = check_answers(Answers({"confirm#1": True}), silent)
    assert said.help == ("the plan asks nothing: leave the answer out",)
