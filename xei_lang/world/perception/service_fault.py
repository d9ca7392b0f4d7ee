"""What can be wrong with a pose service or a pose that it gives, as data that names its representation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.trace import FailedStage, RuntimeFeedback

FaultReason = Literal[
    "unreachable", "dropped", "slow", "busy", "failed", "rejected", "garbage", "too_large", "other_request",
    "other_registry", "no_picture",
]  # fmt: skip
RefusalReason = Literal[
    "not_asked", "missing", "no_object", "low_quality", "service_error", "other_frame", "other_mesh",
    "other_units", "not_rigid", "stale", "from_the_future", "outside_workspace", "out_of_view", "hidden",
    "depth_residual", "mask_overlap",
]  # fmt: skip

_FAULT_CODES = {
    "unreachable": "XEI0690",
    "dropped": "XEI0690",
    "slow": "XEI0691",
    "busy": "XEI0692",
    "failed": "XEI0692",
    "rejected": "XEI0692",
    "garbage": "XEI0693",
    "too_large": "XEI0694",
    "other_request": "XEI0695",
    "other_registry": "XEI0696",
    "no_picture": "XEI0692",
}
_NOT_FOUND = frozenset({"missing", "no_object", "low_quality", "service_error", "out_of_view", "hidden"})

REPRESENTATION: FailedStage = "world_grounding"


@dataclass(frozen=True, slots=True)
class ServiceFault:
    """A service that cannot be used: `reason` for programs, `message` and `help` for people."""

    reason: FaultReason
    message: str
    help: str
    representation: FailedStage = REPRESENTATION

    def diagnostic(self) -> Diagnostic:
        """The fault as it is shown."""
        note = "nothing is grounded by it: no pose is taken from an earlier answer or a guess"
        return Diagnostic(_FAULT_CODES[self.reason], self.message, notes=(note,), help=(self.help,))

    def feedback(self, goal_id: str) -> RuntimeFeedback:
        """The fault as what becomes of a goal that asked for a pose."""
        return RuntimeFeedback(
            goal_id, "failed", self.message, self.representation, "pose service", self.help
        )


@dataclass(frozen=True, slots=True)
class PoseRefused:
    """A pose of one object that is not used."""

    name: str
    reason: RefusalReason
    message: str
    help: str
    representation: FailedStage = REPRESENTATION

    def diagnostic(self) -> Diagnostic:
        """The refusal as it is shown: a warning where the object was not found, an error where it was found
        where it cannot be.
        """
        code = "XEI0699" if self.reason in _NOT_FOUND else "XEI0697"
        return Diagnostic(code, self.message, help=(self.help,))

    def feedback(self, goal_id: str) -> RuntimeFeedback:
        """The refusal as what becomes of a goal that asked for this pose."""
        return RuntimeFeedback(goal_id, "failed", self.message, self.representation, "object pose", self.help)
