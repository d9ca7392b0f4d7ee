"""Motion problems whose tools follow stated paths: pours, wipes and turns of what the hand holds, on the
bench.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

from tests.lower.plans import bench, obj, plan, spot
from tests.motion.sequence.bench import DESCRIPTION, goals
from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.timed import TimedGoal, TimedPlan
from xei_lang.ir.tool_paths import Turn
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.verify import RobotDescription, VerificationReport, VerifyOptions, verify_timed
from xei_lang.quantity import quantity


@dataclass(frozen=True)
class Planned:
    """A graph with its plan."""

    graph: MotionGoalGraph
    timed: TimedPlan

    def stated(self, path: str) -> tuple[MotionGoal, TimedGoal]:
        """The first goal on this kind of path, and its motion."""
        goal = next(g for g in self.graph.goals if isinstance(g.action, MoveTo) and g.action.path == path)
        return goal, next(item for item in self.timed.goals if item.id == goal.id)

    def with_goal(self, changed: TimedGoal) -> TimedPlan:
        """The plan with one goal changed, later ones moved in time so that they follow it."""
        found: list[TimedGoal] = []
        later = 0.0
        for goal in self.timed.goals:
            if goal.id == changed.id:
                later = changed.end_s - goal.end_s
                found.append(changed)
            elif later and goal.start_s >= changed.start_s:
                found.append(_later(goal, later))
            else:
                found.append(goal)
        return replace(self.timed, goals=tuple(found), duration_s=self.timed.duration_s + later)


def _later(goal: TimedGoal, by_s: float) -> TimedGoal:
    samples = goal.samples
    if samples is not None:
        samples = replace(samples, times_s=tuple(t + by_s for t in samples.times_s))
    return replace(goal, start_s=goal.start_s + by_s, end_s=goal.end_s + by_s, samples=samples)


def checked(graph: MotionGoalGraph, timed: TimedPlan) -> VerificationReport:
    """What the verifier says of a plan, held to the bench's limits and tilt."""
    profile, world = bench()
    calibration = profile.calibration
    about = RobotDescription(DESCRIPTION.urdf_text, DESCRIPTION.srdf_text)
    options = VerifyOptions(upright_tilt_rad=calibration.spill_tilt_rad)
    return verify_timed(timed, graph, world, about, calibration.limits, options=options)


@cache
def pour() -> Planned:
    """The right hand pours 50 mL from one beaker into another."""
    beaker, target = obj("beaker_3"), obj("beaker_1")
    return _planned(
        goals(
            plan(
                ("pick", {"object": beaker, "arm": "right"}),
                ("pour", {"source": beaker, "target": target, "volume": quantity(50, "mL"), "arm": "right"}),
            ),
            *bench(),
        )
    )


@cache
def wipe() -> Planned:
    """The left hand wipes 100 x 180 mm of the table."""
    size = {"length": quantity(100, "mm"), "width": quantity(180, "mm")}
    cloth, place = obj("wipe_1"), spot("table", "front")
    return _planned(
        goals(
            plan(
                ("pick", {"object": cloth, "arm": "left"}),
                ("wipe", {"object": cloth, "on": place, **size, "arm": "left"}),
            ),
            *bench(),
        )
    )


def turning(angle_deg: float, lead_mm: float) -> MotionGoalGraph:
    """The right hand turns a tube in the air about the tube's own axis, and lifts it by its lead."""
    graph = goals(plan(("pick", {"object": obj("tube_3"), "arm": "right"})), *bench())
    last, family = graph.goals[-1], graph.families[-1]
    at = Pose((0.60, -0.25, 0.90))
    turn = Turn(at.position_m, (0.0, 0.0, 1.0), math.radians(angle_deg), lead_mm / 1000)
    free = MoveTo(ToolTarget(family.id, at), "right", "free", keep_upright=True)
    end = ToolTarget(family.id, turn.end() @ at)
    screw = MoveTo(end, "right", "screw", True, along=turn, tool_turn_rad_s=1.0)
    hold = tuple(pair for pair in last.allowed_contacts if any("openarm" in name for name in pair))
    first = replace(last, id="turn/1", action=free, allowed_contacts=hold)
    second = replace(last, id="turn/2", action=screw, allowed_contacts=hold)
    edges = (*graph.edges, (last.id, "turn/1"), ("turn/1", "turn/2"))
    return replace(graph, goals=(*graph.goals, first, second), edges=edges)


def attempt(graph: MotionGoalGraph) -> tuple[TimedPlan | None, Diagnostics]:
    """Plan on the bench."""
    profile, world = bench()
    return plan_motion(graph, world, profile, DESCRIPTION, 1)


@cache
def screw(angle_deg: float) -> Planned:
    """`turning` planned, with a lead of 3 mm."""
    return _planned(turning(angle_deg, 3.0))


def _planned(graph: MotionGoalGraph) -> Planned:
    timed, problems = attempt(graph)
    assert timed is not None, problems
    return Planned(graph, timed)
