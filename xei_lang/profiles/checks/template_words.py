"""What the lines of a template may say: fields of each kind of goal, and the words that a field can be."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import chain
from types import MappingProxyType
from typing import get_args

from xei_lang.ir.goals import GoalKind, PathKind
from xei_lang.profiles.checks.operations import OPERATIONS, computed_for
from xei_lang.profiles.model import Profile, SkillSpec, TemplateStep

_KINDS = ("object", "cap", "Place")

POINTS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {kind: tuple(chain(*(item.points for item in OPERATIONS if item.of == kind))) for kind in _KINDS}
)
"""Points of an operation, by the type of the argument that they belong to."""

AXES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {kind: tuple(chain(*(item.axes for item in OPERATIONS if item.of == kind))) for kind in _KINDS}
)
AREAS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {kind: tuple(chain(*(item.areas for item in OPERATIONS if item.of == kind))) for kind in _KINDS}
)
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


def words_of(profile: Profile, skill: SkillSpec, step: TemplateStep, field: str) -> list[str] | None:
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
        computed = computed_for(skill, step, field)
        return [*args, *heights, *computed, *(item.name for item in skill.parameters)]
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
