"""The dry run on its own: it fails what the checks before it would have stopped."""

from __future__ import annotations

from dataclasses import replace

from tests.runtime.small import handoffs, samples_of
from xei_lang.ir.trace import RuntimeFeedback
from xei_lang.runtime.executors.dry_run import DryRun
from xei_lang.runtime.state import initial_state


def try_goals(*names: str, **changes: object) -> RuntimeFeedback:
    """Feedback of the last goal; `changes` are made to its timed goal."""
    given = handoffs()
    executor = DryRun.starting_at(initial_state(given))
    goals = {goal.id: goal for goal in given.graph.goals}
    timed = {goal.id: goal for goal in given.timed.goals}
    for name in names[:-1]:
        assert executor.execute(goals[name], timed[name]).status == "succeeded"
    return executor.execute(goals[names[-1]], replace(timed[names[-1]], **changes))


def test_goals_that_meet_succeed() -> None:
    assert try_goals("approach", "take", "lift").status == "succeeded"


def test_a_goal_that_starts_elsewhere_fails() -> None:
    feedback = try_goals("lift")
    assert (feedback.status, feedback.failed_stage) == ("failed", "hardware_execution")
    assert "starts at 1.6500" in feedback.message


def test_a_full_or_empty_hand_fails() -> None:
    assert try_goals("take", "take").status == "failed"
    assert try_goals("leave").status == "failed"


def test_a_trajectory_out_of_shape_fails() -> None:
    samples = samples_of(handoffs(), "approach")
    assert "fill the time" in try_goals("approach", end_s=3.0).message
    assert (
        "one row" in try_goals("approach", samples=replace(samples, positions=samples.positions[1:])).message
    )
    assert "one value" in try_goals("approach", joints=("openarm_left_joint4", "slide_joint")).message
    backwards = replace(samples, times_s=(samples.times_s[0], *samples.times_s[:-1]))
    assert "do not grow" in try_goals("approach", samples=backwards).message


def test_a_stopped_executor_does_nothing() -> None:
    given = handoffs()
    executor = DryRun.starting_at(initial_state(given))
    executor.stop()
    assert executor.execute(given.graph.goals[0], given.timed.goals[0]).status == "failed"
