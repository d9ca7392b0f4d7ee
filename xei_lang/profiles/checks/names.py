"""Names that one file of a profile uses and another declares, and names that two things have."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import LabObject, Profile

OPERATION_PARAMETERS = (
    "approach_height",
    "approach_speed",
    "grasp_depth",
    "grasp_width",
    "insertion_depth",
    "jaw_clearance",
    "lift",
    "open_width",
    "release_width",
    "standoff",
)
"""What the planner of operations computes; a skill bank may add its own under `parameters`."""


def check_names(profile: Profile) -> Iterator[Diagnostic]:
    """Roles, skills, states and operation parameters that objects name; names and aliases that are not
    unique.
    """
    yield from _unique(profile)
    roles = sorted({role for item in profile.objects for role in item.roles})
    skills = [skill.name for skill in profile.bank.skills]
    parameters = {
        *OPERATION_PARAMETERS,
        *(item.name for skill in profile.bank.skills for item in skill.parameters),
    }
    for item in profile.objects:
        yield from (unknown("a skill", name, skills, item.span) for name in item.skills if name not in skills)
        accepts = item.slots.accepts if item.slots else ()
        span = item.slots.span if item.slots else item.span
        yield from (
            unknown("a role of any object", role, roles, span) for role in accepts if role not in roles
        )
        for default in item.grasp:
            if default.name not in parameters:
                yield unknown("an operation parameter", default.name, sorted(parameters), default.span)
        yield from _states(item)
    yield from _hazards(profile)


def _unique(profile: Profile) -> Iterator[Diagnostic]:
    seen: dict[str, Span] = {}
    for item in profile.objects:
        for name in (item.name, *item.aliases):
            if name in seen:
                yield _twice(name, item.span, seen[name], "an object")
            seen.setdefault(name, item.span)
    stations: dict[str, Span] = {}
    for station in profile.calibration.stations:
        for name in (station.name, *station.aliases):
            if name in stations:
                yield _twice(name, station.span, stations[name], "a station")
            stations.setdefault(name, station.span)


def _twice(name: str, span: Span, first: Span, what: str) -> Diagnostic:
    return Diagnostic(
        "XEI0621",
        f"`{name}` names two things",
        span,
        label=f"names {what} here",
        labels=(Label(first, "and another one here"),),
        notes=("names and aliases must be unique, because protocols and requests choose by them",),
        help=("rename one of the two",),
    )


def _states(item: LabObject) -> Iterator[Diagnostic]:
    for state in item.states:
        if state.initial not in state.values:
            yield unknown(f"a value of the state `{state.name}`", state.initial, state.values, state.span)


def _hazards(profile: Profile) -> Iterator[Diagnostic]:
    known = sorted({hazard for _, hazards in profile.hazards for hazard in hazards})
    for pair in profile.incompatible:
        for name in pair:
            if name not in known:
                shown = ", ".join(f"`{hazard}`" for hazard in known)
                yield Diagnostic(
                    "XEI0620",
                    f"no liquid of this profile has the hazard `{name}`",
                    help=(f"hazards of liquids are {shown}",),
                )
