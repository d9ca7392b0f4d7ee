"""From goals to a timed plan: the entry to motion planning.

The goal sequence is cut at its fixed anchors; between them configurations are chosen together
(`sequence/group.py`), then every path is put on a clock (`sequence/assemble.py`). Everything is a pure
function of the arguments: searches stop on counts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.collision import collision_scene
from xei_lang.motion.kinematics import Solver, arm_solver
from xei_lang.motion.robot import Robot, load_robot
from xei_lang.motion.sequence.assemble import RATE_HZ
from xei_lang.motion.sequence.blame import blame_group
from xei_lang.motion.sequence.blame_carry import blame_carry
from xei_lang.motion.sequence.context import Context, planning_limits
from xei_lang.motion.sequence.course import Course
from xei_lang.motion.sequence.failure import BlockedTransit, Failure, Unplaced
from xei_lang.motion.sequence.margins import margins
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.refuse import refuse
from xei_lang.motion.sequence.sections import split
from xei_lang.motion.sequence.snapshot import Snapshot, first_snapshot
from xei_lang.profiles.model import Profile

Progress = Callable[[int, int], None]
"""Called with how many goals are planned and how many there are."""


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """The texts of the robot's URDF and SRDF."""

    urdf_text: str
    srdf_text: str


@dataclass(frozen=True, slots=True)
class Refused:
    """A graph that cannot be planned: why, and at which of its goals."""

    diagnostic: Diagnostic
    goal: int


def plan_motion(
    graph: MotionGoalGraph,
    world: World,
    profile: Profile,
    description: RobotDescription,
    seed: int,
    progress: Progress | None = None,
) -> tuple[TimedPlan | None, Diagnostics]:
    """Plan and time every goal of the graph, starting from the world's robot state.

    Returns the plan, or None and what stands in its way, with the goal's place in the protocol. Equal
    arguments give equal plans, to the byte.
    """
    found = attempt(graph, world, profile, description, seed, progress)
    return (None, (found.diagnostic,)) if isinstance(found, Refused) else (found, ())


def attempt(
    graph: MotionGoalGraph,
    world: World,
    profile: Profile,
    description: RobotDescription,
    seed: int,
    progress: Progress | None = None,
) -> TimedPlan | Refused:
    """`plan_motion`, with the goal at which it failed.

    Where a hand finds no grasp on what the other one holds out, planning goes back once to where that one
    took it, and chooses the two grasps together.
    """
    context = _context(world, profile, description, seed)
    parts = split(graph)
    start = first_snapshot(context.robot, world)
    problem = refuse(context, graph)
    if problem is not None:
        return _refused(graph, problem, 0)
    course = Course(context, parts, start)
    while course.index < len(parts):
        failed = course.advance()
        if isinstance(failed, (Unplaced, BlockedTransit)) and course.go_back(failed):
            continue
        if failed is not None:
            reason, planned = course.told(failed)
            said = reason if isinstance(reason, Diagnostic) else _blame(context, reason)
            return _refused(graph, said, planned)
        if progress is not None:
            progress(len(course.timed), len(graph.goals))
    return _plan(context, start, tuple(course.motions), tuple(course.timed))


def _blame(context: Context, failure: Failure) -> Diagnostic:
    return blame_carry(context, failure) or blame_group(context, failure)


def _refused(graph: MotionGoalGraph, diagnostic: Diagnostic, planned: int) -> Refused:
    """The refusal, at the first goal of its words among those that were not planned yet."""
    later = range(planned, len(graph.goals))
    return Refused(diagnostic, next((i for i in later if graph.goals[i].span == diagnostic.span), planned))


def _context(world: World, profile: Profile, description: RobotDescription, seed: int) -> Context:
    robot = load_robot(description.urdf_text, description.srdf_text)
    robot = robot.narrowed(planning_limits(robot, profile))
    solvers: dict[Side, Solver] = {side: arm_solver(robot, side) for side in robot.arms}
    bare = collision_scene(robot, padding_m=profile.calibration.clearance_m)
    return Context(robot, bare, solvers, planning_limits(robot, profile), world, profile, seed)


def _plan(
    context: Context, start: Snapshot, motions: tuple[Motion, ...], goals: tuple[TimedGoal, ...]
) -> TimedPlan:
    robot: Robot = context.robot
    return TimedPlan(
        start=tuple(zip(robot.joint_names, start.q.tolist(), strict=True)),
        limits=tuple(context.limits[name] for name in robot.joint_names if name in context.limits),
        goals=goals,
        duration_s=goals[-1].end_s if goals else 0.0,
        margins=margins(context, motions, goals),
        seed=context.seed,
        rate_hz=RATE_HZ,
        solvers=tuple((side, context.solvers[side].name) for side in sorted(context.solvers)),
    )
