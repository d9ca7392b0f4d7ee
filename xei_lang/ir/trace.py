"""Trace: an append-only record of every handoff and of the feedback of every goal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

Stage = Literal["scene_setup", "world_state", "planning", "precheck", "execution", "feedback", "end"]
FailedStage = Literal[
    "scene_origin",
    "world_grounding",
    "planner_validation",
    "skill_coverage",
    "operation_parameters",
    "runtime_precheck",
    "safety_validation",
    "executor_routing",
    "hardware_execution",
]


@dataclass(frozen=True, slots=True)
class RuntimeFeedback:
    """What an executor says of one goal once it has tried it.

    Where a representation is to blame, it is named (`object pose`, `frame`, `calibration`), and `help` says
    what to do about it.
    """

    goal_id: str
    status: Literal["succeeded", "failed", "cancelled"]
    message: str = ""
    failed_stage: FailedStage | None = None
    representation: str = ""
    help: str = ""


@dataclass(frozen=True, slots=True)
class TraceEvent:
    """One line of a trace. `t` is the run's own clock in seconds.

    `prev_hash` chains the lines (SHA-256 of the one before).
    """

    seq: int
    t: float
    stage: Stage
    prev_hash: str
    step_id: str
    goal_id: str
    representation: dict[str, Any]
