"""Values of the command line are expressions of the language, and messages point into them."""

from __future__ import annotations

import pytest

from tests.check.checking import check, ids, plan_of, protocol
from xei_lang.diagnostics.options import option_source, option_value
from xei_lang.ir.skill_plan import ObjectRef


@pytest.mark.parametrize(
    ("type", "given", "waits"),
    [
        ("List[Time]", "[1 s, 2 s]", ["1 s", "2 s"]),
        ("List[Time]", "[t * 1 s for t in 1 .. 3]", ["1 s", "2 s", "3 s"]),
        ("List[Time]", "0 s .. 10 s step 5 s", ["0 s", "5 s", "10 s"]),
        ("List[Time]", "[]", []),
        ("List[List[Time]]", "[[1 s], [2 s]]", None),
    ],
)
def test_lists(type: str, given: str, waits: list[str] | None) -> None:
    loop = "for t in ts { wait t }" if waits is not None else "for t in ts { wait sum(t) }"
    plan = plan_of(protocol(f"param ts: {type}\n{loop}"), params={"ts": given})
    found = [str(step.arg("duration")) for step in plan.steps]
    assert found == (["1 s", "2 s"] if waits is None else waits)


def test_a_text_needs_no_quotes_and_may_have_them() -> None:
    text = protocol('param who: String\nlet x = who == "me"')
    for given in ("me", '"me"'):
        found = check(text, params={"who": given})[1]
        assert [item.code for item in found] == ["XEI0501"]


def test_objects_are_bound_by_name_and_lists_of_them_in_brackets() -> None:
    body = "object tubes: List[movable]\nfor t in tubes { pick(object=t, arm=left) }"
    plan = plan_of(protocol(body), bindings={"tubes": "[tube_2, tube_1]"})
    assert [step.arg("object") for step in plan.steps] == [ObjectRef("tube_2"), ObjectRef("tube_1")]
    assert ids(body, open_bindings=True) == ["pick#1[1]"]
    assert [item.code for item in check(protocol(body))[1]] == ["XEI0206"]


def test_a_list_of_places_stands_for_what_is_in_them() -> None:
    body = (
        'object tubes: List[movable] = rack_1.row("A")[1 .. 2]\nfor t in tubes { pick(object=t, arm=left) }'
    )
    plan = plan_of(protocol(body))
    assert [step.arg("object") for step in plan.steps] == [ObjectRef("tube_1"), ObjectRef("tube_2")]


def test_a_message_points_into_the_option_and_mends_nothing_there() -> None:
    _, found = check(protocol("param on: Bool\nif on { wait 1 s }"), params={"on": "True"})
    (wrong,) = found
    assert wrong.span == option_value("param", "on", "True")
    assert wrong.fix is None
    source = option_source(wrong.span.file)
    assert source is not None
    assert source.slice(wrong.span) == "True"
    assert option_source("protocols/a.xei") is None


def test_a_range_of_the_command_line_is_counted_before_it_is_made() -> None:
    _, found = check(
        protocol("param ts: List[Int]\nfor t in ts { wait 1 s }"), params={"ts": "1 .. 999999999999"}
    )
    assert [item.code for item in found] == ["XEI0316"]
