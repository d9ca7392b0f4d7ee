"""The plan told again from its knots: phases in which the same goals run, with every joint, held object and
scene.

Joints that no running goal moves hold their last position; mimic joints follow. Objects stand where the
world has them, move with the hand between attach and detach, and stay where the hand was when it let go; what
is fastened on one of them goes with it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, MotionGoal, MotionGoalGraph, NavToPose
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify.evaluate import Array, Motion, grid
from xei_lang.motion.verify.options import RobotDescription
from xei_lang.motion.verify.riders import Riders
from xei_lang.motion.verify.robot import Robot
from xei_lang.motion.verify.stated_links import stated_links

_MERGE_S = 1e-6


@dataclass(frozen=True, slots=True)
class Held:
    """An object in a hand: the link that carries it, where it sits there, and the grasp family that it was
    taken by. Where it `rides_on` another one, the jaws hold that one, and this comes along."""

    object: str
    link: str
    T_link_object: Pose
    side: Side
    family: str
    rides_on: str = ""


@dataclass(frozen=True, slots=True)
class Scene:
    """How things stand at one time: the base's epoch, what is held, where all objects stand in the base
    frame, and what of them is fastened on which other."""

    epoch: int
    held: tuple[Held, ...]
    objects: Mapping[str, Pose]
    riders: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Moment:
    """A goal's start or end as it comes about: the configuration (joints,) and the scene then."""

    time_s: float
    q: Array
    scene: Scene


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch in which the same goals run: 1 kHz times and (times, joints) positions, velocities,
    accelerations.

    `running` are all goals that run, `moving` those with a trajectory. A still phase has one row.
    """

    times: Array
    q: Array
    v: Array
    a: Array
    running: tuple[TimedGoal, ...]
    moving: tuple[TimedGoal, ...]
    scene: Scene
    new_scene: bool


@dataclass(frozen=True, slots=True)
class Timeline:
    """All phases, and for every goal how things stood when it started and when it had ended (attach: once
    attached)."""

    phases: tuple[Phase, ...]
    starts: Mapping[str, Moment]
    ends: Mapping[str, Moment]
    motions: Mapping[str, Motion]


def build_timeline(
    plan: TimedPlan,
    graph: MotionGoalGraph,
    world: World,
    robot: Robot,
    about: RobotDescription,
    *,
    rate_hz: float,
) -> Timeline:
    """Walk through the plan's events in time order. The plan must be structurally sound."""
    return _Walk(plan, graph, world, robot, about, rate_hz=rate_hz).run()


class _Walk:
    def __init__(
        self,
        plan: TimedPlan,
        graph: MotionGoalGraph,
        world: World,
        robot: Robot,
        about: RobotDescription,
        *,
        rate_hz: float,
    ) -> None:
        self.plan, self.robot, self.rate_hz = plan, robot, rate_hz
        self.actions: dict[str, MotionGoal] = {goal.id: goal for goal in graph.goals}
        following = [goal.epoch for goal in graph.goals[1:]]
        last = graph.goals[-1].epoch + 1 if graph.goals else 1
        self.next_epoch = dict(zip((g.id for g in graph.goals), [*following, last], strict=False))
        self.tools = dict(about.tool_links)
        self.q = np.zeros(robot.size)
        for joint, value in plan.start:
            if joint in robot.column:
                self.q[robot.column[joint]] = value
        robot.follow(self.q)
        self.epoch = graph.goals[0].epoch if graph.goals else 0
        bases = {epoch.index: epoch.T_world_base for epoch in graph.epochs}
        self.T_world_base = bases.get(self.epoch, world.robot.T_world_base)
        self.T_world = {item.name: world.T_world_object(item.name) for item in world.objects}
        self.riders = Riders(world, self.T_world)
        self.held: dict[tuple[str, Side], Held] = {}
        self.links = stated_links(plan, robot, self.tools)
        self.motions = {goal.id: Motion.of(goal.knots) for goal in plan.goals if goal.knots is not None}
        self.starts: dict[str, Moment] = {}
        self.ends: dict[str, Moment] = {}
        self.phases: list[Phase] = []
        self.scene = self._scene()
        self.new_scene = True

    def run(self) -> Timeline:
        goals = self.plan.goals
        times = _merged([0.0, *(goal.start_s for goal in goals), *(goal.end_s for goal in goals)])
        for time, after in zip(times, [*times[1:], None], strict=True):
            self._events(time)
            running = [g for g in goals if g.start_s <= time + _MERGE_S and g.end_s > time + _MERGE_S]
            self._phase(time, after, tuple(running))
        return Timeline(tuple(self.phases), self.starts, self.ends, self.motions)

    def _events(self, time: float) -> None:
        ending = [g for g in self.plan.goals if abs(g.end_s - time) <= _MERGE_S]
        for goal in (g for g in ending if g.end_s - g.start_s > _MERGE_S):
            self._end(goal, time)
        for goal in (g for g in self.plan.goals if abs(g.start_s - time) <= _MERGE_S):
            self.starts[goal.id] = Moment(time, self.q.copy(), self.scene)
            if goal.end_s - goal.start_s <= _MERGE_S:
                self._end(goal, time)

    def _end(self, goal: TimedGoal, time: float) -> None:
        if goal.id in self.motions:
            _, (position, _) = self.motions[goal.id].ends()
            for joint, value in zip(goal.joints, position, strict=True):
                if joint in self.robot.column:
                    self.q[self.robot.column[joint]] = value
            self.robot.follow(self.q)
        planned = self.actions.get(goal.id)
        if planned is not None:
            self._act(planned)
        self.ends[goal.id] = Moment(time, self.q.copy(), self.scene)

    def _act(self, goal: MotionGoal) -> None:
        action = goal.action
        if isinstance(action, NavToPose):
            self._let_follow()
            self.epoch = self.next_epoch[goal.id]
            self.T_world_base = action.T_world_base
            self._let_follow()
        elif isinstance(action, Attach) and action.object in self.T_world:
            self._let_follow()
            link = self.links.get((goal.id, action.object, action.arm), self.tools[action.arm])
            T_base_object = self.T_world_base.inverse() @ self.T_world[action.object]
            pose = self.robot.pose(self.q, link).inverse() @ T_base_object
            self.riders.loosen(action.object)
            held = Held(action.object, link, pose, action.arm, action.family)
            self.held[action.object, action.arm] = held
        elif isinstance(action, Detach) and (action.object, action.arm) in self.held:
            self._let_follow()
            del self.held[action.object, action.arm]
            if action.fastened_to:
                self.riders.fasten(action.object, action.fastened_to, self.T_world)
        else:
            return
        self.scene, self.new_scene = self._scene(), True

    def _let_follow(self) -> None:
        for held in self.held.values():
            T_base_object = self.robot.pose(self.q, held.link) @ held.T_link_object
            self.T_world[held.object] = self.T_world_base @ T_base_object
            self.riders.follow(held.object, self.T_world)

    def _scene(self) -> Scene:
        T_base_world = self.T_world_base.inverse()
        objects = {name: T_base_world @ pose for name, pose in self.T_world.items()}
        carried = tuple(item for held in self.held.values() for item in (held, *self._on(held)))
        riders = {name: ride.on for name, ride in self.riders.rides.items()}
        return Scene(self.epoch, carried, objects, riders)

    def _on(self, held: Held) -> tuple[Held, ...]:
        """What comes along on an object in a hand."""
        names = self.riders.above(held.object)
        poses = (held.T_link_object @ self.riders.pose_on(name, held.object) for name in names)
        return tuple(
            replace(held, object=name, T_link_object=pose, rides_on=held.object)
            for name, pose in zip(names, poses, strict=True)
        )

    def _phase(self, time: float, after: float | None, running: tuple[TimedGoal, ...]) -> None:
        moving = tuple(goal for goal in running if goal.id in self.motions)
        if after is not None and moving:
            times = grid(time, after, self.rate_hz)
        elif self.new_scene or (self.phases and self.phases[-1].moving):
            times = np.array([time])
        else:
            return
        q = np.tile(self.q, (len(times), 1))
        v, a = np.zeros_like(q), np.zeros_like(q)
        for goal in moving:
            known = [k for k, joint in enumerate(goal.joints) if joint in self.robot.column]
            columns = [self.robot.column[goal.joints[k]] for k in known]
            rows = self.motions[goal.id].at(times - goal.start_s)
            q[:, columns], v[:, columns], a[:, columns] = (row[:, known] for row in rows)
        self.robot.follow(q)
        self.robot.follow_rates(v)
        self.robot.follow_rates(a)
        self.phases.append(Phase(times, q, v, a, running, moving, self.scene, self.new_scene))
        self.new_scene = False


def _merged(times: list[float]) -> list[float]:
    merged: list[float] = []
    for time in sorted(times):
        if not merged or time - merged[-1] > _MERGE_S:
            merged.append(time)
    return merged
