"""A faulty plan, and what fault makers look up in a good one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from random import Random

from tests.motion.verify.maker import Arm, evaluate
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoal, MotionGoalGraph
from xei_lang.ir.timed import JointLimit, TimedGoal, TimedPlan
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


def free_objects(bench: Bench):
    held = {item.object for goal in bench.plan.goals for item in goal.attached}
    named = {name for goal in bench.graph.goals for pair in goal.allowed_contacts for name in pair}
    return [o for o in bench.world.objects if o.geometry and o.name not in held | named]


def base_of(bench: Bench, goal: TimedGoal) -> Pose:
    return next(epoch.T_world_base for epoch in bench.graph.epochs if epoch.index == goal.epoch)


def carries(bench: Bench, goal: TimedGoal) -> bool:
    model = bench.arm.model
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    return all(
        joints.intersection(model.supports[model.frames[model.getFrameId(i.link)].parentJoint])
        for i in goal.attached
    )
