"""The arm that lowering chose cannot: the other one is tried, and what is said tells what was tried."""

from __future__ import annotations

from dataclasses import replace

from tests.motion.sequence.bench import DESCRIPTION, bench, goals, obj, plan, spot
from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.goals import MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.either_arm import plan_with_either_arm
from xei_lang.profiles.model import Profile


def stiff(profile: Profile, side: str) -> Profile:
    """The profile with an arm that can do little more than stand at `ready`."""
    ready = dict(profile.robot.state("ready"))
    limits = tuple(
        replace(
            limit,
            lower=max(limit.lower, min(0.0, ready[limit.joint]) - 0.05),
            upper=min(limit.upper, max(0.0, ready[limit.joint]) + 0.05),
        )
        if limit.joint.startswith(f"openarm_{side}_joint")
        else limit
        for limit in profile.calibration.limits
    )
    return replace(profile, calibration=replace(profile.calibration, limits=limits))


def planned(steps: SkillPlan, profile: Profile) -> tuple[MotionGoalGraph, TimedPlan | None, Diagnostics]:
    _, world = bench()
    graph = goals(steps, profile, world)
    return plan_with_either_arm(steps, graph, world, profile, DESCRIPTION, 1)


def arms(graph: MotionGoalGraph) -> set[str | None]:
    return {
        goal.action.arm
        for goal in graph.goals
        if goal.step_id == "pick#1" and isinstance(goal.action, MoveTo)
    }


def test_an_arm_that_nobody_asked_for_gives_way_to_the_other() -> None:
    profile, world = bench()
    steps = plan(("pick", {"object": obj("tube_4"), "arm": "either"}))
    assert arms(goals(steps, profile, world)) == {"right"}
    graph, timed, problems = planned(steps, stiff(profile, "right"))
    assert timed is not None, problems
    assert arms(graph) == {"left"}
    told = [item for goal in graph.goals for item in goal.parameters if item.name == "arm"]
    assert [item.rule for item in told] == ["the other arm was tried and cannot"]


def test_an_arm_that_was_asked_for_stays_and_the_other_is_offered() -> None:
    profile, _ = bench()
    steps = plan(("pick", {"object": obj("tube_4"), "arm": "right"}))
    graph, timed, problems = planned(steps, stiff(profile, "right"))
    assert timed is None
    assert arms(graph) == {"right"}
    assert problems[0].code == "XEI0801"
    assert problems[0].help[0] == "the left arm can: say `arm=left`"


def test_where_neither_arm_can_both_are_told() -> None:
    profile, _ = bench()
    steps = plan(("move_object", {"object": obj("bottle_1"), "to": spot("table", "beaker"), "arm": "either"}))
    _, timed, problems = planned(steps, profile)
    assert timed is None
    said = problems[0]
    assert said.message == 'the right arm cannot reach `table.spot("beaker")` with `bottle_1`'
    assert "the left arm was tried as well: the left arm cannot reach `bottle_1`" in said.notes
    assert not any("say `arm=" in text for text in said.help)
    assert said.help[0].startswith(
        "the left arm reaches this place: set `bottle_1` down where both arms reach"
    )


def test_a_step_of_two_hands_keeps_both_where_one_was_asked_for() -> None:
    profile, _ = bench()
    steps = plan(("twist_open", {"object": obj("bottle_2"), "hold": "either", "twist": "left"}))
    _, timed, problems = planned(steps, stiff(profile, "right"))
    assert timed is None
    assert problems[0].message == "the right arm cannot reach `bottle_2`"
    assert not any("tried as well" in text for text in problems[0].notes)
