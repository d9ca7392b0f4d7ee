"""From one hand to the other: where, in which order, and what is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.plans import bench, obj, plan
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import Attach, Detach, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower


def passed_on(name: str = "pipette_1", arm: str = "right", to: str = "left") -> MotionGoalGraph:
    graph, problems = lower(
        plan(
            ("pick", {"object": obj(name), "arm": arm}),
            ("handover", {"object": obj(name), "to": to, "arm": "either"}),
        ),
        *bench(),
    )
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def goals(graph: MotionGoalGraph) -> list[MotionGoal]:
    return [goal for goal in graph.goals if goal.step_id == "handover#1"]


@pytest.mark.parametrize(("arm", "to"), [("right", "left"), ("left", "right")])
def test_the_taker_holds_before_the_giver_lets_go(arm: str, to: str) -> None:
    steps = goals(passed_on(arm=arm, to=to))
    kinds = [goal.kind for goal in steps]
    assert kinds.index("attach") < kinds.index("detach")
    take, leave = steps[kinds.index("attach")].action, steps[kinds.index("detach")].action
    assert isinstance(take, Attach)
    assert isinstance(leave, Detach)
    assert (take.arm, leave.arm, leave.place) == (to, arm, f"{to} hand")
    between = steps[kinds.index("attach") + 1 : kinds.index("detach")]
    assert [goal.kind for goal in between] == ["open_gripper"]


@pytest.mark.parametrize("name", ["pipette_1", "bottle_1", "beaker_1"])
def test_both_hands_mean_the_same_pose_upright_between_the_arms(name: str) -> None:
    steps = goals(passed_on(name))
    poses = [
        goal.action.target.T_base_reference
        for goal in steps
        if isinstance(goal.action, MoveTo) and isinstance(goal.action.target, ToolTarget)
    ]
    leave = next(goal.action for goal in steps if isinstance(goal.action, Detach))
    for pose in [*poses[1:], leave.T_base_object]:
        assert pose.position_m == pytest.approx(poses[0].position_m, abs=1e-12)
        assert pose.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert poses[0].position_m[1] == pytest.approx(0.0, abs=1e-9)


def test_the_slide_moves_only_before_the_hands_meet() -> None:
    moves = [goal for goal in goals(passed_on()) if isinstance(goal.action, MoveTo)]
    assert ["slide" in goal.resources for goal in moves] == [True, False, False, False]


def test_a_hand_that_nobody_named_is_the_other_one() -> None:
    take = next(g.action for g in goals(passed_on(to="either")) if isinstance(g.action, Attach))
    assert take.arm == "left"


@pytest.mark.parametrize(("picked", "to", "code"), [(True, "right", "XEI0708"), (False, "left", "XEI0707")])
def test_what_cannot_be_handed_over_is_refused(picked: bool, to: str, code: str) -> None:
    take = [("pick", {"object": obj("pipette_1"), "arm": "right"})] if picked else []
    step = ("handover", {"object": obj("pipette_1"), "to": to, "arm": "right"})
    graph, problems = lower(plan(*take, step), *bench())
    assert graph is None
    assert [item.code for item in problems] == [code]


def test_the_graph_must_keep_the_object_in_a_hand() -> None:
    graph = passed_on()

    def changed(**actions: object) -> tuple[str, ...]:
        rows = tuple(
            replace(goal, action=replace(goal.action, **actions))
            if goal.step_id == "handover#1" and isinstance(goal.action, Detach)
            else goal
            for goal in graph.goals
        )
        return verify_goals(replace(graph, goals=rows))

    assert any("already in a hand" in text for text in changed(place='table.spot("beaker")'))
    assert any("not left where a hand holds it" in text for text in changed(place="right hand"))
    kept = tuple(goal for goal in graph.goals if goal.id != "handover#1/6")
    assert any("not left where a hand" in text for text in verify_goals(replace(graph, goals=kept)))


def test_no_arm_moves_while_two_hands_hold() -> None:
    graph = passed_on()
    rows = list(graph.goals)
    leave = next(i for i, g in enumerate(rows) if g.step_id == "handover#1" and g.kind == "detach")
    rows[leave], rows[leave + 1] = rows[leave + 1], rows[leave]
    problems = verify_goals(replace(graph, goals=tuple(rows), edges=()))
    assert any("moves while two hands hold one object" in text for text in problems)
