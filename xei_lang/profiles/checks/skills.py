"""The skill bank against itself and the lab: owners, roles, contracts, phrases and templates."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import get_args

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.ir.goals import GoalKind, PathKind
from xei_lang.profiles.checks.names import OPERATION_PARAMETERS
from xei_lang.profiles.checks.repeats import check_repeats
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.instruments import OWNER
from xei_lang.profiles.model import Profile, SkillSpec, TemplateStep
from xei_lang.profiles.trees import Trees
from xei_lang.syntax import ast

POINTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "object": (
            "pregrasp",
            "aspirate_above",
            "aspirate",
            "dispense_above",
            "dispense",
            "eject",
            "grasp",
            "lift",
            "pour_above",
            "pour_tilt",
            "tap_above",
            "tap",
            "swipe_above",
            "swipe_start",
            "swipe_end",
            "swipe_away",
            "invert_above",
            "inverted",
            "shake_above",
            "shake_left",
            "shake_right",
            "handover_hold",
            "handover_pregrasp",
            "handover_grasp",
            "handover_retreat",
            "hold_pregrasp",
            "hold_grasp",
            "hold_lift",
            "hold_air",
            "hold_above",
            "hold_place",
            "hold_retreat",
        ),
        "cap": (
            "cap_pregrasp",
            "cap_grasp",
            "cap_lift",
            "cap_turned",
            "cap_tightened",
            "cap_back",
            "cap_off",
            "cap_over",
            "cap_on",
            "cap_clear",
        ),
        "Place": (
            "tip_above",
            "tip_on",
            "above",
            "place",
            "retreat",
            "wipe_above",
            "wipe_start",
            "wipe_end",
            "wipe_away",
        ),
    }
)
"""Points of an operation, by the type of the argument that they belong to."""

AXES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"object": ("pour_lip", "invert_axis", "shake_axis"), "cap": ("cap_axis",)}
)
AREAS: Mapping[str, tuple[str, ...]] = MappingProxyType({"Place": ("wipe_area",)})
"""Axes and areas of an operation's stated paths, by the type of the argument that they belong to."""

HEIGHTS: Mapping[str, tuple[str, ...]] = MappingProxyType({"object": ("look_height",), "Station": ("slide",)})
FRAMES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"object": ("ground_frame",), "Station": ("ground_frame",)}
)
"""Heights of the slide and frames to ground that belong to an argument, by its type."""

FIELDS: Mapping[GoalKind, tuple[tuple[str, ...], tuple[str, ...]]] = MappingProxyType(
    {
        "move_to": (
            (),
            (
                "tool",
                "at",
                "path",
                "keep",
                "speed",
                "configuration",
                "axis",
                "angle",
                "lead",
                "area",
                "pitch",
            ),
        ),
        "open_gripper": (("arm", "width"), ()),
        "close_gripper": (("arm", "width"), ()),
        "attach": (("object", "arm"), ()),
        "detach": (("object", "arm", "at"), ()),
        "slide_move": (("height",), ()),
        "nav_to_pose": (("station",), ()),
        "perceive": (("frame",), ()),
        "set_do": (("output", "value"), ()),
        "wait": (("for",), ()),
        "confirm": (("text",), ()),
        "instrument": (("instrument", "command"), ()),
    }
)
"""Fields that a goal of a template must have, and those that it may have."""

LEADS: Mapping[str, str] = MappingProxyType({"cap": "cap", "rest": "Place"})
"""What an argument of type object leads to: `object.cap`, `object.rest`."""

_MINUS = ("", "-")


def check_skills(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Every skill: its owner, the roles that it asks for, the names in its contract, phrases and template."""
    roles = sorted({role for item in profile.objects for role in item.roles})
    for skill in profile.bank.skills:
        if skill.owner not in profile.bank.owners:
            span = trees.of_skill(skill.name, "owner")
            yield unknown("an owner of this profile", skill.owner, profile.bank.owners, span)
        for arg in skill.args:
            names = [node for node in ast.walk(arg.roles) if isinstance(node, ast.Role)] if arg.roles else []
            yield from (
                unknown("a role of any object", role.id, roles, role.span, "XEI0625")
                for role in names
                if role.id not in roles
            )
        yield from _contract(skill)
        yield from _occupied(skill, trees)
        yield from _phrases(skill, trees)
        yield from check_repeats(skill, trees)
        for step in skill.template:
            yield from _fields(skill, step)
            for field, value in step.fields:
                known = _known(profile, skill, step, field) if isinstance(value, str) else None
                if known is not None and str(value).removeprefix(_MINUS[field == "angle"]) not in known:
                    span = trees.of_skill(skill.name, "template", *step.path, step.kind, field)
                    what = f"a `{field}` for the template of `{skill.name}`"
                    yield unknown(what, str(value), known, span, "XEI0623")


def _contract(skill: SkillSpec) -> Iterator[Diagnostic]:
    names = [arg.name for arg in skill.args]
    for rule in (*skill.requires, *skill.ensures):
        for node in ast.walk(rule.predicate):
            if isinstance(node, ast.CallExpr):
                subjects = [arg.value for arg in node.args if isinstance(arg.value, ast.Name)]
                yield from (
                    _no_argument(skill, name.id, names, name.span)
                    for name in subjects
                    if name.id not in names
                )


def _occupied(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """Whether what an instrument holds are arguments of its skill."""
    if skill.occupies_span is not None and skill.owner != OWNER:
        yield Diagnostic(
            "XEI0623",
            f"`{skill.name}` occupies something, and no instrument performs it",
            skill.occupies_span,
            label=f"performed by `{skill.owner}`",
            help=("leave it out; what an arm works with is in its `requires` and `ensures`",),
        )
        return
    names = [arg.name for arg in skill.args if arg.type in ("object", "Place")]
    for index, name in enumerate(skill.occupies):
        if name not in names:
            yield _no_argument(skill, name, names, trees.of_skill(skill.name, "occupies", index))


def _phrases(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    names = [arg.name for arg in skill.args]
    for index, phrase in enumerate(skill.phrases):
        for name in re.findall(r"\{([^{}]*)\}", phrase):
            if name not in names:
                span = trees.of_skill(skill.name, "phrases", index)
                yield _no_argument(skill, name, names, span)
        if re.search(r"[{}]", re.sub(r"\{[^{}]*\}", "", phrase)):
            yield Diagnostic(
                "XEI0623",
                f"`{phrase}` has a brace without its partner",
                trees.of_skill(skill.name, "phrases", index),
                label="expected `{` and `}` around an argument's name",
            )


def _fields(skill: SkillSpec, step: TemplateStep) -> Iterator[Diagnostic]:
    """Whether a goal of a template has the fields that its kind needs, and no others."""
    required, optional = FIELDS[step.kind]
    given = [name for name, _ in step.fields]
    for name in given:
        if name not in (*required, *optional):
            yield unknown(f"a field of `{step.kind}`", name, (*required, *optional), step.span, "XEI0623")
    for name in required:
        if name not in given:
            yield Diagnostic(
                "XEI0623",
                f"`{step.kind}` in the template of `{skill.name}` has no `{name}`",
                step.span,
                label=f"expected `{name}`",
                help=(f"add `{name}: ...`",),
            )
    if step.kind == "move_to" and ("configuration" in given) == ("at" in given):
        yield Diagnostic(
            "XEI0623",
            f"`move_to` in the template of `{skill.name}` needs one target",
            step.span,
            label="expected `at` with `tool`, or `configuration`",
        )


def _known(profile: Profile, skill: SkillSpec, step: TemplateStep, field: str) -> list[str] | None:
    """The words that a field of a template can be; None where any will do."""
    args = {arg.name: arg.type for arg in skill.args}
    objects = [name for name, type_ in args.items() if type_ == "object"]
    led = {**args, **{f"{name}.{word}": kind for name in objects for word, kind in LEADS.items()}}
    states = sorted({state.name for state in profile.robot.states})
    of_type = {
        kind: [name for name, type_ in led.items() if type_ == kind]
        for kind in ("Arm", "object", "cap", "Place", "Station")
    }
    words = {
        "tool": [*of_type["Arm"], *profile.bank.arms],
        "arm": [*of_type["Arm"], *profile.bank.arms],
        "object": [*objects, *of_type["cap"]],
        "instrument": objects,
        "station": [*of_type["Station"], *(station.name for station in profile.calibration.stations)],
        "path": list(get_args(PathKind)),
        "keep": ["upright"],
        "configuration": states,
        "output": list(args),
        "value": list(args),
    }
    if field in ("axis", "area"):
        kinds = AXES if field == "axis" else AREAS
        return _of_args(led, kinds)
    if field in ("speed", "width", "height", "for", "angle", "lead", "pitch"):
        heights = _of_args(args, HEIGHTS) if field == "height" else []
        return [*args, *heights, *OPERATION_PARAMETERS, *(item.name for item in skill.parameters)]
    if field == "at" and step.kind == "detach":
        left = [f"{name}.{word}" for name in objects for word in ("stand", "mouth")]
        return [*of_type["Place"], *of_type["Arm"], *left]
    if field == "at":
        return _of_args(led, POINTS)
    if field == "frame":
        return [*_of_args(args, FRAMES), *(frame.name for frame in profile.calibration.frames)]
    return words.get(field)


def _of_args(args: Mapping[str, str], words: Mapping[str, tuple[str, ...]]) -> list[str]:
    """Each argument with each word that its type has: `object.grasp`."""
    return [f"{name}.{word}" for name, type_ in args.items() for word in words.get(type_, ())]


def _no_argument(skill: SkillSpec, name: str, names: list[str], span: Span) -> Diagnostic:
    return unknown(f"an argument of `{skill.name}`", name, names, span, "XEI0623")
