"""Planner and verifier reckon apart where everything is: over any chain of moves, takes, leaves and drives
they agree, and what is fastened sits on its carrier as it did when it was fastened.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.capped import BOTTLE, CAP, capped
from tests.motion.sequence.bench import SRDF, URDF, context
from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import (
    Action,
    Attach,
    Detach,
    Epoch,
    GoalKind,
    MotionGoal,
    MotionGoalGraph,
    NavToPose,
    Wait,
)
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import Knots, TimedGoal, TimedPlan
from xei_lang.ir.world import World, WorldObject
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import left, where
from xei_lang.motion.sequence.poses import pose_of
from xei_lang.motion.sequence.snapshot import Held, Snapshot, first_snapshot
from xei_lang.motion.verify import RobotDescription
from xei_lang.motion.verify.robot import Robot
from xei_lang.motion.verify.timeline import Timeline, build_timeline

THINGS = (BOTTLE, CAP, "ring")
"""The cap rides on the bottle at first, and the ring on the cap."""
LASTS_S = 0.5
FAMILY = Family("any", "any", (ToolPose("only", Pose.from_rpy((0.1, 0.0, 0.05), (0.3, 0.2, 0.1))),))

Event = tuple[str, Side, str, str, tuple[float, ...], Pose]


@cache
def problem() -> tuple[Context, World, Robot]:
    profile, world = capped()
    item = world.find(CAP)
    assert item is not None
    above = item.T_frame_object @ Pose.from_rpy((0.001, 0.0, 0.02), (0.0, 0.0, 0.5))
    ring: WorldObject = replace(item, name="ring", T_frame_object=above, place="", fastened_to=CAP)
    world = replace(world, objects=(*world.objects, ring))
    return context(profile, world), world, Robot(URDF)


@dataclass
class Chain:
    """A snapshot of the planner's that is led along, and the goals that lead it, for the verifier."""

    now: Snapshot
    goals: list[MotionGoal] = field(default_factory=list)
    timed: list[TimedGoal] = field(default_factory=list)
    after: dict[str, Snapshot] = field(default_factory=dict)
    epochs: list[Epoch] = field(default_factory=list)

    def act(self, kind: GoalKind, action: Action, after: Snapshot, joints: tuple[str, ...] = ()) -> None:
        name, start_s = f"g{len(self.goals)}", LASTS_S * len(self.goals)
        names = problem()[0].robot.joint_names
        columns = [names.index(joint) for joint in joints]
        knots = line(self.now.q[columns], after.q[columns]) if joints else None
        self.goals.append(MotionGoal(name, "s", kind, action, len(self.epochs) - 1, (), Span("a", 0, 1)))
        attached = self.now.attachments(problem()[0].robot)
        end_s, epoch = start_s + LASTS_S, len(self.epochs) - 1
        goal = TimedGoal(name, "s", kind, "", (), epoch, start_s, end_s, joints, None, knots, attached)
        self.timed.append(goal)
        self.now = self.after[name] = after

    def timeline(self) -> Timeline:
        """The verifier's account of the same goals."""
        _, world, robot = problem()
        start = first_snapshot(problem()[0].robot, world)
        joints = tuple(zip(problem()[0].robot.joint_names, start.q.tolist(), strict=True))
        plan = TimedPlan(joints, (), tuple(self.timed), LASTS_S * len(self.timed), (), 0)
        graph = MotionGoalGraph(tuple(self.goals), (), (FAMILY,), tuple(self.epochs))
        about = RobotDescription(URDF, SRDF)
        return build_timeline(plan, graph, world, robot, about, rate_hz=10.0)


def line(start: np.ndarray, end: np.ndarray) -> Knots:
    piece = (tuple(start.tolist()), tuple((end - start).tolist()))
    pace = 1.0 / LASTS_S
    return Knots((0.0, 1.0), (piece,), (0.0, LASTS_S), (0.0, 1.0), (pace, pace), (0.0,))


def take(chain: Chain, side: Side, name: str) -> None:
    """The hand takes the thing where both are, however far apart."""
    told, _, _ = problem()
    if side in chain.now.held or chain.now.holders(name):
        return
    T_base_object = where(told, name, chain.now)
    assert T_base_object is not None
    T_base_tool = pose_of(told.robot.T_base_frame(chain.now.q, told.robot.arm(side).tool_frame))
    T_reference_object = FAMILY.members[0].T_reference_tool @ T_base_tool.inverse() @ T_base_object
    after = chain.now.attached(side, Held(name, FAMILY, 0, T_reference_object))
    chain.act("attach", Attach(name, side, FAMILY.id), after)


def leave(chain: Chain, side: Side, on: str) -> None:
    """The hand leaves what it holds where it is, fastened on another thing if that does not ride on it."""
    told, _, _ = problem()
    held = chain.now.held.get(side)
    if held is None:
        return
    T_base_object = where(told, held.object, chain.now)
    assert T_base_object is not None
    own = {held.object, *(rider for rider, _ in chain.now.riders(held.object))}
    action = Detach(held.object, side, "", T_base_object, on if on and on not in own else "")
    chain.act("detach", action, left(told, action, T_base_object, chain.now))


def move(chain: Chain, side: Side, shares: tuple[float, ...]) -> None:
    """The arm goes somewhere within its limits."""
    robot = problem()[0].robot
    columns = list(robot.arm(side).q_indices)
    q = chain.now.q.copy()
    q[columns] = robot.lower[columns] + np.array(shares) * (robot.upper - robot.lower)[columns]
    chain.act("wait", Wait(LASTS_S), chain.now.moved(q), robot.arm(side).joint_names)


def drive(chain: Chain, pose: Pose) -> None:
    """The base goes elsewhere."""
    chain.act("nav_to_pose", NavToPose("b", pose, 0.1, 0.1), replace(chain.now, T_world_base=pose))
    chain.epochs.append(Epoch(len(chain.epochs), "b", pose))


def told_by(events: list[Event]) -> Chain:
    told, world, _ = problem()
    chain = Chain(first_snapshot(told.robot, world), epochs=[Epoch(0, "a", world.robot.T_world_base)])
    for kind, side, name, on, shares, pose in events:
        if kind == "take":
            take(chain, side, name)
        elif kind == "leave":
            leave(chain, side, on)
        elif kind == "move":
            move(chain, side, shares)
        else:
            drive(chain, pose)
    return chain


sides = st.sampled_from(["left", "right"])
coordinates = st.floats(-1.0, 1.0)
events = st.tuples(
    st.sampled_from(["take", "leave", "move", "take", "leave", "move", "drive"]),
    sides,
    st.sampled_from(THINGS),
    st.sampled_from(("", *THINGS)),
    st.tuples(*[st.floats(0.0, 1.0)] * 7),
    st.builds(lambda x, y, yaw: Pose.from_rpy((x, y, 0.0), (0.0, 0.0, 3.0 * yaw)), *[coordinates] * 3),
)


@settings(max_examples=60)
@given(st.lists(events, min_size=4, max_size=16))
def test_planner_and_verifier_agree_where_everything_is(chosen: list[Event]) -> None:
    chain, told = told_by(chosen), problem()[0]
    timeline = chain.timeline()
    for goal in chain.goals:
        snapshot, scene = chain.after[goal.id], timeline.ends[goal.id].scene
        assert scene.riders == {name: ride.carrier for name, ride in snapshot.riding.items()}
        carried = {(item.side, item.object): item.T_tool_object for item in snapshot.carried()}
        assert {(item.side, item.object) for item in scene.held} == set(carried)
        for item in scene.held:
            close(item.T_link_object, carried[item.side, item.object])
        if goal.kind == "wait":
            continue  # the verifier brings what hands hold up to date when something else happens to it
        for name in THINGS:
            pose = where(told, name, snapshot)
            assert pose is not None
            close(scene.objects[name], pose)


@settings(max_examples=60)
@given(st.lists(events, min_size=4, max_size=16))
def test_what_is_fastened_sits_as_it_did_when_it_was_fastened(chosen: list[Event]) -> None:
    chain, told = told_by(chosen), problem()[0]
    start = first_snapshot(told.robot, problem()[1])
    sits: dict[tuple[str, str], Pose] = {}
    for snapshot in (start, *chain.after.values()):
        now = {(name, ride.carrier) for name, ride in snapshot.riding.items()}
        sits = {pair: pose for pair, pose in sits.items() if pair in now}
        for rider, carrier in sorted(now):
            on, under = where(told, rider, snapshot), where(told, carrier, snapshot)
            assert on is not None
            assert under is not None
            close(sits.setdefault((rider, carrier), under.inverse() @ on), under.inverse() @ on)
            assert (rider in snapshot.standing) == (carrier in snapshot.standing)


def close(first: Pose, second: Pose) -> None:
    assert math.dist(first.position_m, second.position_m) < 1e-7
    other = tuple(-value for value in second.quaternion)
    assert min(math.dist(first.quaternion, q) for q in (second.quaternion, other)) < 1e-7
