"""The verifier holds a handover to its law: the object is in a hand at any time, and in both only at rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

import pytest

from tests.e2e.made import PROTOCOLS, compiled
from xei_lang.ir.goals import Attach, Detach, MotionGoalGraph
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.verify import RobotDescription, VerificationReport, verify_timed
from xei_lang.pipeline import Handoffs
from xei_lang.profiles.open import robot_texts


@lru_cache
def made() -> Handoffs:
    _, outcome = compiled(next(path for path in PROTOCOLS if path.stem == "pass_bottle"))
    assert outcome.stopped_at is None, outcome.diagnostics
    return outcome.made


Change = Callable[[TimedPlan, MotionGoalGraph], tuple[TimedPlan, MotionGoalGraph]]


def report(change: Change) -> VerificationReport:
    told = made()
    assert told.profile and told.timed and told.graph and told.world
    plan, graph = change(told.timed, told.graph)
    robot = RobotDescription(*robot_texts(told.profile))
    return verify_timed(plan, graph, told.world, robot, told.profile.calibration.limits)


def with_place(graph: MotionGoalGraph, place: str) -> MotionGoalGraph:
    goals = tuple(
        replace(goal, action=replace(goal.action, place=place))
        if goal.step_id == "pass_on" and isinstance(goal.action, Detach)
        else goal
        for goal in graph.goals
    )
    return replace(graph, goals=goals)


def test_the_plan_itself_has_no_fault() -> None:
    assert report(lambda plan, graph: (plan, graph)).findings == ()


def test_the_object_is_in_two_hands_and_then_in_the_taker_s() -> None:
    plan = made().timed
    assert plan is not None
    held = [[item.link for item in goal.attached] for goal in plan.goals if goal.step_id == "pass_on"]
    right, left = "openarm_right_grasp", "openarm_left_grasp"
    assert held == [[right]] * 6 + [[left, right]] * 2 + [[left]]


@pytest.mark.parametrize("place", ["right hand", 'table.spot("beaker")'])
def test_an_object_that_is_let_go_in_the_air_is_found(place: str) -> None:
    found = report(lambda plan, graph: (plan, with_place(graph, place)))
    assert "attachment" in {item.kind for item in found.findings}


def test_a_giver_that_lets_go_before_the_taker_holds_is_found() -> None:
    def early(plan: TimedPlan, graph: MotionGoalGraph) -> tuple[TimedPlan, MotionGoalGraph]:
        rows = list(graph.goals)
        take = next(i for i, g in enumerate(rows) if g.step_id == "pass_on" and isinstance(g.action, Attach))
        leave = next(i for i, g in enumerate(rows) if g.step_id == "pass_on" and isinstance(g.action, Detach))
        rows[take], rows[leave] = (
            replace(rows[leave], id=rows[take].id, kind="detach"),
            replace(rows[take], id=rows[leave].id, kind="attach"),
        )
        kinds = {rows[take].id: "detach", rows[leave].id: "attach"}
        timed = tuple(replace(goal, kind=kinds.get(goal.id, goal.kind)) for goal in plan.goals)  # type: ignore[arg-type]
        return replace(plan, goals=timed), replace(graph, goals=tuple(rows))

    assert "attachment" in {item.kind for item in report(early).findings}


def test_a_giver_that_backs_off_before_it_lets_go_is_found() -> None:
    def late(plan: TimedPlan, graph: MotionGoalGraph) -> tuple[TimedPlan, MotionGoalGraph]:
        end = next(goal.end_s for goal in plan.goals if goal.id == "pass_on/9")
        timed = tuple(
            replace(goal, start_s=end, end_s=end) if goal.id == "pass_on/8" else goal for goal in plan.goals
        )
        ordered = tuple(sorted(timed, key=lambda goal: (goal.start_s, goal.end_s)))
        return replace(plan, goals=ordered), graph

    found = report(late).findings
    assert any("in both hands" in item.message for item in found)
