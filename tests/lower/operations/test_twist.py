"""Opening and closing a bottle in the air: what the cap goes through, over any sizes that the hands fit."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, plan
from tests.lower.twisted import (
    ARMS,
    BOTTLE,
    CAP,
    goal_of,
    lowered,
    reference,
    sized,
    turns,
    with_stroke,
)
from xei_lang.ir.goals import Attach, Detach, Grip, SlideMove
from xei_lang.lower import lower
from xei_lang.lower.hand import hand_of


@settings(max_examples=25, deadline=None)
@given(
    st.integers(20, 60),
    st.integers(40, 80),
    st.integers(74, 140),
    st.integers(500, 8000),
    st.integers(1, 12),
)
def test_the_cap_turns_about_its_axis_and_ends_where_its_thread_does(
    cap_mm: int, body_mm: int, high_mm: int, lead_um: int, quarters: int
) -> None:
    profile = sized(cap_mm, body_mm, high_mm, lead_um, quarters)
    graph = lowered(profile)
    rise = lead_um / 1e6 * quarters / 4
    up, down = turns(graph, "twist_open#1"), turns(graph, "twist_close#1")
    assert len(up) == len(down) == math.ceil(quarters * 90 / 120)
    assert sum(turn.angle_rad for _, turn in up) == pytest.approx(quarters * math.pi / 2, abs=1e-4)
    assert sum(turn.angle_rad for _, turn in down) == pytest.approx(-quarters * math.pi / 2, abs=1e-4)
    seat = reference(goal_of(graph, "twist_open#1/11"))
    for goal, turn in (*up, *down):
        assert turn.direction == pytest.approx((0.0, 0.0, 1.0))
        assert turn.point_m[:2] == pytest.approx(seat.position_m[:2])
        assert reference(goal).position_m[:2] == pytest.approx(seat.position_m[:2])
        assert turn.lead_m == pytest.approx(lead_um / 1e6)
    assert reference(up[-1][0]).position_m[2] == pytest.approx(seat.position_m[2] + rise, abs=1e-6)
    assert reference(down[-1][0]).position_m == pytest.approx(seat.position_m, abs=1e-6)
    gap_m = hand_of(profile).max_gap_m
    for goal in graph.goals:
        if isinstance(goal.action, Grip):
            assert 0.0 < goal.action.opening_m <= gap_m
        if isinstance(goal.action, SlideMove):
            assert 0.0 <= goal.action.height_m <= 0.6


@settings(max_examples=10, deadline=None)
@given(st.integers(40, 80), st.integers(74, 140))
def test_the_holding_hand_stays_under_the_other_one_and_over_the_table(body_mm: int, high_mm: int) -> None:
    graph = lowered(sized(38, body_mm, high_mm, 4000, 4))
    family = next(item for item in graph.families if item.reference == BOTTLE)
    mouth = high_mm / 1000 + 0.002
    for member in family.members:
        _, _, z = member.T_reference_tool.position_m
        approach = member.T_reference_tool.rotate((0.0, 0.0, 1.0))
        assert 0.015 < z < mouth
        assert z < high_mm / 1000
        assert approach[2] > math.sin(math.radians(-16.0))


def test_the_cap_is_in_a_hand_or_rides_and_lies_on_its_rest_in_between() -> None:
    graph = lowered()
    told = [
        (goal.step_id, type(goal.action).__name__, goal.action.arm, getattr(goal.action, "fastened_to", None))
        for goal in graph.goals
        if isinstance(goal.action, (Attach, Detach)) and goal.action.object == CAP
    ]
    taken, left = ("Attach", "right", None), ("Detach", "right", BOTTLE)
    strokes = [taken, left] * 2
    assert [row[1:] for row in told if row[0] == "twist_open#1"] == [
        *strokes, taken, ("Detach", "right", "")
    ]  # fmt: skip
    assert [row[1:] for row in told if row[0] == "twist_close#1"] == [taken, left, *strokes]
    laid = next(
        goal.action
        for goal in graph.goals
        if isinstance(goal.action, Detach) and goal.action.object == CAP and not goal.action.fastened_to
    )
    assert laid.place == 'cap_rest_2.spot("cap")'


def test_the_vessel_stands_again_where_it_stood() -> None:
    graph = lowered()
    _, world = bench()
    stood = world.robot.T_world_base.inverse() @ world.T_world_object(BOTTLE)
    back = [
        goal.action
        for goal in graph.goals
        if isinstance(goal.action, Detach) and goal.action.object == BOTTLE
    ]
    assert [item.place for item in back] == ['table.spot("reagent")'] * 2
    for item in back:
        assert item.T_base_object.position_m == pytest.approx(stood.position_m)


def test_each_stroke_says_where_its_parameters_come_from() -> None:
    told = {item.name: item for item in turns(lowered(), "twist_open#1")[0][0].parameters}
    assert {name: told[name].source for name in ("stroke_angle", "lead", "twist_speed")} == {
        "stroke_angle": "computed",
        "lead": "usage_profile",
        "twist_speed": "skill",
    }
    assert told["stroke_angle"].rule == "`thread: turns` of 1 in 3 strokes of at most 120 deg"


@pytest.mark.parametrize(("stroke", "count"), [(270, 2), (180, 2), (120, 3), (90, 4)])
def test_strokes_are_as_many_as_the_thread_needs(stroke: int, count: int) -> None:
    profile, world = with_stroke(stroke), bench()[1]
    graph, problems = lower(plan(("twist_open", ARMS)), profile, world)
    assert graph is not None, problems
    assert len(turns(graph, "twist_open#1")) == count
