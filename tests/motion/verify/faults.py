"""Seeded faults in good plans. Each is a real violation by construction; the verifier takes no part in
making it.

`inject(plan, graph, world, robot, seed)` works on any TimedPlan. What makes a fault real stands in each
maker's docstring. Where a check is needed (a touch, a torque, a tool's error) it is pinocchio's or coal's
own, or a plain scan over angles. Knots that are changed are sampled again, so that a fault shows in one way
only.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from random import Random

import coal
import numpy as np
import pinocchio as pin

from tests.motion.verify.maker import Arm, evaluate
from xei_lang.ir.geometry import Box, Cylinder, Pose, Sphere
from xei_lang.ir.goals import Grip, JointTarget, MotionGoal, MotionGoalGraph, MoveTo, SlideMove, ToolTarget
from xei_lang.ir.timed import JointLimit, Knots, Samples, TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify import FindingKind, RobotDescription


@dataclass(frozen=True)
class Fault:
    """A faulty plan with the kind that must be found; touches and payloads change the world instead of the
    plan."""

    name: str
    kind: FindingKind
    plan: TimedPlan
    graph: MotionGoalGraph
    world: World


@dataclass
class Bench:
    """A good plan with what fault makers need to look up."""

    plan: TimedPlan
    graph: MotionGoalGraph
    world: World
    robot: RobotDescription
    arm: Arm
    random: Random

    @property
    def moving(self) -> list[TimedGoal]:
        return [goal for goal in self.plan.goals if goal.knots is not None]

    def planned(self, goal: TimedGoal) -> MotionGoal:
        return next(item for item in self.graph.goals if item.id == goal.id)

    def limit(self, joint: str) -> JointLimit:
        return next(item for item in self.plan.limits if item.joint == joint)

    def joints_at(self, time: float, plan: TimedPlan | None = None) -> dict[str, float]:
        """All joint positions at a plan time; `plan` may be one that was changed."""
        values = dict(self.plan.start)
        for goal in (plan or self.plan).goals:
            if goal.knots is None or goal.start_s > time + 1e-12:
                continue
            t = min(time - goal.start_s, goal.knots.times_s[-1])
            values.update(zip(goal.joints, map(float, evaluate(goal.knots, t)[0]), strict=True))
        return values

    def with_goal(self, goal: TimedGoal) -> TimedPlan:
        """The plan with this goal in place of the one of its id, in order and with its duration right."""
        goals = [goal if item.id == goal.id else item for item in self.plan.goals]
        goals.sort(key=lambda item: item.start_s)
        return replace(self.plan, goals=tuple(goals), duration_s=max(item.end_s for item in goals))

    def fault(
        self, name: str, kind: FindingKind, plan: TimedPlan | None = None, world: World | None = None
    ) -> Fault:
        return Fault(name, kind, plan or self.plan, self.graph, world or self.world)


_ARMS: dict[str, Arm] = {}


def inject(
    plan: TimedPlan, graph: MotionGoalGraph, world: World, robot: RobotDescription, seed: int
) -> Fault:
    """One fault of the class `seed` counts to; where the plan has no place for that class, of the next one
    that fits."""
    arm = _ARMS.setdefault(robot.urdf_text, Arm(robot.urdf_text))
    for step in range(len(MAKERS)):
        maker = MAKERS[(seed + step) % len(MAKERS)]
        bench = Bench(plan, graph, world, robot, arm, Random(f"{seed} {maker.__name__}"))
        fault = maker(bench)
        if fault is not None:
            return fault
    raise ValueError("no class of faults fits this plan")


# changing trajectories


def resampled(goal: TimedGoal, knots: Knots) -> TimedGoal:
    """The goal with other knots, its end and its samples with them."""
    end = goal.start_s + knots.times_s[-1]
    assert goal.samples is not None
    steps = max(2, round(knots.times_s[-1] * 100))
    times = tuple(goal.start_s + knots.times_s[-1] * k / steps for k in range(steps + 1))
    rows = [evaluate(knots, t - goal.start_s) for t in times]
    columns = [tuple(tuple(map(float, row[k])) for row in rows) for k in range(3)]
    return replace(goal, end_s=end, knots=knots, samples=Samples(times, *columns))


def add_polynomial(knots: Knots, joint: int, powers: list[float]) -> Knots:
    """Add `sum_k powers[k] * sigma**k` to one joint's path, sigma running from 0 to 1 over the whole path."""
    first, length = knots.breaks[0], knots.breaks[-1] - knots.breaks[0]
    pieces = []
    for start, piece in zip(knots.breaks, knots.coefficients, strict=False):
        rows = [list(row) for row in piece]
        width = len(rows[0])
        offset = (start - first) / length
        while len(rows) < len(powers):
            rows.append([0.0] * width)
        for k, power in enumerate(powers):
            for j in range(k + 1):
                rows[j][joint] += power * math.comb(k, j) * offset ** (k - j) / length**j
        pieces.append(tuple(tuple(row) for row in rows))
    return replace(knots, coefficients=tuple(pieces))


def bump(knots: Knots, joint: int, height: float) -> Knots:
    """Lift one joint's path in its middle by `height`, ends and their slopes as they were: `64 s^3 (1 -
    s)^3`."""
    return add_polynomial(knots, joint, [0, 0, 0, 64 * height, -192 * height, 192 * height, -64 * height])


def ramp(knots: Knots, joint: int, height: float) -> Knots:
    """Let one joint's path end `height` higher, as smoothly: `10 s^3 - 15 s^4 + 6 s^5`."""
    return add_polynomial(knots, joint, [0, 0, 0, 10 * height, -15 * height, 6 * height])


def faster(knots: Knots, factor: float) -> Knots:
    """The same path run `factor` times as fast."""
    times = tuple(t / factor for t in knots.times_s)
    ds, dds = tuple(v * factor for v in knots.ds), tuple(a * factor**2 for a in knots.dds)
    return replace(knots, times_s=times, ds=ds, dds=dds)


def middle_time(knots: Knots) -> float:
    """When the path is half way: found by bisection on `s`, which rises."""
    wanted, low, high = 0.5 * (knots.breaks[0] + knots.breaks[-1]), 0.0, knots.times_s[-1]
    for _ in range(60):
        mid = 0.5 * (low + high)
        i = max(k for k in range(len(knots.dds)) if knots.times_s[k] <= mid or k == 0)
        w = mid - knots.times_s[i]
        s = knots.s[i] + knots.ds[i] * w + knots.dds[i] * w * w / 2
        low, high = (mid, high) if s < wanted else (low, mid)
    return 0.5 * (low + high)


def probe(knots: Knots, count: int = 60) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray]]:
    """Times with position, velocity and acceleration."""
    times = [knots.times_s[-1] * (k + 0.5) / count for k in range(count)]
    return [(t, *evaluate(knots, t)) for t in times]


# the classes


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


def split(knots: Knots, i: int, parts: list[tuple[float, float]]) -> Knots:
    """Interval i cut into parts (length, added path acceleration) and what is left of it."""
    times, s, ds, dds = (
        list(knots.times_s[: i + 1]),
        list(knots.s[: i + 1]),
        list(knots.ds[: i + 1]),
        list(knots.dds[:i]),
    )
    for length, added in parts:
        pull = knots.dds[i] + added
        dds.append(pull)
        s.append(s[-1] + ds[-1] * length + pull * length**2 / 2)
        ds.append(ds[-1] + pull * length)
        times.append(times[-1] + length)
    dds += knots.dds[i:]
    rows = [tuple(a) + tuple(b[i + 1 :]) for a, b in ((times, knots.times_s), (s, knots.s), (ds, knots.ds))]
    return Knots(knots.breaks, knots.coefficients, rows[0], rows[1], rows[2], tuple(dds))


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


def cut_path(knots: Knots) -> Knots:
    """A path of one piece as two pieces of the same motion (Taylor's formula at the cut)."""
    cut = 0.5 * (knots.breaks[1] - knots.breaks[0])
    rows = np.array(knots.coefficients[0])
    second = [
        sum(math.comb(k, j) * cut ** (k - j) * rows[k] for k in range(j, len(rows))) for j in range(len(rows))
    ]
    pieces = (knots.coefficients[0], tuple(tuple(map(float, row)) for row in second))
    return replace(
        knots, breaks=(knots.breaks[0], knots.breaks[0] + cut, knots.breaks[1]), coefficients=pieces
    )


def shifted(piece: tuple[tuple[float, ...], ...], column: int, shift: float) -> tuple[tuple[float, ...], ...]:
    """A piece with one joint shifted as a whole."""
    first = tuple(value + shift * (k == column) for k, value in enumerate(piece[0]))
    return (first, *piece[1:])


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


def wrong_goal(bench: Bench) -> Fault | None:
    """The last joint value is off by more than the tolerance; for a tool, a scan over all members and turns
    of the reference (half a degree apart) finds none within one and a half tolerances of position or
    rotation."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    column = bench.random.randrange(len(goal.joints))
    shift = 10 ** bench.random.uniform(-2.2, -0.7) * bench.random.choice([1, -1])
    action = bench.planned(goal).action
    if not isinstance(action, MoveTo):
        shift = bench.random.uniform(0.0015, 0.02) * bench.random.choice([1, -1])
    changed = resampled(goal, ramp(goal.knots, column, shift))
    plan = bench.with_goal(changed)
    if isinstance(action, MoveTo) and isinstance(action.target, JointTarget):
        if goal.joints[column] not in dict(action.target.joints):
            return None
    elif isinstance(action, MoveTo) and isinstance(action.target, ToolTarget):
        link = dict(bench.robot.tool_links)[action.arm or "right"]
        tool = bench.arm.tool(bench.joints_at(changed.end_s, plan), link)
        if not _misses(bench, action.target, tool):
            return None
    elif not isinstance(action, Grip | SlideMove):
        return None
    return bench.fault("wrong goal", "wrong_goal", plan)


def _misses(bench: Bench, target: ToolTarget, tool: Pose) -> bool:
    family = bench.graph.family(target.family)
    turns = 720 if family.symmetric and target.turn_reference else 1
    for member in family.members:
        for k in range(turns):
            turn = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 2 * math.pi * k / turns))
            wanted = Pose(target.offset_base_m) @ target.T_base_reference @ turn
            wanted = wanted @ member.T_reference_tool @ Pose(target.offset_tool_m)
            off = wanted.inverse() @ tool
            angle = 2 * math.acos(min(1.0, off.quaternion[3]))
            far = math.dist((0.0, 0.0, 0.0), off.position_m) > 1.5 * target.position_tolerance_m
            if not far and angle < 1.5 * target.rotation_tolerance_rad:
                return False
    return True


def crooked_line(bench: Bench) -> Fault | None:
    """A bump moves the tool, half way, more than 2.5 mm from the line between its ends (pinocchio's
    kinematics)."""
    lines = [
        goal
        for goal in bench.moving
        if isinstance(action := bench.planned(goal).action, MoveTo) and action.path == "linear"
    ]
    if not lines:
        return None
    goal = bench.random.choice(lines)
    assert goal.knots is not None
    column, height = bench.random.randrange(len(goal.joints)), bench.random.uniform(0.01, 0.08)
    changed = resampled(goal, bump(goal.knots, column, height))
    plan = bench.with_goal(changed)
    action = bench.planned(goal).action
    assert isinstance(action, MoveTo)
    link = dict(bench.robot.tool_links)[action.arm or "right"]
    middle = goal.start_s + middle_time(goal.knots)
    a, b, m = (
        np.array(bench.arm.tool(bench.joints_at(t, plan), link).position_m)
        for t in (goal.start_s, changed.end_s, middle)
    )
    along = (b - a) / np.linalg.norm(b - a)
    if np.linalg.norm((m - a) - ((m - a) @ along) * along) < 2.5e-3:
        return None
    return bench.fault("crooked line", "linear_path", plan)


# touches


def object_in_path(bench: Bench) -> Fault | None:
    """An object that nobody holds or may touch is put where a shape of a moving link passes, centre on
    centre: two convex shapes that share a point overlap."""
    free = _free_objects(bench)
    if not free:
        return None
    goal, item = bench.random.choice(bench.moving), bench.random.choice(free)
    assert goal.knots is not None
    time = goal.start_s + bench.random.uniform(0.2, 0.8) * goal.knots.times_s[-1]
    q = bench.arm.vector(bench.joints_at(time))
    geometry = _geometry(bench)
    placements = geometry.createData()
    pin.updateGeometryPlacements(bench.arm.model, bench.arm.data, geometry, placements, q)
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    shapes = [
        k
        for k, shape in enumerate(geometry.geometryObjects)
        if joints.intersection(bench.arm.model.supports[shape.parentJoint])
    ]
    point = placements.oMg[bench.random.choice(shapes)].translation
    T_base_shape = Pose(tuple(map(float, point)))
    T_world_object = _base(bench, goal) @ T_base_shape @ item.geometry[0].T_object_shape.inverse()
    T_frame_object = bench.world.T_world_frame(item.frame_id).inverse() @ T_world_object
    objects = tuple(
        replace(o, T_frame_object=T_frame_object) if o.name == item.name else o for o in bench.world.objects
    )
    return bench.fault("object in the path", "collision", world=replace(bench.world, objects=objects))


def path_into_body(bench: Bench) -> Fault | None:
    """A bump bends the path, half way, at least 2 mm deep (coal) into an object that nobody holds or may
    touch."""
    free = _free_objects(bench)
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    geometry = _geometry(bench)
    data = geometry.createData()
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    moved = [
        k
        for k, s in enumerate(geometry.geometryObjects)
        if joints.intersection(bench.arm.model.supports[s.parentJoint])
    ]
    T_base_world = _base(bench, goal).inverse()
    for _ in range(40):
        column, height = bench.random.randrange(len(goal.joints)), bench.random.uniform(-1.2, 1.2)
        plan = bench.with_goal(resampled(goal, bump(goal.knots, column, height)))
        q = bench.arm.vector(bench.joints_at(goal.start_s + middle_time(goal.knots), plan))
        pin.updateGeometryPlacements(bench.arm.model, bench.arm.data, geometry, data, q)
        for item in free:
            T_base_object = T_base_world @ bench.world.T_world_object(item.name)
            for primitive in item.geometry:
                pose = _se3(T_base_object @ primitive.T_object_shape)
                if any(
                    _depth(geometry.geometryObjects[k].geometry, data.oMg[k], _coal(primitive.shape), pose)
                    < -2e-3
                    for k in moved
                ):
                    return bench.fault("path into a body", "collision", plan)
    return None


def contact_not_allowed(bench: Bench) -> Fault | None:
    """The allowed contact of a held object with what it stands in is taken away from a goal that moves the
    object, where coal finds the two at least 0.1 mm in each other as the goal starts or ends."""
    choices = []
    held = {item.object for goal in bench.plan.goals for item in goal.attached}
    for goal in (goal for goal in bench.moving if _carries(bench, goal)):
        for item in goal.attached:
            for pair in goal.allowed_contacts:
                other = bench.world.find(pair[0] if pair[1] == item.object else pair[1])
                if item.object in pair and other is not None and other.name not in held:
                    choices.append((goal, item, pair, other))
    if not choices:
        return None
    goal, item, pair, other = bench.random.choice(choices)
    found = bench.world.find(item.object)
    assert found is not None
    assert goal.knots is not None
    T_base_world = _base(bench, goal).inverse()
    for time in (goal.start_s, goal.end_s):
        T_base_object = bench.arm.tool(bench.joints_at(time), item.link) @ item.T_link_object
        T_base_other = T_base_world @ bench.world.T_world_object(other.name)
        deep = any(
            _depth(
                _coal(a.shape),
                _se3(T_base_object @ a.T_object_shape),
                _coal(b.shape),
                _se3(T_base_other @ b.T_object_shape),
            )
            < -1e-4
            for a in found.geometry
            for b in other.geometry
        )
        if deep:
            kept = tuple(p for p in goal.allowed_contacts if p != pair)
            return bench.fault(
                "contact not allowed", "collision", bench.with_goal(replace(goal, allowed_contacts=kept))
            )
    return None


def _free_objects(bench: Bench):
    held = {item.object for goal in bench.plan.goals for item in goal.attached}
    named = {name for goal in bench.graph.goals for pair in goal.allowed_contacts for name in pair}
    return [o for o in bench.world.objects if o.geometry and o.name not in held | named]


def _base(bench: Bench, goal: TimedGoal) -> Pose:
    return next(epoch.T_world_base for epoch in bench.graph.epochs if epoch.index == goal.epoch)


def _geometry(bench: Bench):
    return pin.buildGeomFromUrdfString(bench.arm.model, bench.robot.urdf_text, pin.GeometryType.COLLISION)


def _se3(pose: Pose):
    matrix = np.array(pose.matrix())
    return pin.SE3(matrix[:3, :3], matrix[:3, 3])


def _coal(shape):
    if isinstance(shape, Box):
        return coal.Box(*shape.size_m)
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius_m)
    kind = coal.Cylinder if isinstance(shape, Cylinder) else coal.Capsule
    return kind(shape.radius_m, shape.height_m)


def _depth(a, pose_a, b, pose_b) -> float:
    poses = [coal.Transform3s(pose.rotation, pose.translation) for pose in (pose_a, pose_b)]
    return float(coal.distance(a, poses[0], b, poses[1], coal.DistanceRequest(), coal.DistanceResult()))


# what the plan says


def false_samples(bench: Bench) -> Fault | None:
    """One sampled number is off by at least ten times what rounding or a knot's two sides could explain."""
    goal = bench.random.choice(bench.moving)
    samples, limits = goal.samples, bench.limit(goal.joints[0])
    assert samples is not None
    row, column = bench.random.randrange(len(samples.times_s)), bench.random.randrange(len(goal.joints))
    field, off = bench.random.choice(
        [("positions", 1e-3), ("velocities", 0.05), ("accelerations", 4 * limits.acceleration)]
    )
    rows = [list(values) for values in getattr(samples, field)]
    rows[row][column] += off * bench.random.choice([1, -1])
    changed = replace(samples, **{field: tuple(map(tuple, rows))})
    return bench.fault("false samples", "samples", bench.with_goal(replace(goal, samples=changed)))


def dropped_object(bench: Bench) -> Fault | None:
    """A goal whose joints carry the hand no longer says that the hand holds something."""
    goals = [g for g in bench.moving if g.attached and _carries(bench, g)]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    return bench.fault("held object dropped", "attachment", bench.with_goal(replace(goal, attached=())))


def _carries(bench: Bench, goal: TimedGoal) -> bool:
    model = bench.arm.model
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    return all(
        joints.intersection(model.supports[model.frames[model.getFrameId(i.link)].parentJoint])
        for i in goal.attached
    )


def moved_in_hand(bench: Bench) -> Fault | None:
    """The plan has the object elsewhere in the hand, by at least 4 mm, than where the hand took it."""
    goals = [g for g in bench.moving if g.attached]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    item = goal.attached[0]
    shift = Pose(tuple(bench.random.choice([1, -1]) * bench.random.uniform(0.004, 0.05) for _ in range(3)))
    moved = replace(item, T_link_object=item.T_link_object @ shift)
    return bench.fault(
        "object moved in the hand",
        "attachment",
        bench.with_goal(replace(goal, attached=(moved, *goal.attached[1:]))),
    )


def held_from_nowhere(bench: Bench) -> Fault | None:
    """A goal says that it holds an object that no goal ever takes."""
    free = _free_objects(bench)
    if not free:
        return None
    goal, item = bench.random.choice(bench.moving), bench.random.choice(free)
    example = next((a for g in bench.plan.goals for a in g.attached), None)
    link = example.link if example else bench.robot.tool_links[0][1]
    from xei_lang.ir.timed import Attachment

    attached = (*goal.attached, Attachment(item.name, link, Pose()))
    return bench.fault("held from nowhere", "attachment", bench.with_goal(replace(goal, attached=attached)))


def wrong_place(bench: Bench) -> Fault | None:
    """A detach states a pose at least 4 mm from where the hand was (a good plan states that within its
    tolerance of 2 mm)."""
    goals = [goal for goal in bench.plan.goals if goal.placed]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    shift = Pose(tuple(bench.random.choice([1, -1]) * bench.random.uniform(0.004, 0.05) for _ in range(3)))
    placed = replace(goal.placed[0], T_base_object=shift @ goal.placed[0].T_base_object)
    return bench.fault(
        "left in a wrong place",
        "placement",
        bench.with_goal(replace(goal, placed=(placed, *goal.placed[1:]))),
    )


def too_early(bench: Bench) -> Fault | None:
    """A goal starts before one that the graph has before it has ended."""
    by_id = {goal.id: goal for goal in bench.plan.goals}
    edges = [(a, b) for a, b in bench.graph.edges if by_id[a].end_s - by_id[a].start_s > 0.01]
    if not edges:
        return None
    a, b = (by_id[name] for name in bench.random.choice(edges))
    start = a.end_s - bench.random.uniform(0.1, 1.0) * (a.end_s - a.start_s)
    return bench.fault("goal too early", "schedule", bench.with_goal(_at_time(b, start)))


def swapped(bench: Bench) -> Fault | None:
    """Two goals, one before the other in the graph, change places in time."""
    by_id = {goal.id: goal for goal in bench.plan.goals}
    edges = [(a, b) for a, b in bench.graph.edges if by_id[a].end_s - by_id[a].start_s > 0.01]
    if not edges:
        return None
    a, b = (by_id[name] for name in bench.random.choice(edges))
    later = replace(bench, plan=bench.with_goal(_at_time(b, a.start_s)))
    end = a.start_s + (b.end_s - b.start_s)
    return bench.fault("goals swapped", "schedule", later.with_goal(_at_time(a, end)))


def _at_time(goal: TimedGoal, start: float) -> TimedGoal:
    shift = start - goal.start_s
    samples = goal.samples
    if samples is not None:
        samples = replace(samples, times_s=tuple(t + shift for t in samples.times_s))
    return replace(goal, start_s=start, end_s=goal.end_s + shift, samples=samples)


def ends_first(bench: Bench) -> Fault | None:
    """A goal without a trajectory ends before it starts."""
    goals = [goal for goal in bench.plan.goals if goal.knots is None and goal.end_s < bench.plan.duration_s]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    changed = replace(goal, end_s=goal.start_s - bench.random.uniform(0.001, 1.0))
    return bench.fault("ends before it starts", "schedule", bench.with_goal(changed))


def missing_goal(bench: Bench) -> Fault | None:
    """One goal of the graph is not in the plan."""
    goal = bench.random.choice(bench.plan.goals)
    goals = tuple(item for item in bench.plan.goals if item.id != goal.id)
    duration = max((item.end_s for item in goals), default=0.0)
    return bench.fault("goal missing", "goals", replace(bench.plan, goals=goals, duration_s=duration))


def extra_goal(bench: Bench) -> Fault | None:
    """The plan has a goal that the graph does not know."""
    end = bench.plan.duration_s
    goal = replace(
        bench.plan.goals[-1],
        id="nobody_asked",
        joints=(),
        knots=None,
        samples=None,
        attached=(),
        placed=(),
        tool=None,
        start_s=end,
        end_s=end,
    )
    return bench.fault("goal extra", "goals", replace(bench.plan, goals=(*bench.plan.goals, goal)))


def not_a_number(bench: Bench) -> Fault | None:
    """One number of a trajectory is NaN or infinite."""
    goal = bench.random.choice(bench.moving)
    bad = bench.random.choice([math.nan, math.inf, -math.inf])
    assert goal.knots is not None
    assert goal.samples is not None
    if bench.random.random() < 0.5:
        name = bench.random.choice(["breaks", "times_s", "s", "ds", "dds"])
        row = list(getattr(goal.knots, name))
        row[bench.random.randrange(len(row))] = bad
        changed = replace(goal, knots=replace(goal.knots, **{name: tuple(row)}))
    else:
        name = bench.random.choice(["positions", "velocities", "accelerations"])
        rows = [list(row) for row in getattr(goal.samples, name)]
        rows[bench.random.randrange(len(rows))][bench.random.randrange(len(goal.joints))] = bad
        changed = replace(goal, samples=replace(goal.samples, **{name: tuple(map(tuple, rows))}))
    return bench.fault("not a number", "non_finite", bench.with_goal(changed))


def short_rows(bench: Bench) -> Fault | None:
    """Samples or knots have a row too few."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    assert goal.samples is not None
    if bench.random.random() < 0.5:
        changed = replace(goal, knots=replace(goal.knots, ds=goal.knots.ds[:-1]))
    else:
        changed = replace(goal, samples=replace(goal.samples, velocities=goal.samples.velocities[:-1]))
    return bench.fault("a row too few", "structure", bench.with_goal(changed))


MAKERS: tuple[Callable[[Bench], Fault | None], ...] = (
    position_limit,
    velocity_limit,
    acceleration_spike,
    torque_by_speed,
    torque_by_payload,
    jump_inside,
    jump_between,
    wrong_first,
    wrong_start,
    still_moving,
    wrong_goal,
    crooked_line,
    object_in_path,
    path_into_body,
    contact_not_allowed,
    false_samples,
    dropped_object,
    moved_in_hand,
    held_from_nowhere,
    wrong_place,
    too_early,
    swapped,
    ends_first,
    missing_goal,
    extra_goal,
    not_a_number,
    short_rows,
)
