"""Tap and swipe: the tip of the closed jaws meets an element of a touch screen.

A screen's face is the side of its box that looks along its own -x; elements are given to the right and up
from the face's lower left corner, as one sees it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

from xei_lang.diagnostics import Label, did_you_mean
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Box, Pose, Quaternion, Vec3
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.hand import hand_of, tool_axes
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import Element, LabObject
from xei_lang.quantity.lengths import exact_mm

_ELEVATIONS_DEG = (0.0, 20.0, 40.0, 60.0)
_AZIMUTHS_DEG = (0.0, 20.0, -20.0, 40.0, -40.0)
_STANDOFF_M = 0.05
DIRECTIONS = {"right": (1.0, 0.0), "left": (-1.0, 0.0), "up": (0.0, 1.0), "down": (0.0, -1.0)}


def plan_tap(work: Work) -> Planned:
    """The aims `tap_above` and `tap` at the element that the call names."""
    screen, element = _element(work)
    standoff = _standoff(work, "tap_standoff")
    T_base_element = _at(work, screen, element.center_m)
    family = _family(work, screen)
    touch = ToolTarget(family.id, T_base_element)
    back = ToolTarget(family.id, T_base_element, (0.0, 0.0, 0.0), (0.0, 0.0, -standoff.si("Length")))
    return Planned(
        {standoff.name: standoff},
        {
            "tap_above": Aim(back, (standoff.name,), fingertips=screen.name),
            "tap": Aim(touch, (), fingertips=screen.name),
        },
        family,
    )


def plan_swipe(work: Work) -> Planned:
    """The aims `swipe_above`, `swipe_start`, `swipe_end` and `swipe_away`: along the face, by the distance
    and in the direction of the call.
    """
    screen, element = _element(work)
    standoff = _standoff(work, "swipe_standoff")
    start = element.center_m
    end = _end(work, screen, start)
    T_base_start, T_base_end = _at(work, screen, start), _at(work, screen, end)
    family = _family(work, screen)
    off: Vec3 = (0.0, 0.0, -standoff.si("Length"))
    none: Vec3 = (0.0, 0.0, 0.0)
    poses = {
        "swipe_above": (T_base_start, off),
        "swipe_start": (T_base_start, none),
        "swipe_end": (T_base_end, none),
        "swipe_away": (T_base_end, off),
    }
    aims = {
        name: Aim(ToolTarget(family.id, pose, none, back), (standoff.name,), fingertips=screen.name)
        for name, (pose, back) in poses.items()
    }
    return Planned({standoff.name: standoff}, aims, family)


def _element(work: Work) -> tuple[LabObject, Element]:
    assert isinstance(work.subject, ObjectRef)
    screen = standing_object(work, work.subject.name)
    argument = next((item for item in work.step.args if item.name == "element"), None)
    name = str(argument.value) if argument is not None else ""
    found = next((item for item in screen.elements if item.name == name), None)
    if found is None:
        names = tuple(item.name for item in screen.elements)
        refuse(
            "XEI0720",
            f"`{screen.name}` has no element `{name}`",
            argument.span if argument is not None else work.span,
            f"its elements are {', '.join(f'`{item}`' for item in names) or 'not stated'}",
            (Label(screen.span, "the screen is stated here"),),
            help=tuple(f"did you mean `{near}`?" for near in did_you_mean(name, names)[:1]),
        )
    _, width, height = screen.size_m
    if not (isinstance(screen.shape, Box) and found.is_on(width, height)):
        refuse(
            "XEI0720",
            f"`{name}` is not on the face of `{screen.name}`",
            argument.span if argument is not None else work.span,
            "a touch there would meet the air",
            (Label(found.span, "the element is stated here"), Label(screen.span, "the screen here")),
            help=("correct the element's `center` and `size`, or the screen's `shape`",),
        )
    return screen, found


def _end(work: Work, screen: LabObject, start: tuple[float, float]) -> tuple[float, float]:
    word, length = work.layers.call["direction"], work.layers.call["distance"]
    direction = DIRECTIONS.get(word.text)
    if direction is None:
        refuse(
            "XEI0720",
            f"`{word.text}` is no direction along a screen",
            word.span or work.span,
            f"expected {', '.join(f'`{item}`' for item in DIRECTIONS)}",
        )
    way = length.si("Length")
    end = (start[0] + way * direction[0], start[1] + way * direction[1])
    _, width, height = screen.size_m
    if not (0.0 <= end[0] <= width and 0.0 <= end[1] <= height):
        refuse(
            "XEI0720",
            f"a swipe of {length.text} leaves `{screen.name}`",
            length.span or work.span,
            f"its face is {exact_mm(width)} wide and {exact_mm(height)} high",
            (Label(screen.span, "the screen is stated here"),),
        )
    return end


def _standoff(work: Work, name: str) -> Setting:
    setting = work.layers.merge(name, None) or computed_length(name, _STANDOFF_M, "clear of the screen")
    return setting


def _at(work: Work, screen: LabObject, point: tuple[float, float]) -> Pose:
    """A point of the face in the base frame: x into the screen, z up along it."""
    depth, width, _ = screen.size_m
    return work.scene.T_base_object(screen.name) @ Pose((-depth / 2, width / 2 - point[0], point[1]))


def _family(work: Work, screen: LabObject) -> Family:
    """Ways to point at the face: level or from above, straight or from a side, with the tip of the jaws on
    the point.
    """
    tip = hand_of(work.profile).fingertip_m
    members = [
        ToolPose(name, Pose((-tip * x, -tip * y, -tip * z), quaternion), cost)
        for cost, name, (x, y, z), quaternion in _WAYS
    ]
    return Family(work.family_id, screen.name, tuple(members))


def _ways() -> Iterator[tuple[float, str, Vec3, Quaternion]]:
    """What each way to point costs and is called, the tool's approach and its orientation, in the frame of
    the point.
    """
    for elevation, azimuth, turned in product(_ELEVATIONS_DEG, _AZIMUTHS_DEG, (False, True)):
        heading = (math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth)), 0.0)
        x, y, z = tool_axes(heading, math.radians(elevation), turned)
        name = f"{elevation:g} deg down, azimuth {azimuth:g} deg{', rolled' if turned else ''}"
        cost = round(0.2 * (elevation + abs(azimuth)) / 100.0, 6)
        yield cost, name, z, Pose.from_axes((0.0, 0.0, 0.0), x, y, z).quaternion


_WAYS = sorted(_ways())

TAP = Operation("tap", ("tap_above", "tap"), ("tap_standoff",), plan_tap, called=("element",))
SWIPE = Operation(
    "swipe",
    ("swipe_above", "swipe_start", "swipe_end", "swipe_away"),
    ("swipe_standoff",),
    plan_swipe,
    called=("element", "direction", "distance"),
)
