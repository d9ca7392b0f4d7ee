"""What the verifier says: findings, margins, and how much it looked at."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from xei_lang.ir.timed import Margin

FindingKind = Literal[
    "structure",
    "non_finite",
    "goals",
    "schedule",
    "limits",
    "start",
    "jump",
    "position",
    "velocity",
    "acceleration",
    "torque",
    "samples",
    "wrong_goal",
    "linear_path",
    "tool_path",
    "tool_speed",
    "tilt",
    "collision",
    "opening",
    "attachment",
    "placement",
    "grip",
]


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation: what (`subject`: a joint, a pair of bodies, an object), when (plan time, s), and by how
    much.

    `value` and `limit` are in `unit`; a collision's value is the signed distance. Both are 0 where nothing
    was measured.
    """

    kind: FindingKind
    goal_id: str
    step_id: str
    time_s: float
    subject: str
    message: str
    value: float = 0.0
    limit: float = 0.0
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Checked:
    """How much was looked at: goals, seconds of motion, 1 kHz configurations, exact distances between
    bodies."""

    goals: int = 0
    motion_s: float = 0.0
    configurations: int = 0
    distances: int = 0


@dataclass(frozen=True, slots=True)
class VerificationReport:
    """Findings by time, the narrowest margin of each sort, and the counts. No findings: the plan keeps its
    word."""

    findings: tuple[Finding, ...]
    margins: tuple[Margin, ...]
    checked: Checked

    @property
    def ok(self) -> bool:
        """Whether nothing was found."""
        return not self.findings


class Margins:
    """Collects the worst value by name while the checks run: the largest, or the smallest of a clearance."""

    def __init__(self) -> None:
        self._worst: dict[str, Margin] = {}

    def add(self, margin: Margin, smallest: bool = False) -> None:
        """Keep the margin where it is worse than what is kept under its name."""
        kept = self._worst.get(margin.name)
        if kept is None or (margin.value < kept.value if smallest else margin.value > kept.value):
            self._worst[margin.name] = margin

    def all(self) -> tuple[Margin, ...]:
        """The kept margins, by name."""
        return tuple(self._worst[name] for name in sorted(self._worst))
