"""What templates may name of each operation, and what each reads: points, axes, areas and typed parameters.

The planners themselves are in a later room, which a profile cannot ask; a test holds both against each other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from typing import Literal

from xei_lang.profiles.model import SkillSpec, TemplateStep
from xei_lang.record import Record, record

Types = Mapping[str, str]


@record
class OperationWords(Record):
    """An operation by what it works on (`of`), with the types of its parameters: those that it computes,
    those that it `needs` from the call or the skill, those that only the call gives (`called`), and those
    that it `reads` where they are given.
    """

    name: str
    of: Literal["object", "cap", "Place"]
    points: tuple[str, ...]
    parameters: Types
    axes: tuple[str, ...] = ()
    areas: tuple[str, ...] = ()
    needs: Types = field(default_factory=dict[str, str])
    called: Types = field(default_factory=dict[str, str])
    reads: Types = field(default_factory=dict[str, str])


def _lengths(*names: str) -> dict[str, str]:
    return dict.fromkeys(names, "Length")


_GRASP = _lengths("standoff", "jaw_clearance", "open_width", "grasp_width", "grasp_depth")
_AIR = _lengths("air_ahead", "air_clearance")
_DRAWN = _lengths("tip_depth", "rim_clearance", "tool_point")
_VOLUME = {"volume": "Volume"}
_GRASPED = ("pregrasp", "grasp")

OPERATIONS = (
    OperationWords("grasp", "object", _GRASPED, _GRASP),
    OperationWords("lift", "object", ("lift",), _lengths("lift")),
    OperationWords(
        "place",
        "Place",
        ("above", "place", "retreat"),
        _lengths("approach_height", "insertion_depth", "standoff", "jaw_clearance", "release_width"),
    ),
    OperationWords(
        "pour",
        "object",
        ("pour_above", "pour_tilt"),
        {
            **_lengths("pour_clearance", "pour_height"),
            "fill": "Volume",
            "pour_angle": "Angle",
            "pour_time": "Time",
        },
        axes=("pour_lip",),
        reads=_VOLUME,
    ),
    OperationWords(
        "tap", "object", ("tap_above", "tap"), _lengths("tap_standoff"), called={"element": "String"}
    ),
    OperationWords(
        "swipe",
        "object",
        ("swipe_above", "swipe_start", "swipe_end", "swipe_away"),
        _lengths("swipe_standoff"),
        called={"element": "String", "direction": "choice", "distance": "Length"},
    ),
    OperationWords(
        "wipe",
        "Place",
        ("wipe_above", "wipe_start", "wipe_end", "wipe_away"),
        _lengths("lane_pitch", "wipe_height"),
        areas=("wipe_area",),
        called=_lengths("length", "width"),
    ),
    OperationWords(
        "invert",
        "object",
        ("invert_above", "inverted"),
        _AIR,
        axes=("invert_axis",),
        needs={"angle": "Angle"},
    ),
    OperationWords(
        "shake",
        "object",
        ("shake_above", "shake_left", "shake_right"),
        {**_AIR, "shake_swing": "Angle"},
        axes=("shake_axis",),
        needs={"amplitude": "Angle"},
    ),
    OperationWords(
        "give",
        "object",
        ("handover_hold", "handover_retreat"),
        {**_AIR, **_lengths("standoff", "jaw_clearance", "release_width")},
    ),
    OperationWords("take", "object", ("handover_pregrasp", "handover_grasp"), _GRASP, reads=_AIR),
    OperationWords(
        "tip",
        "Place",
        ("tip_above", "tip_on"),
        {"press_force": "Force", **_lengths("alignment_tolerance", "tip_height", "tool_point")},
    ),
    OperationWords(
        "aspirate",
        "object",
        ("aspirate_above", "aspirate"),
        {**_DRAWN, "aspirate_time": "Time"},
        called=_VOLUME,
    ),
    OperationWords(
        "dispense",
        "object",
        ("dispense_above", "dispense"),
        {**_DRAWN, "dispense_time": "Time"},
        called=_VOLUME,
    ),
    OperationWords("eject", "object", ("eject",), _lengths("eject_height")),
    OperationWords(
        "steady",
        "object",
        ("hold_pregrasp", "hold_grasp", "hold_lift", "hold_air", "hold_above", "hold_place", "hold_retreat"),
        _lengths("hold_width", "hold_open_width", "twist_slide"),
        needs=_lengths("lift", "approach_height", "jaw_clearance"),
        reads={**_AIR, "cap_depth": "Length"},
    ),
    OperationWords(
        "cap",
        "cap",
        ("cap_pregrasp", "cap_grasp", "cap_lift"),
        _lengths("cap_width", "cap_open_width", "cap_depth"),
        needs=_lengths("jaw_clearance", "cap_lift"),
    ),
    OperationWords(
        "thread",
        "cap",
        ("cap_turned", "cap_tightened", "cap_back", "cap_off", "cap_over", "cap_on", "cap_clear"),
        {"lead": "Length", "stroke_angle": "Angle", "more_strokes": "Int"},
        axes=("cap_axis",),
        needs={"stroke": "Angle", "cap_lift": "Length"},
        reads=_lengths("cap_depth"),
    ),
)

DIRECTIONS = ("right", "left", "up", "down")
"""The words of a swipe's `direction`."""


def of_line(line: TemplateStep) -> Iterator[tuple[str, OperationWords]]:
    """The operations that a line names, each with the field that names it."""
    for key in ("at", "axis", "area"):
        word = str(line.field(key) or "").rpartition(".")[2]
        for item in OPERATIONS:
            if word in {"at": item.points, "axis": item.axes, "area": item.areas}[key]:
                yield key, item


def of_template(skill: SkillSpec) -> tuple[OperationWords, ...]:
    """The operations that a template names anywhere, each once."""
    return _of_lines(skill.template)


def computed_for(skill: SkillSpec, line: TemplateStep, field: str) -> tuple[str, ...]:
    """The parameters that are computed for a field of a line: by the operations whose points the template
    goes to, or where the field belongs to no arm, by those that the lines before have planned.
    """
    if field in ("for", "height") or (field == "speed" and line.field("tool") is None):
        before = skill.template[: skill.template.index(line)]
        return tuple(name for item in _of_lines(before) for name in item.parameters)
    return _of_points(skill)


def computed_for_times(skill: SkillSpec, line: TemplateStep) -> tuple[str, ...]:
    """The same for how often lines are gone through, of which `line` is the first."""
    one_arm = [arg.type for arg in skill.args].count("Arm") == 1
    before = skill.template[: skill.template.index(line)]
    return _of_points(skill) if one_arm else tuple(name for op in _of_lines(before) for name in op.parameters)


def _of_points(skill: SkillSpec) -> tuple[str, ...]:
    named = [item for line in skill.template for field, item in of_line(line) if field == "at"]
    return tuple(name for item in named for name in item.parameters)


def _of_lines(lines: tuple[TemplateStep, ...]) -> tuple[OperationWords, ...]:
    named = dict.fromkeys(item.name for line in lines for _, item in of_line(line))
    return tuple(item for item in OPERATIONS if item.name in named)
