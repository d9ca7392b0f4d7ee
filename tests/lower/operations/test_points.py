"""Pour, tap, swipe and wipe on the bench: where their points, axes and areas are, and what they refuse."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, plan, spot
from tests.motion.sequence.bench import moved
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Fact
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.quantity import quantity


def lowered(*calls, world=None) -> MotionGoalGraph:
    profile, own = bench()
    graph, problems = lower(plan(*calls), profile, world or own)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def refused(*calls) -> str:
    profile, world = bench()
    graph, problems = lower(plan(*calls), profile, world)
    assert graph is None
    return problems[0].code


def moves(graph: MotionGoalGraph, step: str) -> list[MoveTo]:
    return [g.action for g in graph.goals if g.step_id == step and isinstance(g.action, MoveTo)]


def pouring(volume_ml: int, arm: str = "right"):
    args = {"source": obj("beaker_3"), "target": obj("beaker_1"), "volume": quantity(volume_ml, "mL")}
    return ("pick", {"object": obj("beaker_3"), "arm": arm}), ("pour", {**args, "arm": arm})


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.integers(1, 200), st.sampled_from([-1, 1]))
def test_the_lip_is_over_the_opening_and_the_vessel_clears_the_rim(
    dx: float, dy: float, volume_ml: int, side: int
) -> None:
    world = moved(bench()[1], "beaker_1", dx, dy)
    above, tilt, back = moves(
        lowered(*pouring(volume_ml, "left" if side > 0 else "right"), world=world), "pour#1"
    )
    item = world.find("beaker_1")
    assert item is not None
    T_base_target = world.robot.T_world_base.inverse() @ world.T_world_object("beaker_1")
    assert isinstance(tilt.along, Turn)
    assert isinstance(back.along, Turn)
    assert isinstance(above.target, ToolTarget)
    x, y, _ = T_base_target.inverse().apply(tilt.along.point_m)
    assert math.hypot(x, y) < 0.066 / 2
    upright = above.target.T_base_reference
    assert upright.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert upright.position_m[2] >= T_base_target.position_m[2] + item.size_m[2] + 0.0149
    lip = upright.inverse().apply(tilt.along.point_m)
    assert math.hypot(lip[0], lip[1]) == pytest.approx(0.035)
    assert lip[2] == pytest.approx(0.095)
    assert back.along.angle_rad == -tilt.along.angle_rad
    assert isinstance(tilt.target, ToolTarget)
    assert tilt.target.T_base_reference.axes()[2][2] == pytest.approx(math.cos(tilt.along.angle_rad))


def test_more_is_tilted_for_more_and_a_known_fill_is_used() -> None:
    def angle(volume_ml: int, fill_ml: int | None) -> float:
        steps = plan(*pouring(volume_ml))
        known = (Fact("volume", "beaker_3", quantity(fill_ml, "mL")),) if fill_ml is not None else ()
        told = tuple(replace(step, state_before=known) for step in steps.steps)
        graph, problems = lower(replace(steps, steps=told), *bench())
        assert graph is not None, problems
        tilt = moves(graph, "pour#1")[1].along
        assert isinstance(tilt, Turn)
        return tilt.angle_rad

    assert angle(20, None) < angle(60, None) < angle(200, None)
    assert angle(20, None) == pytest.approx(angle(20, 250))
    assert angle(20, 60) > angle(20, 250)


def test_a_tap_ends_with_the_fingertip_on_the_element() -> None:
    _, world = bench()
    above, tap, away = moves(
        lowered(("tap", {"screen": obj("incubator_screen"), "element": "start", "arm": "left"})), "tap#1"
    )
    assert isinstance(tap.target, ToolTarget)
    graph = lowered(("tap", {"screen": obj("incubator_screen"), "element": "start", "arm": "left"}))
    T_base_screen = world.robot.T_world_base.inverse() @ world.T_world_object("incubator_screen")
    for member in graph.families[-1].members:
        tip = (tap.target.T_base_reference @ member.T_reference_tool).apply((0.0, 0.0, 0.0155))
        assert T_base_screen.inverse().apply(tip) == pytest.approx((-0.003, 0.02, 0.06), abs=1e-9)
    touching = next(g for g in graph.goals if g.action == tap)
    assert all("finger" in pair[1] for pair in touching.allowed_contacts)
    assert above.target == away.target


def test_a_wipe_stays_inside_its_area_with_its_whole_outline() -> None:
    _, world = bench()
    size = {"length": quantity(100, "mm"), "width": quantity(180, "mm")}
    graph = lowered(
        ("pick", {"object": obj("wipe_1"), "arm": "left"}),
        ("wipe", {"object": obj("wipe_1"), "on": spot("table", "front"), **size, "arm": "left"}),
    )
    raster = moves(graph, "wipe#1")[2].along
    assert isinstance(raster, Raster)
    edges = sorted((math.hypot(*raster.along_m), math.hypot(*raster.across_m)))
    assert edges == pytest.approx([0.03, 0.12])
    assert raster.lane_distance_m <= 0.048
    x, y, z = (world.robot.T_world_base @ Pose(raster.corner_m)).position_m
    assert (x, y, z) == pytest.approx((0.5 + 0.09 - 0.015, 0.42 - 0.06, 0.75))


@pytest.mark.parametrize(
    ("code", "calls"),
    [
        ("XEI0707", pouring(50)[1:]),
        ("XEI0720", (("tap", {"screen": obj("incubator_screen"), "element": "strat", "arm": "left"}),)),
        (
            "XEI0720",
            (
                (
                    "swipe",
                    {
                        "screen": obj("incubator_screen"),
                        "element": "start",
                        "direction": "left",
                        "distance": quantity(60, "mm"),
                        "arm": "left",
                    },
                ),
            ),
        ),
        (
            "XEI0721",
            (
                ("pick", {"object": obj("wipe_1"), "arm": "left"}),
                (
                    "wipe",
                    {
                        "object": obj("wipe_1"),
                        "on": spot("table", "beaker"),
                        "length": quantity(100, "mm"),
                        "width": quantity(180, "mm"),
                        "arm": "left",
                    },
                ),
            ),
        ),
    ],
)
def test_what_cannot_be_done_is_refused(code: str, calls) -> None:
    assert refused(*calls) == code


@pytest.mark.parametrize("center", [(0.15, 0.06), (0.04, 0.16), (-0.04, 0.06), (0.118, 0.06)])
def test_an_element_that_is_not_on_its_screen_is_not_touched(center: tuple[float, float]) -> None:
    profile, world = bench()
    screen = profile.object("incubator_screen")
    assert screen is not None
    start, stop = screen.elements
    changed = replace(screen, elements=(replace(start, center_m=center), stop))
    others = tuple(changed if item is screen else item for item in profile.objects)
    tap = plan(("tap", {"screen": obj("incubator_screen"), "element": "start", "arm": "left"}))
    graph, problems = lower(tap, replace(profile, objects=others), world)
    assert graph is None
    assert [found.code for found in problems] == ["XEI0720"]
