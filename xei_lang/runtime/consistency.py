"""The checks between plans: skills covered, goals that the robot can do, and a schedule of exactly these."""

from __future__ import annotations

import math

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import Grip, MotionGoal, MoveTo, SlideMove, Wait
from xei_lang.ir.timed import TimedGoal
from xei_lang.runtime.failure import Failure, failure
from xei_lang.runtime.handoffs import TIME_TOLERANCE_S, Handoffs


def check_plans(given: Handoffs) -> Failure | None:
    """The timed plan is a schedule of exactly the goals of the graph, in an order that keeps every edge."""
    goals = {goal.id: goal for goal in given.graph.goals}
    timed = {goal.id: goal for goal in given.timed.goals}
    for kind, ids in (
        ("timed plan", goals.keys() - timed.keys()),
        ("goal graph", timed.keys() - goals.keys()),
    ):
        if ids:
            return _unfit(f"the {kind} lacks the goal `{min(ids)}`")
    for goal in given.graph.goals:
        problem = _fits(goal, timed[goal.id])
        if problem:
            return _unfit(f"goal `{goal.id}` {problem}", goal)
    for before, after in given.graph.edges:
        if before not in goals or after not in goals:
            return _unfit(f"an edge leads from `{before}` to `{after}`, and one of them is no goal")
        if timed[after].start_s < timed[before].end_s - TIME_TOLERANCE_S:
            return _unfit(f"goal `{after}` starts before `{before}` has ended", goals[after])
    return _check_resources(given, goals)


def check_coverage(given: Handoffs, virtual: bool) -> Failure | None:
    """Every skill is registered and became goals; a request without a skill passes in a virtual run only."""
    lowered = {goal.step_id for goal in given.graph.goals}
    for step in given.plan.steps:
        if step.kind == "skill" and given.profile.bank.skill(step.skill) is None:
            return failure(
                "skill_coverage",
                "XEI0905",
                f"the skill `{step.skill}` is not in the skill bank",
                step.span,
                note="development_profile.yaml lists what the robot has learnt",
            )
        if step.kind == "skill" and step.step_id not in lowered:
            return failure(
                "skill_coverage",
                "XEI0905",
                f"step `{step.step_id}` (`{step.skill}`) was lowered to no goal",
                step.span,
            )
    if given.plan.unmapped_requests and not virtual:
        request = given.plan.unmapped_requests[0]
        return failure(
            "skill_coverage",
            "XEI0906",
            f"`{request.text}` has no skill",
            request.span,
            note=request.reason,
            help="use the dry run, or take the request out of the protocol",
        )
    return None


def check_parameters(given: Handoffs) -> Failure | None:
    """Openings, heights, speeds and durations are ones that this robot can do."""
    limits = {limit.joint: limit for limit in given.profile.calibration.limits}
    families = {family.id for family in given.graph.families}
    for goal in given.graph.goals:
        problem = ""
        match goal.action:
            case Grip(arm=arm, opening_m=opening):
                finger = limits.get(f"openarm_{arm}_finger_joint1")
                if finger and not 2 * finger.lower <= opening <= 2 * finger.upper + 1e-9:
                    problem = (
                        f"a gap of {1000 * opening:g} mm, and the jaws do "
                        f"{2000 * finger.lower:g} .. {2000 * finger.upper:g} mm"
                    )
            case SlideMove(height_m=height):
                slide = limits.get("slide_joint")
                if slide and not slide.lower - 1e-9 <= height <= slide.upper + 1e-9:
                    problem = (
                        f"a height of {1000 * height:g} mm, and the slide does "
                        f"{1000 * slide.lower:g} .. {1000 * slide.upper:g} mm"
                    )
            case MoveTo(speed_fraction=fraction) if not 0.0 < fraction <= 1.0:
                problem = f"the fraction {fraction:g} of full speed, which must be above 0 and at most 1"
            case MoveTo(target=ToolTarget(family=family)) if family not in families:
                problem = f"the grasps `{family}`, which the goal graph does not have"
            case Wait(duration_s=duration) if not 0.0 <= duration < math.inf:
                problem = f"a wait of {duration:g} s"
            case _:
                pass
        if problem:
            return failure(
                "operation_parameters", "XEI0907", f"goal `{goal.id}` asks for {problem}", goal.span
            )
    return None


def _fits(goal: MotionGoal, timed: TimedGoal) -> str:
    if (goal.kind, goal.step_id, goal.epoch) != (timed.kind, timed.step_id, timed.epoch):
        return "has another kind, step or epoch in the timed plan than in the goal graph"
    duration = timed.end_s - timed.start_s
    if timed.start_s < 0.0 or duration < 0.0:
        return "ends before it starts"
    if not goal.min_duration_s - TIME_TOLERANCE_S <= duration <= goal.max_duration_s + TIME_TOLERANCE_S:
        return f"takes {duration:g} s, and {goal.min_duration_s:g} .. {goal.max_duration_s:g} s are allowed"
    return ""


def _check_resources(given: Handoffs, goals: dict[str, MotionGoal]) -> Failure | None:
    busy: dict[str, TimedGoal] = {}
    for timed in sorted(given.timed.goals, key=lambda item: (item.start_s, item.end_s)):
        for resource in timed.resources:
            other = busy.get(resource)
            if other and timed.start_s < other.end_s - TIME_TOLERANCE_S:
                return _unfit(
                    f"goals `{other.id}` and `{timed.id}` use `{resource}` at the same time", goals[timed.id]
                )
            busy[resource] = timed
    return None


def _unfit(message: str, goal: MotionGoal | None = None) -> Failure:
    return failure(
        "planner_validation",
        "XEI0904",
        message,
        goal.span if goal else None,
        help="compile the protocol again",
    )
