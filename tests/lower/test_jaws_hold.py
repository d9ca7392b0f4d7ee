"""Jaws that would not pass an object, or would not touch it, are refused at the number that says so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.plans import bench, obj, plan, put_on_rack, with_object
from tests.lower.test_refusals import known, refused
from xei_lang.diagnostics import Span
from xei_lang.ir.goals import Grip
from xei_lang.lower import lower
from xei_lang.profiles.model import OperationDefault, Profile
from xei_lang.quantity import parse_quantity

WRITTEN = Span("usage.yaml", 5, 9)


def grasped(name: str, **parameters: str) -> Profile:
    """The bench with these parameters of the object's grasp."""
    said = tuple(OperationDefault(key, parse_quantity(value), WRITTEN) for key, value in parameters.items())
    return with_object(bench()[0], name, replace(known(name), grasp=said))


@pytest.mark.parametrize("width", ["17.1 mm", "33 mm", "40 mm"])
def test_jaws_that_close_wider_than_the_object_do_not_hold_it(width: str) -> None:
    found = refused(put_on_rack(), grasped("tube_1", grasp_width=width))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message.startswith(f"`grasp_width` of {width} does not hold `tube_1`")
    assert "at most 17 mm" in found.label
    assert [label.span for label in found.labels] == [known("tube_1").span]
    assert found.help == ("write `grasp_width: 17 mm`, or less to squeeze it",)


@pytest.mark.parametrize("width", ["17 mm", "15 mm"])
def test_jaws_that_touch_or_squeeze_the_object_hold_it(width: str) -> None:
    graph, problems = lower(put_on_rack(), grasped("tube_1", grasp_width=width), bench()[1])
    assert graph is not None, problems
    closed = next(goal.action for goal in graph.goals if goal.kind == "close_gripper")
    assert isinstance(closed, Grip)
    assert closed.opening_m == pytest.approx(parse_quantity(width).si)


@pytest.mark.parametrize(
    ("name", "value", "least"),
    [("open_width", "10 mm", "19 mm"), ("open_width", "18 mm", "19 mm"), ("jaw_clearance", "0.5 mm", "1 mm")],
)
def test_jaws_that_do_not_open_round_the_object(name: str, value: str, least: str) -> None:
    found = refused(put_on_rack(), grasped("tube_1", **{name: value}))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message == f"`{name}` of {value} does not let the jaws pass `tube_1`"
    assert found.label.startswith(f"expected at least {least}: `tube_1` is 17 mm wide")


OPENING = plan(("twist_open", {"object": obj("bottle_2"), "hold": "left", "twist": "right"}))


@pytest.mark.parametrize(
    ("about", "name", "value", "most"),
    [
        ("bottle_2", "hold_width", "57 mm", "56 mm"),
        ("bottle_2_cap", "cap_width", "39 mm", "38 mm"),
    ],
)
def test_hands_that_open_a_vessel_hold_it_and_its_cap(about: str, name: str, value: str, most: str) -> None:
    found = refused(OPENING, grasped(about, **{name: value}))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message.startswith(f"`{name}` of {value} does not hold `{about}`")
    assert f"at most {most}" in found.label


@pytest.mark.parametrize(
    ("about", "name", "value"),
    [("bottle_2", "hold_open_width", "56 mm"), ("bottle_2_cap", "cap_open_width", "30 mm")],
)
def test_hands_that_open_a_vessel_pass_it_and_its_cap(about: str, name: str, value: str) -> None:
    found = refused(OPENING, grasped(about, **{name: value}))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert f"does not let the jaws pass `{about}`" in found.message


def test_jaws_let_go_of_what_they_squeezed_by_its_own_width() -> None:
    profile = grasped("tube_1", grasp_width="3 mm")
    graph, problems = lower(put_on_rack(), profile, bench()[1])
    assert graph is not None, problems
    opened = [goal.action for goal in graph.goals if goal.kind == "open_gripper"][-1]
    assert isinstance(opened, Grip)
    assert opened.opening_m == pytest.approx(0.017 + 2 * 0.008)
    found = refused(put_on_rack(), grasped("tube_1", grasp_width="3 mm", release_width="16 mm"))
    assert (found.code, found.message) == ("XEI0702", "`release_width` of 16 mm does not release `tube_1`")
    assert found.label.startswith("expected more than 17 mm")
