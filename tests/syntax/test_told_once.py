"""One slip of the hand, one diagnostic: what it leaves behind is not told as a second mistake."""

from __future__ import annotations

import pytest

from tests.syntax.corpus import in_protocol
from xei_lang.diagnostics import Source
from xei_lang.syntax import Parser

PARSER = Parser()


def told(text: str) -> list[tuple[int, str]]:
    """The lines that are told of, and what is said of them."""
    source = Source("t.xei", text)
    return [
        (source.line_number(found.span.start), found.message)
        for found in PARSER.module(source)[1]
        if found.span is not None
    ]


@pytest.mark.parametrize(
    "step",
    [
        "pickobject=bottle)",
        "pickobject=bottle, arm=right)",
        "pick,object=bottle)",
        "pick=object=bottle)",
        "movea, to=b)",
        "pickobject=bottle) within 30 s",
        "place=object=bottle, on=table.spot(name), arm=right)",
    ],
)
@pytest.mark.parametrize("behind", ["wait 5 s", "wait wait 5 s"])
def test_a_step_without_its_parenthesis_is_no_assignment(step: str, behind: str) -> None:
    found = told(f"protocol p {{\n  do {{\n    {step}\n  }}\n  {behind}\n}}\n")
    assert [line for line, _ in found] == [3, 5][: 1 + (behind != "wait 5 s")]
    assert "let" not in found[0][1]


def test_an_assignment_of_a_call_is_one() -> None:
    ((_, message),) = told(in_protocol("x = volume(bottle)"))
    assert message == "`x` is given a value without `let`"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("protocol p {\n  parallel {\n     wipe() }\n    { tap() }\n  }\n  home()\n  home()\n}\n", 2),
        ("protocol p {\n  parallel {\n    { wipe() }\n     tap() }\n  }\n  home()\n  home()\n}\n", 3),
        ("protocol p {\n  do {\n    home()\n   within 5 min after a\n  home()\n  home()\n}\n", 4),
    ],
)
def test_a_lost_brace_is_told_once(text: str, line: int) -> None:
    ((found, _),) = told(text)
    assert found == line


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("protocol p {\n  do {\n    home()\n\n  waitt 5 s\n  home()\n  home()\n}\n", [5, 5]),
        ("protocol p {\n  do {\n    home()\n\n   5 s\n  home()\n  home()\n}\n", [5, 5]),
        (
            "protocol p {\n  parallel {\n\n      home[)\n    }\n    {\n      home()\n    }\n  }\n}\n",
            [2, 4],
        ),
        (
            "protocol p {\n  parallel {\n    {\n      home()\n    }\n\n      watt 1 s\n    }\n  }\n}\n",
            [5, 7],
        ),
    ],
)
def test_a_lost_brace_beside_another_slip(text: str, lines: list[int]) -> None:
    assert [line for line, _ in told(text)] == lines


@pytest.mark.parametrize(
    "line",
    [
        "let d = a *",
        "let d =",
        "param n:",
        "param nInt :",
        "param :n Int",
        "object :bottle movable & pourable = bottle_2",
        "measure :od Float = read(device=reader)",
    ],
)
@pytest.mark.parametrize(
    "below", ["wait 1 s", "let a = b", "close: pick(object=a)", "pick(object=a, arm=left)", "param m: Int"]
)
@pytest.mark.parametrize("behind", ["wait 5 s", "wait wait 5 s"])
def test_a_line_that_breaks_off_ends_before_the_next_step(line: str, below: str, behind: str) -> None:
    if line.endswith(("*", "=")) and below.startswith("pick"):
        return  # What stands below is the value.
    found = told(f"protocol p {{\n  {line}\n  {below}\n  {behind}\n  home()\n}}\n")
    assert [line for line, _ in found] == [2, 4][: 1 + (behind != "wait 5 s")]


@pytest.mark.parametrize(
    "argument",
    [
        'tip=tips.slot("A1",',
        'tip=f(g("A1",',
        "source(source,",
        "source=source(",
        "source=source[",
        "source=source=",
        "source=source:",
    ],
)
def test_a_parenthesis_that_stays_open_inside_of_a_call_is_told_where_it_is(argument: str) -> None:
    call = f"  transfer(\n    source=a,\n    {argument}\n    target=b,\n    arm=right,\n  )\n"
    found = told(f"protocol p {{\n  home()\n{call}  put_back: place(object=a)\n  home()\n}}\n")
    assert [line for line, _ in found] == [5]
