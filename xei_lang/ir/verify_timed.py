"""Structural verifier of a TimedPlan: what must hold before anybody can ask whether the motion is good.

Numbers are finite; lengths fit; knots are in order; goals are sorted by start, have unique ids, end after
they start, and no two share a resource or a joint at one time. Whether the motion keeps its limits is for
`motion/verify`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span
from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import Knots, Samples, TimedGoal, TimedPlan

TIME_TOLERANCE_S = 1e-6

ProblemKind = Literal["structure", "non_finite", "schedule"]
_CODES: Mapping[ProblemKind, str] = {"structure": "XEI0850", "non_finite": "XEI0851", "schedule": "XEI0853"}


@dataclass(frozen=True, slots=True)
class TimedProblem:
    """One structural fault: of which goal (empty: of the plan), when (plan time, s), about what, in words."""

    kind: ProblemKind
    goal_id: str
    step_id: str
    time_s: float
    subject: str
    message: str


def timed_problems(plan: TimedPlan) -> tuple[TimedProblem, ...]:
    """All structural faults of a plan, goal by goal in its order, the schedule's last."""
    found: list[TimedProblem] = []
    if not _finite(_plan_numbers(plan)):
        found.append(_of_plan("non_finite", "plan", "a number of the plan is not finite"))
    found.extend(_plan_faults(plan))
    limited = {limit.joint for limit in plan.limits}
    for goal in plan.goals:
        if not _finite(_goal_numbers(goal)):
            found.append(_of_goal("non_finite", goal, goal.id, "a number of the goal is not finite"))
            continue
        for subject, message in _goal_faults(goal, limited):
            found.append(_of_goal("structure", goal, subject, message))
    found.extend(_schedule_faults(plan))
    return tuple(found)


def verify_timed_structure(plan: TimedPlan, spans: Mapping[str, Span] | None = None) -> Diagnostics:
    """The structural faults as diagnostics; `spans` gives, by goal id, the step that the goal came from."""
    spans = spans or {}
    return tuple(
        Diagnostic(
            _CODES[problem.kind],
            f"timed goal `{problem.goal_id}`: {problem.message}" if problem.goal_id else problem.message,
            spans.get(problem.goal_id),
            label=problem.message,
        )
        for problem in timed_problems(plan)
    )


def _of_plan(kind: ProblemKind, subject: str, message: str) -> TimedProblem:
    return TimedProblem(kind, "", "", 0.0, subject, message)


def _of_goal(kind: ProblemKind, goal: TimedGoal, subject: str, message: str) -> TimedProblem:
    time = goal.start_s if math.isfinite(goal.start_s) else 0.0
    return TimedProblem(kind, goal.id, goal.step_id, time, subject, message)


def _finite(numbers: Iterable[float]) -> bool:
    # A sum is finite only where every term is (overflow aside, which is no number of a plan either).
    return math.isfinite(sum(map(abs, numbers)))


def _pose_numbers(pose: Pose) -> tuple[float, ...]:
    return (*pose.position_m, *pose.quaternion)


def _plan_numbers(plan: TimedPlan) -> Iterator[float]:
    yield plan.duration_s
    yield plan.rate_hz
    yield from (value for _, value in plan.start)
    for limit in plan.limits:
        yield from (limit.lower, limit.upper, limit.velocity, limit.acceleration, limit.torque)


def _goal_numbers(goal: TimedGoal) -> Iterator[float]:
    yield goal.start_s
    yield goal.end_s
    for pose in (
        *(item.T_link_object for item in goal.attached),
        *(item.T_base_object for item in goal.placed),
        *((goal.tool,) if goal.tool is not None else ()),
    ):
        yield from _pose_numbers(pose)
    if goal.knots is not None:
        knots = goal.knots
        for row in (knots.breaks, knots.times_s, knots.s, knots.ds, knots.dds):
            yield from row
        for piece in knots.coefficients:
            for row in piece:
                yield from row
    if goal.samples is not None:
        yield from goal.samples.times_s
        for rows in (goal.samples.positions, goal.samples.velocities, goal.samples.accelerations):
            for row in rows:
                yield from row


def _plan_faults(plan: TimedPlan) -> Iterator[TimedProblem]:
    seen: set[str] = set()
    for goal in plan.goals:
        if goal.id in seen:
            yield _of_goal("structure", goal, goal.id, "the id stands twice in the plan")
        seen.add(goal.id)
    for name, values in (("start", [j for j, _ in plan.start]), ("limits", [x.joint for x in plan.limits])):
        if len(set(values)) != len(values):
            yield _of_plan("structure", name, f"a joint stands twice in `{name}`")
    last = max((goal.end_s for goal in plan.goals), default=0.0)
    if abs(plan.duration_s - last) > TIME_TOLERANCE_S:
        yield _of_plan(
            "structure", "duration_s", f"lasts {plan.duration_s:.6g} s, its last goal {last:.6g} s"
        )


def _goal_faults(goal: TimedGoal, limited: set[str]) -> Iterator[tuple[str, str]]:
    if len(set(goal.joints)) != len(goal.joints):
        yield goal.id, "a joint stands twice in `joints`"
    for joint in goal.joints:
        if joint not in limited:
            yield joint, f"the plan has no limits for `{joint}`"
    if bool(goal.joints) != (goal.knots is not None) or bool(goal.joints) != (goal.samples is not None):
        yield goal.id, "joints, knots and samples must be given together"
        return
    duration = goal.end_s - goal.start_s
    if goal.knots is not None:
        yield from ((goal.id, message) for message in _knots_faults(goal.knots, len(goal.joints), duration))
    if goal.samples is not None:
        yield from ((goal.id, message) for message in _samples_faults(goal.samples, goal))


def _rising(row: tuple[float, ...], strictly: bool) -> bool:
    return all(b > a if strictly else b >= a for a, b in pairwise(row))


def _knots_faults(knots: Knots, joints: int, duration_s: float) -> Iterator[str]:
    pieces, steps = len(knots.coefficients), len(knots.dds)
    if pieces < 1 or len(knots.breaks) != pieces + 1:
        yield f"knots have {len(knots.breaks)} breaks for {pieces} pieces"
        return
    if steps < 1 or not len(knots.times_s) == len(knots.s) == len(knots.ds) == steps + 1:
        yield f"knots have {steps} accelerations for {len(knots.times_s)} times"
        return
    if any(not piece or any(len(row) != joints for row in piece) for piece in knots.coefficients):
        yield f"coefficients are not rows of {joints} joints"
    if not _rising(knots.breaks, strictly=True):
        yield "breaks do not rise"
    if not _rising(knots.times_s, strictly=False):
        yield "knot times run back"
    if abs(knots.times_s[0]) > TIME_TOLERANCE_S or abs(knots.times_s[-1] - duration_s) > TIME_TOLERANCE_S:
        yield f"knots cover {knots.times_s[0]:.6g} .. {knots.times_s[-1]:.6g} s of {duration_s:.6g} s"
    slack = 1e-6 * max(1.0, knots.breaks[-1] - knots.breaks[0])
    if min(knots.s) < knots.breaks[0] - slack or max(knots.s) > knots.breaks[-1] + slack:
        yield "the path parameter leaves the path"


def _samples_faults(samples: Samples, goal: TimedGoal) -> Iterator[str]:
    count = len(samples.times_s)
    lengths = {len(samples.positions), len(samples.velocities), len(samples.accelerations)}
    if count < 1 or lengths != {count}:
        yield f"{count} sample times, but {sorted(lengths)} rows"
        return
    rows = (*samples.positions, *samples.velocities, *samples.accelerations)
    if any(len(row) != len(goal.joints) for row in rows):
        yield f"sample rows are not of {len(goal.joints)} joints"
    if not _rising(samples.times_s, strictly=False):
        yield "sample times run back"
    first, last = samples.times_s[0], samples.times_s[-1]
    if abs(first - goal.start_s) > TIME_TOLERANCE_S or abs(last - goal.end_s) > TIME_TOLERANCE_S:
        yield f"samples cover {first:.6g} .. {last:.6g} s, the goal {goal.start_s:.6g} .. {goal.end_s:.6g} s"


def _schedule_faults(plan: TimedPlan) -> Iterator[TimedProblem]:
    before = -math.inf
    busy: dict[str, tuple[float, str]] = {}
    for goal in plan.goals:
        if goal.start_s < before:
            yield _of_goal("schedule", goal, goal.id, "goals are not sorted by start")
        before = goal.start_s
        if goal.end_s < goal.start_s or goal.start_s < 0.0:
            yield _of_goal("schedule", goal, goal.id, f"runs from {goal.start_s:.6g} s to {goal.end_s:.6g} s")
            continue
        for name in dict.fromkeys((goal.resource, *goal.resources, *(f"joint {j}" for j in goal.joints))):
            free_s, holder = busy.get(name, (-math.inf, ""))
            if name and goal.start_s < free_s - TIME_TOLERANCE_S:
                message = f"starts at {goal.start_s:.6g} s while `{holder}` has `{name}` until {free_s:.6g} s"
                yield _of_goal("schedule", goal, name, message)
            if goal.end_s > free_s:
                busy[name] = (goal.end_s, goal.id)
