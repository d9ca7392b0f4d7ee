"""The verifier: is a timed plan what the goals asked for, within every limit, without a touch? Asked from
scratch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.verify_timed import timed_problems
from xei_lang.ir.world import World
from xei_lang.motion.verify.clearance import check_clearance
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.grips import check_grips
from xei_lang.motion.verify.hands import check_hands
from xei_lang.motion.verify.limits import check_jumps, check_limits, effective_limits
from xei_lang.motion.verify.options import RobotDescription, VerifyOptions
from xei_lang.motion.verify.reach import check_reached
from xei_lang.motion.verify.report import Checked, Finding, VerificationReport
from xei_lang.motion.verify.robot import Robot
from xei_lang.motion.verify.runs import check_runs
from xei_lang.motion.verify.samples import check_samples
from xei_lang.motion.verify.schedule import check_goals, check_schedule
from xei_lang.motion.verify.timeline import Timeline, build_timeline
from xei_lang.motion.verify.torque import check_torque
from xei_lang.profiles.model import PlanningLimit


def verify_timed(
    plan: TimedPlan,
    graph: MotionGoalGraph,
    world: World,
    robot: RobotDescription,
    profile_limits: Sequence[PlanningLimit] = (),
    *,
    options: VerifyOptions | None = None,
) -> VerificationReport:
    """Check a plan against the goals it carries out, the world it moves in and the robot that it moves.

    Everything is evaluated anew from `knots`, at 1 kHz. Limits are the narrowest of the plan's, the
    profile's and the URDF's. A plan whose numbers or lengths are unsound gets no further than those
    findings: its motion means nothing.
    """
    options = options or VerifyOptions()
    problems = timed_problems(plan)
    findings = [Finding(p.kind, p.goal_id, p.step_id, p.time_s, p.subject, p.message) for p in problems]
    model = Robot(robot.urdf_text)
    findings += _unknown_joints(plan, model)
    if any(finding.kind in ("structure", "non_finite") for finding in findings):
        return VerificationReport(_sorted(findings), (), Checked(goals=len(plan.goals)))
    limits, wider = effective_limits(plan, profile_limits, model)
    timeline = build_timeline(plan, graph, world, model, robot, rate_hz=options.rate_hz)
    context = Context(
        plan, graph, world, model, robot, profile_limits, options, timeline, limits, [*findings, *wider]
    )
    for check in (check_goals, check_schedule, check_limits, check_jumps, check_samples, check_reached):
        check(context)
    check_runs(context)
    check_hands(context)
    check_grips(context)
    check_torque(context)
    distances = check_clearance(context)
    checked = _counted(plan, timeline, distances)
    return VerificationReport(_sorted(context.findings), context.margins.all(), checked)


def _unknown_joints(plan: TimedPlan, robot: Robot) -> list[Finding]:
    names = [(joint, "", "") for joint, _ in plan.start]
    names += [(joint, goal.id, goal.step_id) for goal in plan.goals for joint in goal.joints]
    return [
        Finding("structure", goal, step, 0.0, joint, f"the robot has no joint `{joint}`")
        for joint, goal, step in dict.fromkeys(names)
        if joint not in robot.column
    ]


def _counted(plan: TimedPlan, timeline: Timeline, distances: int) -> Checked:
    moving = [phase for phase in timeline.phases if phase.moving]
    seconds = float(np.sum([phase.times[-1] - phase.times[0] for phase in moving]))
    rows = sum(len(phase.times) for phase in timeline.phases)
    return Checked(len(plan.goals), seconds, rows, distances)


def _sorted(findings: list[Finding]) -> tuple[Finding, ...]:
    return tuple(sorted(findings, key=lambda f: (f.time_s, f.goal_id, f.kind, f.subject)))
