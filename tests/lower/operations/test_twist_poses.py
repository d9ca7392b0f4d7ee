"""Opening and closing wherever the bottle stands, whichever way it faces and whichever hand holds it."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import obj, plan
from tests.lower.twisted import (
    BOTTLE,
    CAP,
    grounded,
    known,
    lowered,
    reference,
    sized,
    turns,
)
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Detach, MotionGoalGraph, MoveTo, SlideMove
from xei_lang.ir.skill_plan import Side, SkillPlan, Value

places = st.builds(
    lambda x, y, yaw: Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)),
    st.floats(0.50, 0.75), st.floats(-0.65, 0.65), st.floats(-math.pi, math.pi),
)  # fmt: skip


sizes = st.tuples(
    st.integers(20, 60),
    st.integers(40, 80),
    st.integers(74, 140),
    st.integers(500, 8000),
    st.integers(1, 12),
)


def both(hold: Side) -> SkillPlan:
    """Opening and closing, with this hand on the bottle."""
    args: dict[str, Value] = {"object": obj(BOTTLE), "hold": hold, "twist": other(hold)}
    return plan(("twist_open", args), ("twist_close", args))


def other(side: Side) -> Side:
    return "left" if side == "right" else "right"


@settings(max_examples=30, deadline=None)
@given(places, sizes, st.sampled_from(["left", "right"]))
def test_wherever_the_bottle_stands_its_cap_follows_its_thread_in_the_air(
    stands: Pose, drawn: tuple[int, int, int, int, int], hold: Side
) -> None:
    profile = sized(*drawn)
    graph = lowered(profile, stands, both(hold))
    assert {
        goal.action.arm for goal, _ in turns(graph, "twist_open#1") if isinstance(goal.action, MoveTo)
    } == {other(hold)}
    mouth = known(profile, BOTTLE).spots[0].T_object_spot
    for step, begins_m, sign in (("twist_open#1", 0.0, 1.0), ("twist_close#1", rise_m(drawn), -1.0)):
        height = begins_m
        T_base_seat = in_air(graph, step, hold) @ mouth
        for goal, turn in turns(graph, step):
            height += sign * abs(turn.travel_m)
            assert math.dist(turn.direction, T_base_seat.axes()[2]) < 1e-9
            assert math.dist(turn.point_m, T_base_seat.position_m) < 1e-9
            assert turn.travel_m * sign > 0.0
            wanted = T_base_seat @ Pose((0.0, 0.0, height))
            assert math.dist(reference(goal).position_m, wanted.position_m) < 1e-6
        assert height == pytest.approx(rise_m(drawn) if sign > 0.0 else 0.0, abs=1e-6)


@settings(max_examples=30, deadline=None)
@given(places, st.sampled_from(["left", "right"]))
def test_however_the_bottle_stands_its_hand_heads_inwards_in_the_air(stands: Pose, hold: Side) -> None:
    graph = lowered(None, stands, both(hold))
    inwards = -1.0 if hold == "left" else 1.0
    for step in ("twist_open#1", "twist_close#1"):
        T_base_air = in_air(graph, step, hold)
        assert math.dist(T_base_air.axes()[2], (0.0, 0.0, 1.0)) < 1e-9
        assert T_base_air.position_m[1] * inwards >= 0.0, "nearer to the turning arm"
        family = next(item for item in graph.families if item.id == f"{step}.{BOTTLE}")
        straight = next(
            item for item in family.members if item.name.startswith("low on the body, 0 deg down, 0 ")
        )
        heading = (T_base_air @ straight.T_reference_tool).axes()[2]
        assert math.degrees(math.atan2(heading[1], heading[0])) == pytest.approx(inwards * 70.0, abs=1e-6)


@settings(max_examples=20, deadline=None)
@given(places, sizes, st.sampled_from(["left", "right"]))
def test_wherever_the_bottle_stood_there_it_stands_again_with_its_cap(
    stands: Pose, drawn: tuple[int, int, int, int, int], hold: Side
) -> None:
    profile = sized(*drawn)
    world, graph = grounded(profile, stands), lowered(profile, stands, both(hold))
    T_base_world = world.robot.T_world_base.inverse()
    T_bottle_cap = stands.inverse() @ world.T_world_object(CAP)
    left = [goal.action for goal in graph.goals if isinstance(goal.action, Detach)]
    back = [item for item in left if item.object == BOTTLE]
    assert len(back) == 2
    for item in back:
        assert_same(item.T_base_object, T_base_world @ stands)
    on = [item for item in left if item.fastened_to][-1]
    assert_same(in_air(graph, "twist_close#1", hold) @ T_bottle_cap, on.T_base_object)


def assert_same(first: Pose, second: Pose) -> None:
    """To a micrometre, and a turn of a microradian or so: strokes are stated in thousandths of a degree."""
    assert math.dist(first.position_m, second.position_m) < 1e-6
    apart = first.inverse() @ second
    assert math.dist(apart.quaternion[:3], (0.0, 0.0, 0.0)) < 1e-6


def rise_m(drawn: tuple[int, int, int, int, int]) -> float:
    return drawn[3] / 1e6 * drawn[4] / 4


def in_air(graph: MotionGoalGraph, step: str, hold: Side) -> Pose:
    """Where the bottle is held in the air: the goal of the holding hand that follows the slide's."""
    index = next(
        k for k, goal in enumerate(graph.goals) if goal.step_id == step and isinstance(goal.action, SlideMove)
    )
    goal = graph.goals[index + 1]
    assert isinstance(goal.action, MoveTo)
    assert goal.action.arm == hold
    return reference(goal)
