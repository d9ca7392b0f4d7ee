"""From a goal pose to a timed trajectory, over random tabletop goals, each checked by the verifier.

Run by hand: `python tests/bench/bench_motion.py` (200 goals); `--small` (12 goals) only shows that it still
runs. A goal is a tool pose over the bench's table that some configuration reaches without touching anything;
it is drawn from random configurations, so that one exists, and the arm starts from `ready`. The baseline
solves a tenth of them with one numerical inverse kinematics solution each and then takes the same path
planner and the same timing. Times are CPU times of this thread, after robot and scene are loaded.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tests.motion.sequence.bench import SRDF, URDF, bench, context  # noqa: E402
from xei_lang.diagnostics import Span  # noqa: E402
from xei_lang.ir.families import Family, ToolPose, ToolTarget  # noqa: E402
from xei_lang.ir.geometry import Pose  # noqa: E402
from xei_lang.ir.goals import Epoch, MotionGoal, MotionGoalGraph, MoveTo  # noqa: E402
from xei_lang.ir.timed import TimedGoal, TimedPlan  # noqa: E402
from xei_lang.ir.world import World  # noqa: E402
from xei_lang.motion.kinematics.numerical import NumericalArm  # noqa: E402
from xei_lang.motion.paths.free import FreePath, plan_free_path  # noqa: E402
from xei_lang.motion.robot import SIDES, Side  # noqa: E402
from xei_lang.motion.sequence.ahead import Ahead  # noqa: E402
from xei_lang.motion.sequence.assemble import time_motion  # noqa: E402
from xei_lang.motion.sequence.context import Context  # noqa: E402
from xei_lang.motion.sequence.group import plan_group  # noqa: E402
from xei_lang.motion.sequence.motions import Motion  # noqa: E402
from xei_lang.motion.sequence.poses import matrix, pose_of  # noqa: E402
from xei_lang.motion.sequence.sections import Group, split  # noqa: E402
from xei_lang.motion.sequence.snapshot import Snapshot, first_snapshot  # noqa: E402
from xei_lang.motion.sequence.space import scene_of, space_for  # noqa: E402
from xei_lang.motion.verify import RobotDescription, verify_timed  # noqa: E402

SEED = 7
ABOVE_TABLE_M = (0.02, 0.35)

Plan = Callable[[Context, MotionGoalGraph, Snapshot], TimedGoal | None]


@dataclass
class Row:
    """What one way of planning did: CPU times in ms, how many goals it solved, and how many of these hold."""

    name: str
    times_ms: list[float] = field(default_factory=list)
    durations_s: list[float] = field(default_factory=list)
    verified: int = 0

    def __str__(self) -> str:
        p95 = float(np.percentile(self.times_ms, 95))
        return (
            f"{self.name:<14} solved {len(self.durations_s):>3} of {len(self.times_ms)}, "
            f"verified {self.verified:>3}   median {statistics.median(self.times_ms):6.1f} ms   "
            f"p95 {p95:7.1f} ms   motion {statistics.mean(self.durations_s):.2f} s on average"
        )


def at_ready(world: World, slide_m: float) -> World:
    """The world with the robot in its `ready` posture at a slide height."""
    profile, _ = bench()
    joints = {**dict(world.robot.joints), **dict(profile.robot.state("ready")), "slide_joint": slide_m}
    return replace(world, robot=replace(world.robot, joints=tuple(sorted(joints.items()))))


def random_goals(about: Context, start: Snapshot, count: int) -> list[tuple[Side, Pose]]:
    """Tool poses over the table, of collision-free configurations drawn at the slide height of `start`."""
    random, robot = np.random.default_rng(SEED), about.robot
    scene = scene_of(about, start, ())
    low, high = about.profile.calibration.table_bounds_m
    T_table = matrix(
        (about.world.robot.T_world_base.inverse() @ about.world.T_world_frame("table")).inverse()
    )
    found: list[tuple[Side, Pose]] = []
    while len(found) < count:
        side = SIDES[len(found) % 2]
        columns = list(robot.arm(side).q_indices)
        q = start.q.copy()
        q[columns] = random.uniform(robot.lower[columns], robot.upper[columns])
        T = robot.T_base_frame(q, robot.arm(side).tool_frame)
        x, y, z = (T_table @ T)[:3, 3]
        over = low[0] <= x <= high[0] and low[1] <= y <= high[1] and ABOVE_TABLE_M[0] <= z <= ABOVE_TABLE_M[1]
        if over and not scene.in_collision(q):
            found.append((side, pose_of(T)))
    return found


def graph_of(world: World, side: Side, target: Pose) -> MotionGoalGraph:
    """One free move of the tool to a pose."""
    family = Family("goal", "table", (ToolPose("the pose", Pose()),))
    move = MoveTo(ToolTarget("goal", target), side)
    goal = MotionGoal("goal", "goal", "move_to", move, 0, (f"{side}_arm", "slide"), Span("bench", 0, 0))
    epoch = Epoch(0, world.robot.station, world.robot.T_world_base)
    return MotionGoalGraph((goal,), (), (family,), (epoch,))


def ours(about: Context, graph: MotionGoalGraph, start: Snapshot) -> TimedGoal | None:
    """This project's pipeline: all configurations, the cheapest that holds, path, timing."""
    group = split(graph)[0]
    assert isinstance(group, Group)
    found = plan_group(about, group, start, Ahead())
    if not isinstance(found, tuple):
        return None
    timed = time_motion(about, found[0], 0.0)
    return timed if isinstance(timed, TimedGoal) else None


def numerical(about: Context, graph: MotionGoalGraph, start: Snapshot) -> TimedGoal | None:
    """One numerical solution at the present slide height, then the same planner and the same timing."""
    goal = graph.goals[0]
    assert isinstance(goal.action, MoveTo)
    assert isinstance(goal.action.target, ToolTarget)
    side = goal.action.arm
    assert side is not None
    arm = about.robot.arm(side)
    slide_m = float(start.q[about.robot.slide_index])
    solutions = NumericalArm(about.robot, side).solve(matrix(goal.action.target.T_base_reference), slide_m)
    space = space_for(about, start, arm.joint_names, ())
    for q in solutions.q:
        if not space.is_free(q):
            continue
        found = plan_free_path(space, start.q[list(arm.q_indices)], q, about.goal_seed(goal.id))
        if isinstance(found, FreePath):
            after = start.q.copy()
            after[list(arm.q_indices)] = q
            motion = Motion(
                goal, start, start.moved(after), found.path, found.planner, arm=side, choice="the pose"
            )
            timed = time_motion(about, motion, 0.0)
            return timed if isinstance(timed, TimedGoal) else None
    return None


def holds(about: Context, graph: MotionGoalGraph, start: Snapshot, timed: TimedGoal) -> bool:
    """Whether the verifier finds nothing wrong with the move."""
    names = about.robot.joint_names
    limits = tuple(about.limits[name] for name in names if name in about.limits)
    whole = TimedPlan(
        tuple(zip(names, start.q.tolist(), strict=True)), limits, (timed,), timed.end_s, (), SEED
    )
    report = verify_timed(
        whole, graph, about.world, RobotDescription(URDF, SRDF), about.profile.calibration.limits
    )
    return not report.findings


def measure(row: Row, plan: Plan, about: Context, goals: list[tuple[Side, Pose]], start: Snapshot) -> Row:
    for side, target in goals:
        graph = graph_of(about.world, side, target)
        begin = time.thread_time()
        timed = plan(about, graph, start)
        row.times_ms.append(1e3 * (time.thread_time() - begin))
        if timed is not None:
            row.durations_s.append(timed.end_s - timed.start_s)
            row.verified += holds(about, graph, start, timed)
    return row


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--small", action="store_true", help="12 goals instead of 200")
    count = 12 if parser.parse_args().small else 200
    profile, world = bench()
    world = at_ready(world, profile.calibration.stations[0].slide_m)
    about = context(profile, world)
    start = first_snapshot(about.robot, world)
    goals = random_goals(about, start, count)
    ours(about, graph_of(world, *goals[0]), start)
    row = measure(Row("ours"), ours, about, goals, start)
    print(row)
    print(measure(Row("numerical IK"), numerical, about, goals[: max(10, count // 10)], start))
    return 0 if row.verified == count else 1


if __name__ == "__main__":
    sys.exit(main())
