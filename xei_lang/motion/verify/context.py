"""What every check is given, and the shortest way for it to say what it found."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoal, MotionGoalGraph
from xei_lang.ir.timed import JointLimit, Margin, TimedGoal, TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.verify.options import RobotDescription, VerifyOptions
from xei_lang.motion.verify.report import Finding, FindingKind, Margins
from xei_lang.motion.verify.robot import Robot
from xei_lang.motion.verify.timeline import Timeline
from xei_lang.profiles.model import PlanningLimit


@dataclass(slots=True)
class Context:
    """The inputs of one verification, the plan as it comes about, and the lists that checks write to."""

    plan: TimedPlan
    graph: MotionGoalGraph
    world: World
    robot: Robot
    about: RobotDescription
    profile_limits: Sequence[PlanningLimit]
    options: VerifyOptions
    timeline: Timeline
    limits: Mapping[str, JointLimit]
    findings: list[Finding] = field(default_factory=list[Finding])
    margins: Margins = field(default_factory=Margins)

    def planned(self, goal: TimedGoal) -> MotionGoal | None:
        """The goal of the graph that this timed goal carries out, or None."""
        return next((item for item in self.graph.goals if item.id == goal.id), None)

    def found(
        self,
        kind: FindingKind,
        goal: TimedGoal,
        time_s: float,
        subject: str,
        message: str,
        *,
        value: float = 0.0,
        limit: float = 0.0,
        unit: str = "",
    ) -> None:
        """Write down a violation."""
        self.findings.append(
            Finding(kind, goal.id, goal.step_id, time_s, subject, message, value, limit, unit)
        )

    def margin(
        self, name: str, value: float, where: str, goal: str, time_s: float, *, smallest: bool = False
    ) -> None:
        """Write down how near something came to its limit."""
        self.margins.add(Margin(name, value, where, goal, time_s), smallest)


def pose_error(a: Pose, b: Pose) -> tuple[float, float]:
    """Distance in m and angle in rad between two poses of one frame.

    The angle comes from the chord between the quaternions (4 asin(chord / 2)), which keeps small angles
    exact.
    """
    opposite = tuple(-value for value in b.quaternion)
    chord = min(math.dist(a.quaternion, b.quaternion), math.dist(a.quaternion, opposite))
    return math.dist(a.position_m, b.position_m), 4.0 * math.asin(min(1.0, 0.5 * chord))
