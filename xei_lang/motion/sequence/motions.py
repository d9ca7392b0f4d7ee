"""A goal with the path it takes, before it has times."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.goals import MotionGoal
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.timed import Placement
from xei_lang.motion.paths.joint_path import JointPath
from xei_lang.motion.sequence.snapshot import Snapshot


@dataclass(frozen=True, slots=True)
class Motion:
    """One goal as it will be carried out. `before` holds while it runs, `after` once it has ended.

    `path` is None for a goal that moves no joint; it then takes `duration_s`.
    """

    goal: MotionGoal
    before: Snapshot
    after: Snapshot
    path: JointPath | None = None
    planner: str = "none"
    duration_s: float = 0.0
    speed_fraction: float = 1.0
    arm: Side | None = None
    placed: tuple[Placement, ...] = ()
    choice: str = ""
