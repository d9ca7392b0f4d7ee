"""Position, velocity, acceleration and torque against the limits, and motion without jumps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from xei_lang.ir.goals import MoveTo
from xei_lang.ir.timed import JointLimit, TimedGoal, TimedPlan
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array, Motion, grid
from xei_lang.motion.verify.report import Finding, FindingKind
from xei_lang.motion.verify.robot import Robot
from xei_lang.profiles.model import PlanningLimit

_SIDE_S = 1e-9


def effective_limits(
    plan: TimedPlan, profile: Sequence[PlanningLimit], robot: Robot
) -> tuple[dict[str, JointLimit], tuple[Finding, ...]]:
    """By joint, the narrowest of what the plan says, the profile says and the URDF says; and where the plan
    allows more than the profile does."""
    allowed = {limit.joint: limit for limit in profile}
    narrowed: dict[str, JointLimit] = {}
    findings: list[Finding] = []
    for limit in plan.limits:
        joint, known = robot.joints.get(limit.joint), allowed.get(limit.joint)
        for wider, value, bound in _wider(limit, known):
            text = f"the plan's {wider} limit of `{limit.joint}` is wider than the profile's"
            findings.append(Finding("limits", "", "", 0.0, limit.joint, text, value, bound))
        bounds = [limit, *([known] if known is not None else [])]
        lower, upper = max(item.lower for item in bounds), min(item.upper for item in bounds)
        velocity, torque = min(item.velocity for item in bounds), min(item.torque for item in bounds)
        if joint is not None:
            lower, upper = max(lower, joint.lower), min(upper, joint.upper)
            velocity, torque = min(velocity, joint.velocity), min(torque, joint.effort)
        acceleration = min(item.acceleration for item in bounds)
        narrowed[limit.joint] = JointLimit(limit.joint, lower, upper, velocity, acceleration, torque)
    return narrowed, tuple(findings)


def _wider(limit: JointLimit, known: PlanningLimit | None) -> list[tuple[str, float, float]]:
    if known is None:
        return []
    pairs = [
        ("lower", known.lower, limit.lower),
        ("upper", limit.upper, known.upper),
        ("velocity", limit.velocity, known.velocity),
        ("acceleration", limit.acceleration, known.acceleration),
        ("torque", limit.torque, known.torque),
    ]
    return [(name, b, a) if name == "lower" else (name, a, b) for name, a, b in pairs if a > b + 1e-9]


def check_limits(context: Context) -> None:
    """Every goal's own motion at 1 kHz, and on both sides of every knot."""
    for goal in context.plan.goals:
        motion = context.timeline.motions.get(goal.id)
        if motion is None:
            continue
        times, q, v, a = _all_sides(motion, context.options.rate_hz)
        for column, joint in enumerate(goal.joints):
            limit = context.limits.get(joint)
            if limit is not None:
                _check_joint(context, goal, limit, times, q[:, column], v=v[:, column], a=a[:, column])


def _all_sides(motion: Motion, rate_hz: float) -> tuple[Array, Array, Array, Array]:
    critical = motion.critical_times()
    inside = np.clip(np.concatenate([critical - _SIDE_S, critical + _SIDE_S]), 0.0, motion.duration_s)
    right = np.concatenate([grid(0.0, motion.duration_s, rate_hz), critical, inside])
    rows = [motion.at(right), motion.at(critical, left=True)]
    q, v, a = (np.concatenate([rows[0][k], rows[1][k]]) for k in range(3))
    return np.concatenate([right, critical]), q, v, a


def _check_joint(
    context: Context, goal: TimedGoal, limit: JointLimit, times: Array, q: Array, *, v: Array, a: Array
) -> None:
    options, planned = context.options, context.planned(goal)
    fraction = planned.action.speed_fraction if planned and isinstance(planned.action, MoveTo) else 1.0
    unit = context.robot.joints[limit.joint].kind if limit.joint in context.robot.joints else ""
    unit = "m" if unit == "prismatic" else "rad"
    below, above = limit.lower - q, q - limit.upper
    worst = int(np.argmax(np.maximum(below, above)))
    bound = limit.lower if below[worst] > above[worst] else limit.upper
    if max(below[worst], above[worst]) > options.position_tolerance:
        time = goal.start_s + float(times[worst])
        text = f"`{limit.joint}` leaves its range"
        context.found(
            "position", goal, time, limit.joint, text, value=float(q[worst]), limit=bound, unit=unit
        )
    half = 0.5 * (limit.upper - limit.lower)
    if half > 0.0:
        ratio = np.abs(q - (limit.lower + half)) / half
        peak = int(np.argmax(ratio))
        context.margin(
            "position", float(ratio[peak]), limit.joint, goal.id, goal.start_s + float(times[peak])
        )
    rates: tuple[tuple[FindingKind, Array, float, float, str], ...] = (
        ("velocity", v, limit.velocity * fraction, options.velocity_ratio, unit + "/s"),
        ("acceleration", a, limit.acceleration, options.acceleration_ratio, unit + "/s2"),
    )
    for kind, values, allowed, ratio_limit, per in rates:
        peak = int(np.argmax(np.abs(values)))
        value, time = float(abs(values[peak])), goal.start_s + float(times[peak])
        context.margin(kind, value / allowed if allowed > 0.0 else 0.0, limit.joint, goal.id, time)
        if value > allowed * ratio_limit + 1e-9:
            context.found(
                kind,
                goal,
                time,
                limit.joint,
                f"`{limit.joint}` passes its {kind} limit",
                value=value,
                limit=allowed,
                unit=per,
            )


def check_jumps(context: Context) -> None:
    """Position and velocity are continuous inside each goal and from goal to goal of a joint; motion starts
    where the joint stood (`start` at first) and stops unless the joint's next goal takes over at once."""
    next_start, first_of = _next_starts(context.plan), _first_goals(context.plan)
    for goal in context.plan.goals:
        motion = context.timeline.motions.get(goal.id)
        if motion is None:
            continue
        _check_inside(context, goal, motion)
        _check_ends(context, goal, motion, next_start, first_of)


def _check_inside(context: Context, goal: TimedGoal, motion: Motion) -> None:
    options = context.options
    inner = motion.times[1:-1]
    if len(inner):
        left, right = motion.at(inner, left=True), motion.at(inner)
        _report_jump(context, goal, inner, np.abs(right[0] - left[0]), options.jump_position, what="jumps")
        _report_jump(
            context,
            goal,
            inner,
            np.abs(right[1] - left[1]),
            options.jump_velocity,
            what="changes speed at once",
        )
    if len(motion.breaks) > 2:
        u = np.diff(motion.breaks)[:-1, None]
        ends, slopes = np.zeros_like(motion.coefficients[:-1, 0]), np.zeros_like(motion.coefficients[:-1, 0])
        for power in range(motion.coefficients.shape[1] - 1, -1, -1):
            slopes = slopes * u + ends
            ends = ends * u + motion.coefficients[:-1, power]
        times = np.interp(motion.breaks[1:-1], np.maximum.accumulate(motion.s), motion.times)
        _, speed, _ = motion.phase(times)
        starts = motion.coefficients[1:, 0]
        first = motion.coefficients[1:, 1] if motion.coefficients.shape[1] > 1 else np.zeros_like(starts)
        _report_jump(context, goal, times, np.abs(starts - ends), options.jump_position, what="jumps")
        change = np.abs(first - slopes) * np.abs(speed)[:, None]
        _report_jump(context, goal, times, change, options.jump_velocity, what="changes speed at once")


def _report_jump(
    context: Context, goal: TimedGoal, times: Array, sizes: Array, allowed: float, *, what: str
) -> None:
    for column, joint in enumerate(goal.joints):
        worst = int(np.argmax(sizes[:, column]))
        size = float(sizes[worst, column])
        if size > allowed:
            time = goal.start_s + float(times[worst])
            context.found("jump", goal, time, joint, f"`{joint}` {what}", value=size, limit=allowed)


def _next_starts(plan: TimedPlan) -> Mapping[tuple[str, str], TimedGoal]:
    following: dict[tuple[str, str], TimedGoal] = {}
    latest: dict[str, TimedGoal] = {}
    for goal in reversed(plan.goals):
        for joint in goal.joints:
            if joint in latest:
                following[goal.id, joint] = latest[joint]
            latest[joint] = goal
    return following


def _check_ends(
    context: Context,
    goal: TimedGoal,
    motion: Motion,
    following: Mapping[tuple[str, str], TimedGoal],
    first_of: Mapping[str, str],
) -> None:
    options, robot = context.options, context.robot
    (q0, v0), (_, v1) = motion.ends()
    stood = context.timeline.starts[goal.id].q
    for column, joint in enumerate(goal.joints):
        if joint not in robot.column:
            continue
        held = float(stood[robot.column[joint]])
        gap = abs(float(q0[column]) - held)
        if gap > options.jump_position:
            kind: FindingKind = "start" if first_of[joint] == goal.id else "jump"
            where = "the plan's start" if kind == "start" else "where the goal before left it"
            text = f"`{joint}` does not begin at {where}"
            context.found(kind, goal, goal.start_s, joint, text, value=float(q0[column]), limit=held)
        carried = _carried_speed(context, goal, joint)
        if abs(float(v0[column]) - carried) > options.jump_velocity:
            text = f"`{joint}` is under way when the goal starts"
            context.found("jump", goal, goal.start_s, joint, text, value=float(v0[column]), limit=carried)
        after = following.get((goal.id, joint))
        handed_over = after is not None and after.start_s - goal.end_s <= options.time_tolerance_s
        if not handed_over and abs(float(v1[column])) > options.jump_velocity:
            text = f"`{joint}` is still moving when the goal ends"
            context.found("jump", goal, goal.end_s, joint, text, value=float(v1[column]), limit=0.0)


def _first_goals(plan: TimedPlan) -> dict[str, str]:
    first: dict[str, str] = {}
    for goal in plan.goals:
        for joint in goal.joints:
            first.setdefault(joint, goal.id)
    return first


def _carried_speed(context: Context, goal: TimedGoal, joint: str) -> float:
    for other in context.plan.goals:
        touching = abs(other.end_s - goal.start_s) <= context.options.time_tolerance_s
        if (
            touching
            and other.id != goal.id
            and joint in other.joints
            and other.id in context.timeline.motions
        ):
            _, (_, speed) = context.timeline.motions[other.id].ends()
            return float(speed[other.joints.index(joint)])
    return 0.0
