"""Invert and shake on the bench: the axis stays, vessels come back upright, open ones are refused."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, plan
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Fact
from xei_lang.ir.tool_paths import Turn
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.quantity import quantity


def turned(skill: str, name: str, arm: str, times: int, **angle: int) -> MotionGoalGraph:
    args = {key: quantity(value, "deg") for key, value in angle.items()}
    graph, problems = lower(
        plan(
            ("pick", {"object": obj(name), "arm": arm}),
            (skill, {"object": obj(name), **args, "times": times, "arm": arm}),
        ),
        *bench(),
    )
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def targets(graph: MotionGoalGraph, step: str) -> list[tuple[Pose, Turn | None]]:
    found: list[tuple[Pose, Turn | None]] = []
    for goal in graph.goals:
        if goal.step_id != step or not isinstance(goal.action, MoveTo):
            continue
        assert isinstance(goal.action.target, ToolTarget)
        along = goal.action.along
        found.append((goal.action.target.T_base_reference, along if isinstance(along, Turn) else None))
    return found


def turns(graph: MotionGoalGraph, step: str) -> list[Turn]:
    return [turn for _, turn in targets(graph, step) if turn is not None]


@settings(max_examples=20, deadline=None)
@given(
    st.sampled_from(["tube_1", "tube_4", "bottle_1"]),
    st.sampled_from(["left", "right"]),
    st.integers(1, 6),
    st.integers(30, 180),
)
def test_an_inversion_returns_to_its_start_about_an_axis_that_stays(
    name: str, arm: str, times: int, angle: int
) -> None:
    graph = turned("invert", name, arm, times, angle=angle)
    (above, _), *rest = targets(graph, "invert#1")
    assert len(rest) == 2 * times
    known = bench()[0].object(name)
    assert known is not None
    middle = above.apply((0.0, 0.0, known.size_m[2] / 2))
    for (pose, turn), sign in zip(rest, [1, -1] * times, strict=True):
        assert turn is not None
        assert turn.point_m == pytest.approx(middle)
        assert turn.direction[2] == 0.0
        assert turn.angle_rad == pytest.approx(sign * math.radians(angle))
        assert pose.apply((0.0, 0.0, known.size_m[2] / 2)) == pytest.approx(middle)
        tilt = math.acos(max(-1.0, min(1.0, pose.axes()[2][2])))
        assert tilt == pytest.approx(math.radians(angle) if sign > 0 else 0.0, abs=1e-6)
    assert rest[-1][0] == above


@settings(max_examples=10, deadline=None)
@given(st.sampled_from(["left", "right"]), st.integers(1, 9), st.integers(2, 45))
def test_shaking_swings_to_both_sides_and_ends_upright(arm: str, times: int, amplitude: int) -> None:
    graph = turned("shake", "tube_1", arm, times, amplitude=amplitude)
    angles = [math.degrees(turn.angle_rad) for turn in turns(graph, "shake#1")]
    assert angles == pytest.approx([amplitude, *([-2 * amplitude, 2 * amplitude] * times), -amplitude])
    poses = [pose for pose, _ in targets(graph, "shake#1")]
    assert poses[-1] == poses[0]
    assert poses[0].axes()[2] == pytest.approx((0.0, 0.0, 1.0))


def test_nothing_of_the_bench_is_near_where_a_vessel_turns() -> None:
    profile, world = bench()
    pose, _ = targets(turned("invert", "tube_1", "right", 1, angle=180), "invert#1")[0]
    T_world_vessel = world.robot.T_world_base @ pose
    lowest = T_world_vessel.position_m[2] + 0.118 / 2 - math.hypot(0.118, 0.017, 0.017) / 2
    for item in world.objects:
        known = profile.object(item.name)
        assert known is not None
        x, y, _ = world.T_world_object(item.name).inverse().apply(T_world_vessel.position_m)
        if abs(x) < known.size_m[0] / 2 + 0.1 and abs(y) < known.size_m[1] / 2 + 0.1:
            top = world.T_world_object(item.name).apply((0.0, 0.0, known.size_m[2]))[2]
            assert lowest >= top + 0.1199


@pytest.mark.parametrize("skill", ["invert", "shake"])
@pytest.mark.parametrize(
    ("name", "cap", "code"),
    [("beaker_1", None, "XEI0723"), ("tube_1", "open", "XEI0723"), ("tube_1", "closed", None)],
)
def test_only_what_is_closed_is_turned(skill: str, name: str, cap: str | None, code: str | None) -> None:
    args = {"angle": quantity(90, "deg"), "amplitude": quantity(9, "deg"), "times": 1, "arm": "right"}
    steps = plan(("pick", {"object": obj(name), "arm": "right"}), (skill, {"object": obj(name), **args}))
    known = (Fact("cap", name, cap),) if cap else ()
    told = tuple(replace(step, state_before=known) for step in steps.steps)
    graph, problems = lower(replace(steps, steps=told), *bench())
    assert [item.code for item in problems] == ([code] if code else [])
    assert (graph is None) == (code is not None)


def test_an_empty_hand_turns_nothing() -> None:
    args = {"object": obj("tube_1"), "angle": quantity(90, "deg"), "times": 1, "arm": "right"}
    _, problems = lower(plan(("invert", args)), *bench())
    assert [item.code for item in problems] == ["XEI0707"]
