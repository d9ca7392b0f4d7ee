"""Two small good plans on the bench's robot: one picks a tube from a rack and places it in another, one
tours and drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from tests.motion.verify.maker import Arm, sample, spline, trapezoid
from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive
from xei_lang.ir.goals import (
    Action,
    Attach,
    Detach,
    Epoch,
    Grip,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    SlideMove,
    Wait,
)
from xei_lang.ir.timed import Attachment, JointLimit, Placement, TimedGoal, TimedPlan
from xei_lang.ir.world import RobotState, World, WorldObject
from xei_lang.motion.verify import RobotDescription

FOLDER = Path(__file__).parents[3] / "profiles" / "openarm_bench" / "robot"
RIGHT = [f"openarm_right_joint{k}" for k in range(1, 8)]
LEFT = [f"openarm_left_joint{k}" for k in range(1, 8)]
FINGER = "openarm_right_finger_joint1"
TOOL = "openarm_right_grasp"
HAND = "openarm_right_hand"
FINGERS = ("openarm_right_left_finger", "openarm_right_right_finger")
TUBE_HEIGHT, GRIP_HEIGHT, SLOT_DEPTH = 0.118, 0.085, 0.035

Joints = dict[str, float]


@cache
def robot() -> RobotDescription:
    return RobotDescription(
        (FOLDER / "openarm_mobile.urdf").read_text(encoding="utf-8"),
        (FOLDER / "openarm_mobile.srdf").read_text(encoding="utf-8"),
    )


@cache
def limits() -> tuple[JointLimit, ...]:
    """Planning limits in the manner of the bench's calibration profile: rated torques, modest speeds."""
    from xml.etree import ElementTree

    made: list[JointLimit] = []
    for joint in ElementTree.fromstring(robot().urdf_text).findall("joint"):
        name, bound = str(joint.get("name")), joint.find("limit")
        if bound is None:
            continue
        slide, finger = name == "slide_joint", "finger" in name
        velocity, acceleration = (0.1, 0.5) if slide else (0.2, 2.0) if finger else (2.5, 10.0)
        lower, upper, effort = (float(str(bound.get(key))) for key in ("lower", "upper", "effort"))
        made.append(JointLimit(name, lower, upper, velocity, acceleration, effort))
    return tuple(made)


@dataclass
class Story:
    """Writes goals and their timed counterparts side by side, one after the other on each resource."""

    joints: Joints
    goals: list[MotionGoal] = field(default_factory=list)
    timed: list[TimedGoal] = field(default_factory=list)
    edges: list[tuple[str, str]] = field(default_factory=list)
    attached: tuple[Attachment, ...] = ()
    epoch: int = 0
    clock: float = 0.0

    def move(
        self,
        kind: str,
        action: Action,
        resource: str,
        rows: Sequence[Joints],
        moved: Sequence[str],
        contacts: tuple[tuple[str, str], ...] = (),
        share: float = 0.95,
        beside: bool = False,
        arm: str | None = None,
    ) -> None:
        """A goal with a trajectory through `rows`; `beside` runs it together with the goal before."""
        by_name = {limit.joint: limit for limit in limits()}
        points = np.array([[row[name] for name in moved] for row in rows])
        knots = trapezoid(*spline(points), [by_name[name] for name in moved], share)
        start = self.timed[-1].start_s if beside else self.clock
        samples = sample(knots, start)
        self.joints = {**self.joints, **{name: rows[-1][name] for name in moved}}
        tool = arm_of(robot().urdf_text).tool(self.joints, TOOL) if arm == "right" else None
        end = start + knots.times_s[-1]
        self._add(
            kind, action, resource, start, end, tuple(moved), contacts, samples, knots, tool, arm, beside
        )

    def act(
        self, kind: str, action: Action, resource: str, lasts: float = 0.0, placed: tuple[Placement, ...] = ()
    ) -> None:
        """A goal without a trajectory."""
        self._add(kind, action, resource, self.clock, self.clock + lasts, placed=placed)

    def _add(
        self,
        kind,
        action,
        resource,
        start,
        end,
        joints=(),
        contacts=(),
        samples=None,
        knots=None,
        tool=None,
        arm=None,
        beside=False,
        placed=(),
    ) -> None:
        number = f"g{len(self.goals) + 1:02}"
        step = f"step{len(self.goals) + 1}"
        span = Span("protocols/example.xei", 10 * len(self.goals), 10 * len(self.goals) + 8)
        self.goals.append(MotionGoal(number, step, kind, action, self.epoch, (resource,), span, (), contacts))
        if len(self.goals) > 1 and not beside:
            before = len(self.goals) - 2
            self.edges.append((self.goals[before].id, number))
        attached = self.attached if joints else ()
        self.timed.append(
            TimedGoal(
                number,
                step,
                kind,
                resource,
                (resource,),
                self.epoch,
                start,
                end,
                joints,
                samples,
                knots,
                attached,
                contacts,
                placed,
                arm,
                tool,
            )
        )
        self.clock = max(self.clock, end)

    def finish(
        self, start: Joints, families: tuple[Family, ...], epochs: tuple[Epoch, ...]
    ) -> tuple[TimedPlan, MotionGoalGraph]:
        graph = MotionGoalGraph(tuple(self.goals), tuple(self.edges), families, epochs)
        timed = tuple(sorted(self.timed, key=lambda goal: goal.start_s))
        return TimedPlan(tuple(start.items()), limits(), timed, self.clock, (), 0), graph


@cache
def arm_of(urdf_text: str) -> Arm:
    return Arm(urdf_text)


def all_joints(**given: float) -> Joints:
    zero = {limit.joint: 0.0 for limit in limits() if not limit.joint.endswith("finger_joint2")}
    left = dict(zip(LEFT, (0.8, -0.2, 0.0, 1.8, 0.0, 0.0, 1.0), strict=True))
    right = dict(zip(RIGHT, (-0.8, 0.2, 0.0, 1.8, 0.0, 0.0, -1.0), strict=True))
    return {**zero, **left, **right, "slide_joint": 0.3, **given}


def thing(
    name: str, pose: Pose, geometry: tuple[Primitive, ...], size, mass=0.02, movable=False
) -> WorldObject:
    return WorldObject(name, pose, "world", 1.0, (), (), size, geometry, mass, movable=movable)


def tube(name: str, foot: tuple[float, float, float]) -> WorldObject:
    shape = Primitive(Cylinder(0.0085, TUBE_HEIGHT), Pose((0.0, 0.0, TUBE_HEIGHT / 2)))
    return thing(name, Pose(foot), (shape,), (0.017, 0.017, TUBE_HEIGHT), 0.0215, True)


def block(name: str, foot: tuple[float, float, float], size: tuple[float, float, float]) -> WorldObject:
    return thing(name, Pose(foot), (Primitive(Box(size), Pose((0.0, 0.0, size[2] / 2))),), size, 1.0)


Case = tuple[TimedPlan, MotionGoalGraph, World, RobotDescription]


@cache
def pick_and_place() -> Case:
    """The right arm takes a tube from one rack and puts it into another, while the left arm moves a
    little."""
    arm = arm_of(robot().urdf_text)
    grasp = all_joints(**dict(zip(RIGHT, (0.64, 0.06, 0.19, 0.99, -0.09, -0.40, -0.57), strict=True)))
    T_base_tool = arm.tool(grasp, TOOL)
    x, y, z = T_base_tool.position_m
    foot = (x, y, z - GRIP_HEIGHT)
    place = (x - 0.02, y - 0.14, foot[2])
    table_top = foot[2] - 0.005
    back = tuple(-0.04 * value for value in T_base_tool.axes()[2])
    approach = arm.follow(grasp, RIGHT, TOOL, back, 12)[::-1]
    lift = arm.follow(grasp, RIGHT, TOOL, (0.0, 0.0, 0.05), 12)
    carry = arm.follow(lift[-1], RIGHT, TOOL, (place[0] - x, place[1] - y, 0.0), 12)
    lower = arm.follow(carry[-1], RIGHT, TOOL, (0.0, 0.0, -0.05), 12)
    retreat = arm.follow(lower[-1], RIGHT, TOOL, back, 12)
    family = Family(
        "tube_1_grasps",
        "tube_1",
        (
            ToolPose("other side", Pose((0.0, 0.0, 0.05))),
            ToolPose("as it is", Pose(foot).inverse() @ T_base_tool),
        ),
        symmetric=True,
    )
    fingers = tuple(("tube_1", finger) for finger in FINGERS)
    in_rack, in_slot = (*fingers, ("tube_1", "rack_1")), (*fingers, ("tube_1", "rack_2"))

    def to(
        reference: tuple[float, float, float], path="linear", **offsets: tuple[float, float, float]
    ) -> MoveTo:
        return MoveTo(ToolTarget(family.id, Pose(reference), **offsets), "right", path)

    def jaws(story: Story, gap: float, kind: str, contacts: tuple[tuple[str, str], ...]) -> None:
        rows = [story.joints, {**story.joints, FINGER: gap / 2}]
        story.move(kind, Grip("right", gap), "right_gripper", rows, [FINGER], contacts)

    start = approach[0]
    story = Story(dict(start))
    jaws(story, 0.036, "open_gripper", ())
    story.move("move_to", to(foot), "right_arm", approach, RIGHT, fingers, arm="right")
    near = {**story.joints, "openarm_left_joint4": 1.6, "openarm_left_joint7": 0.8}
    left = MoveTo(JointTarget("aside", tuple((name, near[name]) for name in LEFT)), "left")
    story.move("move_to", left, "left_arm", [story.joints, near], LEFT, beside=True)
    jaws(story, 0.017, "close_gripper", fingers)
    story.act("attach", Attach("tube_1", "right", family.id), "right_gripper")
    T_hand_tool = arm.tool(grasp, HAND).inverse() @ T_base_tool
    story.attached = (Attachment("tube_1", HAND, T_hand_tool @ T_base_tool.inverse() @ Pose(foot)),)
    up = {"offset_base_m": (0.0, 0.0, 0.05)}
    story.move("move_to", to(foot, **up), "right_arm", lift, RIGHT, in_rack, arm="right")
    story.move("move_to", to(place, "free", **up), "right_arm", carry, RIGHT, arm="right")
    story.move("move_to", to(place), "right_arm", lower, RIGHT, in_slot, arm="right")
    jaws(story, 0.036, "open_gripper", fingers)
    story.attached = ()
    put = Detach("tube_1", "right", 'rack_2.slot("A1")', Pose(place))
    story.act("detach", put, "right_gripper", placed=(Placement("tube_1", Pose(place)),))
    off = {"offset_tool_m": (0.0, 0.0, -0.04)}
    story.move("move_to", to(place, **off), "right_arm", retreat, RIGHT, fingers, arm="right")
    plan, graph = story.finish(start, (family,), (Epoch(0, "bench_a", Pose()),))
    objects = (
        block("rack_1", (x, y, table_top), (0.10, 0.08, 0.04)),
        block("rack_2", (place[0], place[1], table_top), (0.10, 0.08, 0.04)),
        block("table", (x + 0.25, y, table_top - 0.03), (0.8, 1.2, 0.03)),
        tube("tube_1", foot),
        tube("tube_2", (x + 0.03, y + 0.09, foot[2])),
    )
    return plan, graph, World((), objects, RobotState((), "bench_a", Pose())), robot()


@cache
def tour() -> Case:
    """Arms and slide move, the base drives to another bench, the arms move there."""
    start = all_joints()
    story = Story(dict(start))
    named = {
        "aside": dict(zip(RIGHT, (-0.7, 0.4, 0.3, 1.9, 0.3, 0.0, -0.9), strict=True)),
        "transport": {name: start[name] for name in RIGHT},
    }

    def right(name: str) -> None:
        rows = [story.joints, {**story.joints, **named[name]}]
        target = JointTarget(name, tuple(named[name].items()))
        story.move("move_to", MoveTo(target, "right"), "right_arm", rows, RIGHT)

    def slide(height: float) -> None:
        rows = [story.joints, {**story.joints, "slide_joint": height}]
        story.move("slide_move", SlideMove(height), "slide", rows, ["slide_joint"])

    right("aside")
    slide(0.31)
    story.act("wait", Wait(0.2), "person", 0.2)
    right("transport")
    T_world_base = Pose.from_rpy((0.0, 3.0, 0.0), (0.0, 0.0, 1.0))
    story.act("nav_to_pose", NavToPose("bench_b", T_world_base, 0.05, 0.1), "base", 2.0)
    story.epoch = 1
    right("aside")
    slide(0.30)
    epochs = (Epoch(0, "bench_a", Pose()), Epoch(1, "bench_b", T_world_base))
    plan, graph = story.finish(start, (), epochs)
    objects = (
        block("table", (0.95, 0.0, 0.72), (0.6, 1.2, 0.03)),
        thing(
            "table_b",
            T_world_base @ Pose((0.95, 0.0, 0.72)),
            (Primitive(Box((0.6, 1.2, 0.03)), Pose((0.0, 0.0, 0.015))),),
            (0.6, 1.2, 0.03),
        ),
    )
    return plan, graph, World((), objects, RobotState((), "bench_a", Pose())), robot()
