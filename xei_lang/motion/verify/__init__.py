"""The verifier of timed plans. It shares no code with the planner whose plans it checks."""

from __future__ import annotations

from xei_lang.motion.verify.diagnose import to_diagnostics
from xei_lang.motion.verify.durations import check_durations
from xei_lang.motion.verify.options import RobotDescription, VerifyOptions
from xei_lang.motion.verify.report import Checked, Finding, FindingKind, VerificationReport
from xei_lang.motion.verify.verifier import verify_timed

__all__ = [
    "Checked",
    "Finding",
    "FindingKind",
    "RobotDescription",
    "VerificationReport",
    "VerifyOptions",
    "check_durations",
    "to_diagnostics",
    "verify_timed",
]
