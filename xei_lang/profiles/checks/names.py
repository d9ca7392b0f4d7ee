"""Names that one file of a profile uses and another declares, and names that two things have."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.grasp_words import ALIASES, CHOICES, parameter_of
from xei_lang.profiles.model import LabObject, OperationDefault, Profile, Tag
from xei_lang.profiles.trees import Trees

OPERATION_PARAMETERS = (
    "air_ahead",
    "air_clearance",
    "alignment_tolerance",
    "approach_height",
    "approach_speed",
    "aspirate_time",
    "cap_depth",
    "cap_lift",
    "cap_open_width",
    "cap_width",
    "dispense_time",
    "eject_height",
    "fill",
    "grasp_depth",
    "grasp_width",
    "hold_open_width",
    "hold_width",
    "insertion_depth",
    "jaw_clearance",
    "lane_pitch",
    "lead",
    "lift",
    "more_strokes",
    "open_width",
    "pour_angle",
    "pour_clearance",
    "pour_height",
    "pour_time",
    "press_force",
    "release_width",
    "rim_clearance",
    "shake_swing",
    "standoff",
    "stroke",
    "stroke_angle",
    "swipe_standoff",
    "tap_standoff",
    "tip_depth",
    "tip_height",
    "tool_point",
    "twist_slide",
    "wipe_height",
)
"""What the planner of operations computes; a skill bank may add its own under `parameters`."""

TAGS = {"tag16h5": 30, "tag25h9": 35, "tag36h11": 587}
"""How many tags the families have; their ids begin with 0."""


def check_names(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
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
        for index, name in enumerate(item.skills):
            if name not in skills:
                yield unknown("a skill of this profile", name, skills, trees.of_object(item, "skills", index))
        for index, role in enumerate(item.slots.accepts if item.slots else ()):
            if role not in roles:
                span = trees.of_object(item, "slots", "accepts", index)
                yield unknown("a role of any object", role, roles, span)
        for spot in item.spots:
            for index, role in enumerate(spot.accepts):
                if role not in roles:
                    span = trees.of_object(item, "spots", spot.name, "accepts", index)
                    yield unknown("a role of any object", role, roles, span)
        yield from _grasp(item, {*parameters, *ALIASES, *CHOICES})
        yield from _states(item, trees)
    yield from _hazards(profile, trees)


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
            if name in seen:
                yield _twice(name, station.span, seen[name], "a station")
    tags: dict[int, Span] = {}
    for tag in profile.calibration.apriltags.tags:
        if tag.id in tags:
            yield _twice(f"tag {tag.id}", tag.span, tags[tag.id], "a tag")
        tags.setdefault(tag.id, tag.span)
        yield from _beyond(tag, profile.calibration.apriltags.family)


def _beyond(tag: Tag, family: str) -> Iterator[Diagnostic]:
    last = TAGS[family] - 1
    if tag.id > last:
        yield Diagnostic(
            "XEI0620",
            f"`{family}` has no tag {tag.id}",
            tag.span,
            label=f"expected an id of 0 .. {last}",
            help=("read the id off the sheet that it was printed from",),
        )


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


def _grasp(item: LabObject, known: set[str]) -> Iterator[Diagnostic]:
    """Keys under `grasp:` that mean nothing, or what another one means."""
    seen: dict[str, OperationDefault] = {}
    for default in item.grasp:
        meant = parameter_of(default.name)
        first = seen.setdefault(meant, default)
        if default.name not in known:
            yield unknown("an operation parameter", default.name, sorted(known), default.span)
        elif first is not default:
            short = next(name for name in (first.name, default.name) if name != meant)
            yield Diagnostic(
                "XEI0606",
                f"`{meant}` is stated twice: `{short}` is short for it",
                default.span,
                label=f"`{default.name}` here",
                labels=(Label(first.span, f"and `{first.name}` here"),),
                help=("leave one of the two out",),
            )


def _states(item: LabObject, trees: Trees) -> Iterator[Diagnostic]:
    for state in item.states:
        if state.initial not in state.values:
            span = trees.of_object(item, "states", state.name, "initial")
            yield unknown(f"a value of the state `{state.name}`", state.initial, state.values, span)


def _hazards(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    known = sorted({hazard for _, hazards in profile.hazards for hazard in hazards})
    for index, pair in enumerate(profile.incompatible):
        for side, name in enumerate(pair):
            if name not in known:
                span = trees.usage.span_of("incompatible", index, side)
                yield unknown("a hazard of any liquid", name, known, span)
