"""The giver's grasp and the taker's are chosen together where the giver's own best leaves the taker none."""

from __future__ import annotations

from typing import Any

import pytest

from tests.motion.sequence.bench import DESCRIPTION, bench, goals, obj, plan, planned, spot
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.sequence import course, meeting
from xei_lang.motion.verify import RobotDescription, verify_timed


def passed_on(name: str) -> SkillPlan:
    return plan(
        ("pick", {"object": obj(name), "arm": "right"}),
        ("handover", {"object": obj(name), "arm": "right", "to": "left"}),
        ("handover", {"object": obj(name), "arm": "left", "to": "right"}),
    )


def choices(plan: TimedPlan, graph: MotionGoalGraph, arm: str) -> set[str]:
    """The grasps by which a hand took hold."""
    kinds = {goal.id: goal.kind for goal in graph.goals}
    return {goal.choice for goal in plan.goals if kinds[goal.id] == "attach" and goal.arm == arm}


def not_gone_back(*_args: Any) -> None:
    return None


def test_a_grasp_that_blocks_every_grasp_of_the_taker_gives_way_to_one_that_does_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    profile, world = bench()
    steps = passed_on("pipette_1")
    graph = goals(steps, profile, world)
    together, problems = plan_motion(graph, world, profile, DESCRIPTION, 1)
    assert together is not None, problems
    robot = RobotDescription(DESCRIPTION.urdf_text, DESCRIPTION.srdf_text)
    report = verify_timed(together, graph, world, robot, profile.calibration.limits)
    assert report.findings == ()

    monkeypatch.setattr(course, "taken_from", not_gone_back)
    apart, problems = planned(steps, profile, world)
    assert apart is None
    assert problems[0].code == "XEI0802"
    assert problems[0].span == steps.steps[1].span
    assert "to `pipette_1`: every grasp in reach touches `openarm_right_hand`" in problems[0].message


def test_where_the_giver_s_own_best_serves_nothing_is_chosen_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    profile, world = bench()
    steps = passed_on("bottle_1")
    graph = goals(steps, profile, world)
    plan, problems = plan_motion(graph, world, profile, DESCRIPTION, 1)
    assert plan is not None, problems
    assert len(choices(plan, graph, "right")) == 2
    monkeypatch.setattr(course, "taken_from", not_gone_back)
    assert planned(steps, profile, world)[0] == plan


def test_what_no_two_grasps_can_do_is_refused_as_it_was_found_first(monkeypatch: pytest.MonkeyPatch) -> None:
    profile, world = bench()
    steps = plan(
        ("pick", {"object": obj("wipe_1"), "arm": "left"}),
        ("handover", {"object": obj("wipe_1"), "arm": "left", "to": "right"}),
    )
    timed, problems = planned(steps, profile, world)
    assert timed is None
    monkeypatch.setattr(course, "taken_from", not_gone_back)
    assert planned(steps, profile, world)[1] == problems


def test_a_place_that_the_taker_does_not_reach_is_told_at_its_own_step() -> None:
    profile, world = bench()
    steps = plan(
        ("pick", {"object": obj("bottle_1"), "arm": "right"}),
        ("handover", {"object": obj("bottle_1"), "arm": "right", "to": "left"}),
        ("place", {"object": obj("bottle_1"), "on": spot("table", "bottle"), "arm": "left"}),
    )
    timed, problems = planned(steps, profile, world)
    assert timed is None
    assert problems[0].code == "XEI0801"
    assert problems[0].span == steps.steps[2].span


def test_only_so_many_candidates_are_gone_through(monkeypatch: pytest.MonkeyPatch) -> None:
    looked: list[int] = []

    def never(*_args: Any) -> object:
        looked.append(1)
        return object()

    profile, world = bench()
    monkeypatch.setattr(meeting, "first_touch", never)
    timed, problems = planned(passed_on("pipette_1"), profile, world)
    assert timed is None
    assert problems[0].code == "XEI0802"
    efforts = 2
    assert 0 < len(looked) <= efforts * meeting.MAX_LOOKS
