"""Opening and closing by two hands: planned with either hand on the bottle, and faults of it that are found.

Each fault is made in one place, the goals or the timed plan, and is to be found by what looks at that: the
verifier of goals or the one of timed plans. What a wrong template would make is in the tests of lowering.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.lower.mirrored import mirrored
from tests.motion.sequence.bench import bench, goals, planned
from tests.motion.twisting import BOTTLE, CAP, OPEN, findings, opened, the_other_way_round, with_thread
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.tool_paths import Turn
from xei_lang.ir.verify_goals import verify_goals


def test_the_right_hand_may_hold_and_the_left_one_turn() -> None:
    timed, graph = the_other_way_round()
    assert findings(timed, graph, mirrored()[1]) == ()
    for goal in graph.goals:
        if isinstance(goal.action, (Attach, Detach)):
            assert goal.action.arm == ("right" if goal.action.object == BOTTLE else "left")
    left = [goal.action for goal in graph.goals if isinstance(goal.action, Detach)]
    assert [item.object for item in left if not item.fastened_to] == [BOTTLE, CAP, BOTTLE]


def test_nothing_is_found_in_the_good_plan() -> None:
    timed, graph = opened()
    assert verify_goals(graph) == ()
    assert findings(timed, graph, bench()[1]) == ()


# Faults of the goals.


def screws(graph: MotionGoalGraph) -> list[MotionGoal]:
    return [goal for goal in graph.goals if isinstance(goal.action, MoveTo) and goal.action.path == "screw"]


def detached(graph: MotionGoalGraph) -> list[MotionGoal]:
    """The goals that leave the cap on its thread."""
    return [goal for goal in graph.goals if isinstance(goal.action, Detach) and goal.action.fastened_to]


def without(graph: MotionGoalGraph, *names: str) -> MotionGoalGraph:
    """The graph without these goals, which the goals before and after them are joined over."""
    edges = list(graph.edges)
    for name in names:
        into, out = [a for a, b in edges if b == name], [b for a, b in edges if a == name]
        edges = [edge for edge in edges if name not in edge]
        edges += [pair for pair in ((a, b) for a in into for b in out) if pair not in edges]
    kept = tuple(goal for goal in graph.goals if goal.id not in names)
    return replace(graph, goals=kept, edges=tuple(edges))


def with_goal(graph: MotionGoalGraph, goal: MotionGoal) -> MotionGoalGraph:
    return replace(graph, goals=tuple(goal if item.id == goal.id else item for item in graph.goals))


def test_goals_whose_screw_has_a_lead_of_the_wrong_sign() -> None:
    _, graph = opened()
    for goal in screws(graph):
        assert isinstance(goal.action, MoveTo)
        assert isinstance(goal.action.along, Turn)
        along = replace(goal.action.along, lead_m=-goal.action.along.lead_m)
        faulty = with_goal(graph, replace(goal, action=replace(goal.action, along=along)))
        said = f"goal `{goal.id}`: its path does not lead from the move before to its target"
        assert said in verify_goals(faulty)


def test_goals_that_leave_the_cap_in_the_hand() -> None:
    _, graph = opened()
    for goal in detached(graph):
        said = verify_goals(without(graph, goal.id))
        assert [text for text in said if f"moves with open jaws, and still holds `{CAP}`" in text]
        assert [text for text in said if f"already holds `{CAP}`" in text]


def test_goals_that_leave_the_cap_in_the_hand_at_the_end() -> None:
    """Nothing takes the cap after it is closed: that the hand goes away from it open is all that tells."""
    _, graph = the_other_way_round()
    last = detached(graph)[-1]
    said = verify_goals(without(graph, last.id))
    assert said
    assert all(text.endswith(f"the left hand moves with open jaws, and still holds `{CAP}`") for text in said)


def test_goals_that_leave_out_a_stroke_before_the_last() -> None:
    _, graph = opened()
    for goal in screws(graph)[:-1]:
        said = verify_goals(without(graph, goal.id))
        assert [text for text in said if "its path does not lead" in text or "begins nowhere" in text]


@pytest.mark.parametrize("height_m", [0.002, 0.01])
def test_goals_that_leave_the_cap_over_its_thread(height_m: float) -> None:
    _, graph = opened()
    for goal in detached(graph):
        assert isinstance(goal.action, Detach)
        over = Pose((0.0, 0.0, height_m)) @ goal.action.T_base_object
        faulty = with_goal(graph, replace(goal, action=replace(goal.action, T_base_object=over)))
        assert verify_goals(faulty) == (
            f"goal `{goal.id}`: `{CAP}` is fastened elsewhere than where its hand is",
        )


# Faults of the timed plan, against the goals as they should be.


def kinds(timed: TimedPlan, graph: MotionGoalGraph | None = None) -> set[tuple[str, str]]:
    return {(found.kind, found.goal_id) for found in findings(timed, graph or opened()[1], bench()[1])}


def changed(timed: TimedPlan, *changes: TimedGoal) -> TimedPlan:
    new = {goal.id: goal for goal in changes}
    return replace(timed, goals=tuple(new.get(goal.id, goal) for goal in timed.goals))


def test_a_plan_that_screws_the_wrong_way() -> None:
    """Made for a left-handed thread, whose goals are sound in themselves: each stroke goes 1.3 mm
    lower than it should.
    """
    profile, world = bench()
    wrong, right = (with_thread(profile, lead_m=lead_m) for lead_m in (-0.002, 0.002))
    assert verify_goals(goals(OPEN, wrong, world)) == ()
    timed, problems = planned(OPEN, wrong, world)
    assert timed is not None, problems
    graph = goals(OPEN, right, world)
    assert {("wrong_goal", goal.id) for goal in screws(graph)} <= kinds(timed, graph)


def test_a_plan_that_leaves_out_a_stroke() -> None:
    """Made for a thread of two strokes: the goals of the third one are not what they should be."""
    profile, world = with_thread(bench()[0], turns=2 / 3), bench()[1]
    timed, problems = planned(OPEN, profile, world)
    assert timed is not None, problems
    assert len(screws(goals(OPEN, profile, world))) == 2
    assert {"goals", "tool_path", "placement"} <= {kind for kind, _ in kinds(timed)}


def test_a_plan_that_leaves_out_one_stroke_s_goal() -> None:
    timed, graph = opened()
    for goal in screws(graph):
        bare = replace(timed, goals=tuple(item for item in timed.goals if item.id != goal.id))
        assert ("goals", goal.id) in kinds(bare)


def test_a_plan_that_keeps_the_cap_in_the_hand() -> None:
    """While the open hand turns back, the cap is said to go along."""
    timed, graph = opened()
    order = [goal.id for goal in graph.goals]
    for left in detached(graph):
        back = next(goal for goal in timed.goals if goal.id == order[order.index(left.id) + 1])
        before = next(goal for goal in timed.goals if goal.id == left.id)
        wrong = replace(back, attached=before.attached)
        assert before.attached != back.attached
        assert ("attachment", back.id) in kinds(changed(timed, wrong))


def test_a_plan_that_leaves_the_cap_over_its_thread() -> None:
    timed, graph = opened()
    for left in detached(graph):
        goal = next(item for item in timed.goals if item.id == left.id)
        over = tuple(
            replace(item, T_base_object=Pose((0.0, 0.0, 0.005)) @ item.T_base_object)
            if item.object == CAP
            else item
            for item in goal.placed
        )
        assert over != goal.placed
        assert ("placement", goal.id) in kinds(changed(timed, replace(goal, placed=over)))
