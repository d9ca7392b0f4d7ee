"""An instrument works while the arms do, and the schedule waits for it: from text to motion and a dry run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.e2e.made import PROTOCOLS, compiled
from xei_lang.cli.deliver import Compiled
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.verify import RobotDescription, VerifyOptions, verify_timed
from xei_lang.profiles.open import robot_texts
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.run import run

PATH = next(path for path in PROTOCOLS if path.stem == "warm_tubes")


def timed() -> TimedPlan:
    plan = compiled(PATH)[1].made.timed
    assert plan is not None
    return plan


def hurried(by_s: float) -> TimedPlan:
    """The plan with its `await` shorter, and all that follows as much earlier."""
    plan = timed()
    index = next(k for k, goal in enumerate(plan.goals) if goal.step_id == "await#1")
    goals = list(plan.goals)
    goals[index] = replace(goals[index], end_s=goals[index].end_s - by_s)
    for k in range(index + 1, len(goals)):
        goal, samples = goals[k], goals[k].samples
        if samples is not None:
            samples = replace(samples, times_s=tuple(time - by_s for time in samples.times_s))
        goals[k] = replace(goal, start_s=goal.start_s - by_s, end_s=goal.end_s - by_s, samples=samples)
    return replace(plan, goals=tuple(goals), duration_s=plan.duration_s - by_s)


def test_the_await_ends_when_the_work_is_done_and_the_arms_move_meanwhile() -> None:
    goals = {goal.id: goal for goal in timed().goals}
    start, end = goals["warm/1"], goals["await#1/1"]
    pause, resume = goals["pause#1/1"], goals["pause#1.resume/1"]
    assert start.start_s == start.end_s
    worked = pause.start_s - start.end_s + end.end_s - resume.end_s
    assert worked == pytest.approx(120.0)
    moving = [goal for goal in goals.values() if goal.joints and start.end_s < goal.start_s < end.start_s]
    assert len(moving) >= 10
    assert all(goal.resources == ("heater_block",) for goal in (start, pause, resume, end))


@pytest.mark.parametrize("by_s", [0.0, 0.5])
def test_the_verifier_finds_an_await_that_ends_too_soon(by_s: float) -> None:
    made = compiled(PATH)[1].made
    assert made.profile and made.graph and made.world
    robot = RobotDescription(*robot_texts(made.profile))
    calibration = made.profile.calibration
    options = VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad)
    report = verify_timed(hurried(by_s), made.graph, made.world, robot, calibration.limits, options=options)
    found = [finding.message for finding in report.findings]
    assert found == (["it ends before `heater_block` has done its work"] if by_s else [])


def test_the_dry_run_finds_it_too() -> None:
    request, outcome = compiled(PATH)
    given = replace(Compiled.of(request.source, outcome.made).run_inputs(), timed=hurried(0.5))
    result = run(given, "dry-run", Answers(), lambda event: None)
    assert result.status == "failed"
    assert "has worked 119.5 of 120 s" in result.diagnostics[0].message
