"""Faults of motion itself: limits passed, too much torque, jumps, wrong starts, no stop."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pinocchio as pin

from tests.motion.verify.fault_bench import Bench, Fault
from tests.motion.verify.fault_paths import (
    bump,
    cut_path,
    faster,
    middle_time,
    probe,
    resampled,
    shifted,
    split,
)
from tests.motion.verify.maker import Arm, evaluate
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MoveTo
from xei_lang.ir.timed import Knots, TimedGoal


def position_limit(bench: Bench) -> Fault | None:
    """A bump takes the joint past its bound in the middle of its path: middle value + height = bound +
    excess."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    column = bench.random.randrange(len(goal.joints))
    limit, excess = bench.limit(goal.joints[column]), 10 ** bench.random.uniform(-4, -0.7)
    value = float(evaluate(goal.knots, middle_time(goal.knots))[0][column])
    up = bench.random.random() < 0.5
    height = limit.upper + excess - value if up else limit.lower - excess - value
    return bench.fault(
        "position limit passed",
        "position",
        bench.with_goal(resampled(goal, bump(goal.knots, column, height))),
    )


def velocity_limit(bench: Bench) -> Fault | None:
    """The motion runs k times as fast, so each velocity is k times as large: k takes the fastest probe past
    its limit."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    action = bench.planned(goal).action
    fraction = action.speed_fraction if isinstance(action, MoveTo) else 1.0
    limits = np.array([bench.limit(joint).velocity for joint in goal.joints]) * fraction
    peak = max(float((np.abs(v) / limits).max()) for _, _, v, _ in probe(goal.knots))
    if peak < 1e-3:
        return None
    knots = faster(goal.knots, bench.random.uniform(1.02, 3.0) / peak)
    return bench.fault("velocity limit passed", "velocity", bench.with_goal(resampled(goal, knots)))


def acceleration_spike(bench: Bench) -> Fault | None:
    """A doublet +D, -D, +D (lengths 1, 2, 1) in the path's acceleration, which leaves `s` and `ds` behind it
    as they were. At its start the joint's acceleration is `a0 + q' D`, with D chosen so that this passes the
    limit."""
    goal = bench.random.choice(bench.moving)
    knots = goal.knots
    assert knots is not None
    lengths = [b - a for a, b in zip(knots.times_s, knots.times_s[1:], strict=False)]
    i = max(range(len(lengths)), key=lambda k: (lengths[k], -k))
    if lengths[i] < 1e-3:
        return None
    tau = min(lengths[i] / 8, bench.random.choice([2e-4, 1e-3, 5e-3]))
    begin = lengths[i] * bench.random.uniform(0.2, 0.4)
    _, velocity, acceleration = evaluate(knots, knots.times_s[i] + begin)
    sd = knots.ds[i] + knots.dds[i] * begin
    slopes = np.abs(velocity) / max(abs(sd), 1e-12)
    limits = np.array([bench.limit(joint).acceleration for joint in goal.joints])
    column = int(np.argmax(slopes / limits))
    if abs(sd) < 1e-6 or slopes[column] < 1e-9:
        return None
    size = (bench.random.uniform(1.05, 3.0) * limits[column] + abs(acceleration[column])) / slopes[column]
    changed = split(knots, i, [(begin, 0.0), (tau, size), (2 * tau, -size), (tau, size)])
    return bench.fault("acceleration spike", "acceleration", bench.with_goal(resampled(goal, changed)))


def torque_by_speed(bench: Bench) -> Fault | None:
    """The motion of empty hands runs faster until pinocchio's own inverse dynamics asks more than the limit
    of a joint."""
    goals = [
        goal
        for goal in bench.moving
        if not goal.attached
        and not any(
            o.attached
            for o in bench.plan.goals
            if o.id != goal.id and o.start_s < goal.end_s and o.end_s > goal.start_s
        )
    ]
    held = bench.plan.goals and any(goal.attached for goal in bench.plan.goals)
    first_held = min((goal.start_s for goal in bench.plan.goals if goal.attached), default=math.inf)
    goals = [goal for goal in goals if not held or goal.end_s <= first_held]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    assert goal.knots is not None
    columns = [bench.arm.names.index(joint) for joint in goal.joints]
    limits = np.array([bench.limit(joint).torque for joint in goal.joints])
    others = bench.joints_at(goal.start_s)
    for factor in (2.0, 4.0, 8.0, 16.0, 32.0):
        knots = faster(goal.knots, factor)
        for _, q, v, a in probe(knots, 12):
            rates = [np.zeros(bench.arm.model.nv), np.zeros(bench.arm.model.nv)]
            rates[0][columns], rates[1][columns] = v, a
            full = bench.arm.vector({**others, **dict(zip(goal.joints, map(float, q), strict=True))})
            for row in rates:
                _mimic(bench.arm, row)
            torque = pin.rnea(bench.arm.model, bench.arm.data, full, *rates)[columns]
            if (np.abs(torque) > 1.1 * limits).any():
                return bench.fault("torque by speed", "torque", bench.with_goal(resampled(goal, knots)))
    return None


def _mimic(arm: Arm, rates: np.ndarray) -> None:
    for k, name in enumerate(arm.names):
        if name.endswith("finger_joint1"):
            rates[arm.names.index(name[:-1] + "2")] = rates[k]


def torque_by_payload(bench: Bench) -> Fault | None:
    """The held object weighs so much that its weight alone, through the Jacobian at the goal's start (where
    the arm stands), asks three times the limit of a joint plus what the arm itself needs."""
    goals = [goal for goal in bench.moving if goal.attached]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    item, model, data = goal.attached[0], bench.arm.model, bench.arm.data
    found = bench.world.find(item.object)
    assert found is not None
    q = bench.arm.vector(bench.joints_at(goal.start_s))
    own = pin.rnea(model, data, q, np.zeros(model.nv), np.zeros(model.nv))
    frame = model.getFrameId(item.link)
    jacobian = pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
    link = data.oMf[frame]
    center = (item.T_link_object @ Pose((0.0, 0.0, found.size_m[2] / 2))).position_m
    arm_to = link.rotation @ np.array(center)
    lift = 9.81 * (jacobian[2] + arm_to[1] * jacobian[3] - arm_to[0] * jacobian[4])
    limits = np.array(
        [
            bench.limit(name).torque if any(x.joint == name for x in bench.plan.limits) else np.inf
            for name in bench.arm.names
        ]
    )
    with np.errstate(divide="ignore"):
        masses = (3.0 * limits + np.abs(own)) / np.abs(lift)
    mass = float(masses.min()) * bench.random.uniform(1.0, 3.0)
    objects = tuple(replace(o, mass_kg=mass) if o.name == item.object else o for o in bench.world.objects)
    return bench.fault("torque by payload", "torque", world=replace(bench.world, objects=objects))


def jump_inside(bench: Bench) -> Fault | None:
    """From a break in the path's middle on, one joint is shifted: left and right of the break differ by the
    shift."""
    goal = bench.random.choice(bench.moving)
    knots = goal.knots
    assert knots is not None
    if len(knots.coefficients) < 2:
        knots = cut_path(knots)
    column, piece = (
        bench.random.randrange(len(goal.joints)),
        bench.random.randrange(1, len(knots.coefficients)),
    )
    shift = 10 ** bench.random.uniform(-4, -1) * bench.random.choice([1, -1])
    pieces = [
        shifted(rows, column, shift) if k >= piece else rows for k, rows in enumerate(knots.coefficients)
    ]
    changed = resampled(goal, replace(knots, coefficients=tuple(pieces)))
    return bench.fault("jump inside", "jump", bench.with_goal(changed))


def jump_between(bench: Bench) -> Fault | None:
    """A goal that is not its joint's first is shifted as a whole, so it starts where the joint does not
    stand."""
    return _shift_goal(bench, first=False)


def wrong_first(bench: Bench) -> Fault | None:
    """A joint's first goal is shifted as a whole, so it does not begin at the plan's start."""
    return _shift_goal(bench, first=True)


def _shift_goal(bench: Bench, first: bool) -> Fault | None:
    seen: set[str] = set()
    choices: list[tuple[TimedGoal, int]] = []
    for goal in bench.moving:
        choices += [(goal, k) for k, joint in enumerate(goal.joints) if (joint not in seen) == first]
        seen.update(goal.joints)
    if not choices:
        return None
    goal, column = bench.random.choice(choices)
    assert goal.knots is not None
    shift = 10 ** bench.random.uniform(-4, -1) * bench.random.choice([1, -1])
    pieces = tuple(shifted(piece, column, shift) for piece in goal.knots.coefficients)
    changed = resampled(goal, replace(goal.knots, coefficients=pieces))
    if first:
        return bench.fault("wrong first position", "start", bench.with_goal(changed))
    return bench.fault("jump between goals", "jump", bench.with_goal(changed))


def wrong_start(bench: Bench) -> Fault | None:
    """The plan's start of a joint that some goal moves is not where that joint's first goal begins."""
    joint = bench.random.choice([joint for goal in bench.moving for joint in goal.joints])
    shift = 10 ** bench.random.uniform(-4, -1)
    start = tuple((name, value + shift if name == joint else value) for name, value in bench.plan.start)
    return bench.fault("wrong start", "start", replace(bench.plan, start=start))


def still_moving(bench: Bench) -> Fault | None:
    """The goal is cut off where one of its joints is fast, so it ends (or hands over) with that speed."""
    goal = bench.random.choice(bench.moving)
    knots = goal.knots
    assert knots is not None
    time, _, velocity, _ = bench.random.choice(probe(knots)[15:45])
    if np.abs(velocity).max() < 0.01:
        return None
    i = max(k for k in range(len(knots.dds)) if knots.times_s[k] <= time)
    w = time - knots.times_s[i]
    rows = (
        (*knots.times_s[: i + 1], time),
        (*knots.s[: i + 1], knots.s[i] + knots.ds[i] * w + knots.dds[i] * w * w / 2),
        (*knots.ds[: i + 1], knots.ds[i] + knots.dds[i] * w),
    )
    changed = Knots(knots.breaks, knots.coefficients, *rows, knots.dds[: i + 1])
    return bench.fault("still moving at the end", "jump", bench.with_goal(resampled(goal, changed)))
