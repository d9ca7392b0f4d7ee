"""Findings as diagnostics: the step's own words, the goal, joint or bodies, the time, the value against its
limit."""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span
from xei_lang.ir.goals import MotionGoalGraph
from xei_lang.motion.verify.report import Finding, FindingKind, VerificationReport

CODES: Mapping[FindingKind, str] = {
    "structure": "XEI0850",
    "non_finite": "XEI0851",
    "goals": "XEI0852",
    "schedule": "XEI0853",
    "position": "XEI0854",
    "velocity": "XEI0855",
    "acceleration": "XEI0856",
    "torque": "XEI0857",
    "jump": "XEI0858",
    "samples": "XEI0859",
    "wrong_goal": "XEI0860",
    "linear_path": "XEI0861",
    "collision": "XEI0862",
    "attachment": "XEI0863",
    "placement": "XEI0864",
    "limits": "XEI0865",
    "tilt": "XEI0866",
    "start": "XEI0867",
    "tool_path": "XEI0868",
    "tool_speed": "XEI0869",
    "opening": "XEI0870",
    "grip": "XEI0871",
}


def to_diagnostics(report: VerificationReport, graph: MotionGoalGraph) -> Diagnostics:
    """One diagnostic a finding, at the span of the step that the goal came from."""
    spans = {goal.id: goal.span for goal in graph.goals}
    return tuple(_diagnostic(finding, spans) for finding in report.findings)


def _diagnostic(finding: Finding, spans: Mapping[str, Span]) -> Diagnostic:
    of = f"step `{finding.step_id}`: " if finding.step_id else ""
    measured = _measured(finding)
    notes = [f"goal `{finding.goal_id}` at {finding.time_s:.4g} s"] if finding.goal_id else []
    return Diagnostic(
        CODES[finding.kind],
        of + finding.message,
        spans.get(finding.goal_id),
        label=measured or finding.message,
        notes=(*notes, "found by the verifier, which shares no code with the planner"),
    )


def _measured(finding: Finding) -> str:
    if finding.value == 0.0 and finding.limit == 0.0:
        return ""
    unit = f" {finding.unit}" if finding.unit else ""
    if finding.kind == "collision":
        found, wanted = f"{finding.value * 1e3:.3g} mm", f"{finding.limit * 1e3:.3g} mm"
        return f"`{finding.subject}`: distance {found}, expected more than {wanted}"
    if finding.kind == "opening":
        found, wanted = f"{finding.value * 1e3:.2f} mm", f"{finding.limit * 1e3:.2f} mm"
        return f"`{finding.subject}`: expected within {wanted}, found {found}"
    return f"`{finding.subject}`: expected {finding.limit:.6g}{unit}, found {finding.value:.6g}{unit}"
