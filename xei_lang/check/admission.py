"""What may be compiled: a plan without gaps, and in strict mode a profile without placeholders."""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.skill_plan import SkillPlan, UnmappedRequest
from xei_lang.profiles.model import Profile


def admit(plan: SkillPlan, profile: Profile, allow_unmapped: bool, strict: bool) -> Diagnostics:
    """One error for each thing that was asked for and cannot be done, and one for each placeholder."""
    gaps = () if allow_unmapped else tuple(_gap(request) for request in plan.unmapped_requests)
    return (*gaps, *(_placeholders(profile) if strict else ()))


def _gap(request: UnmappedRequest) -> Diagnostic:
    return Diagnostic(
        "XEI0240",
        f'"{request.text}" was asked for and is not done',
        request.span,
        label=request.reason or "no skill of this profile does it",
        notes=("rule: a protocol with unmapped requests never runs on hardware",),
        help=("do this step by hand and take the line out, or give --allow-unmapped to compile the rest",),
    )


def _placeholders(profile: Profile) -> Diagnostics:
    return tuple(
        Diagnostic(
            "XEI0241",
            f"`{found.item}` is a placeholder",
            found.span,
            label="not measured yet",
            notes=(f"to measure it: {found.measure}",),
            help=("measure it and write its status, or compile without --strict for simulation",),
        )
        for found in profile.calibration.placeholders
    )
