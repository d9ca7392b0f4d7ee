"""Motion problems on the real bench for the tests: goals lowered from hand-made plans, worlds with things
moved about.
"""

from __future__ import annotations

from dataclasses import replace

from tests.lower.plans import FOLDER, bench, obj, plan, put_on_rack, slot, spot, station
from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.lower import lower
from xei_lang.motion.collision import collision_scene
from xei_lang.motion.kinematics import arm_solver
from xei_lang.motion.plan import RobotDescription, plan_motion
from xei_lang.motion.robot import load_robot
from xei_lang.motion.sequence.context import Context, planning_limits
from xei_lang.profiles.model import Profile

__all__ = ["bench", "obj", "plan", "put_on_rack", "slot", "spot", "station"]

URDF = (FOLDER / "robot" / "openarm_mobile.urdf").read_text(encoding="utf-8")
SRDF = (FOLDER / "robot" / "openarm_mobile.srdf").read_text(encoding="utf-8")
DESCRIPTION = RobotDescription(URDF, SRDF)


def goals(steps: SkillPlan, profile: Profile, world: World) -> MotionGoalGraph:
    """The lowered goals of a plan that lowers without a problem."""
    graph, problems = lower(steps, profile, world)
    assert graph is not None, problems
    return graph


def planned(
    steps: SkillPlan, profile: Profile, world: World, seed: int = 1
) -> tuple[TimedPlan | None, Diagnostics]:
    """Lower and plan."""
    return plan_motion(goals(steps, profile, world), world, profile, DESCRIPTION, seed)


def context(profile: Profile, world: World) -> Context:
    """The planning context of the bench."""
    robot = load_robot(URDF, SRDF)
    solvers = {side: arm_solver(robot, side) for side in robot.arms}
    bare = collision_scene(robot, padding_m=profile.calibration.clearance_m)
    return Context(robot, bare, solvers, planning_limits(robot, profile), world, profile, 1)


def moved(world: World, name: str, x_m: float, y_m: float) -> World:
    """The world with an object shifted in its frame."""
    found = world.find(name)
    assert found is not None
    x, y, z = found.T_frame_object.position_m
    there = replace(found, T_frame_object=Pose((x + x_m, y + y_m, z), found.T_frame_object.quaternion))
    return replace(world, objects=tuple(there if item.name == name else item for item in world.objects))


def beside(world: World, name: str, other: str, x_m: float, y_m: float) -> World:
    """The world with an object standing beside another one, on what that one stands on."""
    item, host = world.find(name), world.find(other)
    assert item is not None
    assert host is not None
    x, y, z = host.T_frame_object.position_m
    there = replace(item, frame_id=host.frame_id, T_frame_object=Pose((x + x_m, y + y_m, z)))
    return replace(world, objects=tuple(there if each.name == name else each for each in world.objects))
