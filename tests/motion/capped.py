"""The closed bottle of the bench carried: its goals, its plan, and what the verifier says of that."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from tests.lower.capped import BOTTLE, CAP, capped
from tests.motion.sequence.bench import SRDF, URDF, goals, obj, plan, planned, spot
from xei_lang.ir.goals import Detach, MotionGoalGraph
from xei_lang.ir.timed import Attachment, Placement, TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify import Finding, RobotDescription, VerifyOptions, verify_timed

CARRY = plan(
    ("pick", {"object": obj(BOTTLE), "arm": "right"}),
    ("place", {"object": obj(BOTTLE), "on": spot("table", "bottle"), "arm": "right"}),
)


@cache
def carried() -> tuple[TimedPlan, MotionGoalGraph]:
    """The closed bottle picked up, and set down where it stood."""
    profile, world = capped()
    timed, problems = planned(CARRY, profile, world)
    assert timed is not None, problems
    return timed, goals(CARRY, profile, world)


def findings(timed: TimedPlan, graph: MotionGoalGraph, world: World) -> tuple[Finding, ...]:
    """What the verifier finds, held objects upright within the bench's bound."""
    profile, _ = capped()
    options = VerifyOptions(upright_tilt_rad=profile.calibration.spill_tilt_rad)
    limits = profile.calibration.limits
    return verify_timed(timed, graph, world, RobotDescription(URDF, SRDF), limits, options=options).findings


def changed(timed: TimedPlan, goal: TimedGoal) -> TimedPlan:
    """The plan with another goal of the same id."""
    return replace(timed, goals=tuple(goal if item.id == goal.id else item for item in timed.goals))


def cap_of(goal: TimedGoal) -> Attachment:
    """Where a goal says that the cap is carried."""
    return next(item for item in goal.attached if item.object == CAP)


def set_down(timed: TimedPlan, graph: MotionGoalGraph) -> tuple[TimedGoal, Detach]:
    """The goal that leaves the bottle."""
    planned_goal = next(item for item in graph.goals if isinstance(item.action, Detach))
    assert isinstance(planned_goal.action, Detach)
    return next(item for item in timed.goals if item.id == planned_goal.id), planned_goal.action


def placed(goal: TimedGoal) -> dict[str, Placement]:
    """Where a goal leaves things, by name."""
    return {item.object: item for item in goal.placed}
