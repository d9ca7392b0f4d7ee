"""Grasp: which tool poses may close on an object, how wide the jaws open and close, and how far they stand
off before.
"""

from __future__ import annotations

import math
from typing import NoReturn

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Family, ToolTarget
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.hand import Hand, hand_of
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.grasp_family import (
    MIN_CLEARANCE_M,
    Closing,
    Request,
    closings,
    grasps,
    height_of,
    is_round,
)
from xei_lang.lower.operations.grasp_ways import ELEVATIONS_DEG
from xei_lang.lower.parameters import ROUNDING_M, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import reach_direction
from xei_lang.lower.seats import place_text, seat_of
from xei_lang.lower.walk import Standing
from xei_lang.profiles.model import LabObject
from xei_lang.record import Record, record
from xei_lang.world.places import accepts

_APPROACHES = {"top": (60.0, 90.0), "oblique": (30.0, 45.0, 60.0), "side": (0.0, 30.0)}
_SKILL_CLEARANCE_M = 0.004


@record
class _Widths(Record):
    """The resolved jaw settings."""

    clearance: Setting
    opening: Setting
    closed: Setting


@record
class _Seen(Record):
    """The gripper, the object before the arm, and the level unit vector (x, y) from shoulder to object."""

    hand: Hand
    T_base_object: Pose
    reach: tuple[float, float]


def plan(work: Work) -> Planned:
    """The family of the object that stands there, and the aims `pregrasp` and `grasp`."""
    assert isinstance(work.subject, ObjectRef)
    standing, known = _graspable(work, work.subject.name)
    hand = hand_of(work.profile)
    T_base_object = work.scene.T_base_object(known.name)
    seen = _Seen(hand, T_base_object, reach_direction(work.profile, work.arm, T_base_object))
    closing = _closing(work, known, seen)
    widths = _widths(work, known, closing, hand)
    sunk_m = _sunk(work, standing)
    floor_m, host = _floor(work, known, standing, sunk_m)
    request = _request(work, known, closing, floor_m, seen)
    found = grasps(request)
    if found is None:
        _refuse_family(work, known, host, request)
    family = Family(work.family_id, known.name, found.members, is_round(known.shape))
    standoff = _standoff(work, found.standoff_m)
    settings = [standoff, widths.clearance, widths.opening, widths.closed]
    depth = work.layers.written("grasp_depth")
    back = back_off(family.id, T_base_object, standoff.si("Length"))
    return Planned(
        {item.name: item for item in (*settings, *((depth,) if depth else ()))},
        {
            "pregrasp": Aim(back, ("standoff",)),
            "grasp": Aim(ToolTarget(family.id, T_base_object), ("grasp_depth",), around=known.name),
        },
        family,
        floor_m=sunk_m,
    )


def _graspable(work: Work, name: str) -> tuple[Standing, LabObject]:
    known, standing = work.profile.object(name), work.scene.standing.get(name)
    held = work.scene.held.get(work.arm)
    if held is not None:
        refuse(
            "XEI0708",
            f"the {work.arm} hand cannot grasp `{name}`: it holds `{held.object}`",
            work.span,
            f"expected an empty {work.arm} hand, found `{held.object}` in it",
            (held.since,),
            help=(f"set `{held.object}` down first, or use the other arm",),
        )
    holder = work.scene.holder(name)
    if holder is not None:
        refuse(
            "XEI0708",
            f"the {work.arm} hand cannot grasp `{name}`: the {holder} hand holds it",
            work.span,
            "expected an object that stands somewhere",
            (work.scene.held[holder].since,),
        )
    if known is None or standing is None:
        refuse("XEI0710", f"it is not known where `{name}` stands", work.span, "not in the world")
    _refuse_carrier(work, name)
    return standing, known


def _refuse_carrier(work: Work, name: str) -> None:
    carried = work.scene.carried_by(name)
    if carried:
        first = carried[0]
        refuse(
            "XEI0712",
            f"`{name}` cannot be lifted while `{first.object}` stands on it",
            work.span,
            f"carries {len(carried)} object{'s' if len(carried) > 1 else ''}",
            (first.since,) if first.since else (),
        )


def _closing(work: Work, known: LabObject, seen: _Seen) -> Closing:
    """The way to close that fits the jaws; of two, the one whose jaws open across the way from shoulder to
    object.
    """
    ways, hand = closings(known.shape), seen.hand
    fitting = [way for way in ways if way.width_m + 2 * MIN_CLEARANCE_M <= hand.max_gap_m + 1e-9]
    if not fitting:
        least = min(way.width_m for way in ways)
        refuse(
            "XEI0703",
            f"`{known.name}` is too wide for the gripper",
            work.span,
            f"{_mm(least)} wide where it is narrowest, the jaws open {_mm(hand.max_gap_m)} at most",
            (Label(known.span, f"its shape is {known.computed_from or 'stated here'}"),),
            notes=(f"the jaws must pass an object with {_mm(MIN_CLEARANCE_M)} to spare on each side",),
        )
    (reach_x, reach_y), rotate = seen.reach, seen.T_base_object.rotate

    def across(way: Closing) -> tuple[float, float]:
        heading = way.headings_rad[0]
        x, y, _ = rotate((math.cos(heading), math.sin(heading), 0.0))
        return (-round(abs(x * reach_x + y * reach_y), 3), way.width_m)

    return min(fitting, key=across) if len(fitting) > 1 else fitting[0]


def _widths(work: Work, known: LabObject, closing: Closing, hand: Hand) -> _Widths:
    room_m = (hand.max_gap_m - closing.width_m) / 2
    default = work.layers.skill.get("jaw_clearance")
    wanted_m = default.si("Length") if default else _SKILL_CLEARANCE_M
    clearance = work.layers.written("jaw_clearance")
    if clearance is None and default is not None and wanted_m <= room_m:
        clearance = default
    elif clearance is None:
        rule = f"what {_mm(hand.max_gap_m)} leaves beside {_mm(closing.width_m)}"
        clearance = computed_length("jaw_clearance", min(room_m, wanted_m), rule)
    origin = f", {known.computed_from}" if known.computed_from else ""
    width = f"width of the object between the jaws{origin}"
    closed = work.layers.merge("grasp_width", computed_length("grasp_width", closing.width_m, width))
    assert closed is not None
    rule = f"{_mm(closing.width_m)} and {clearance.text} on each side"
    wide_m = closing.width_m + 2 * clearance.si("Length")
    opening = work.layers.merge("open_width", computed_length("open_width", wide_m, rule))
    assert opening is not None
    for item in (opening, closed):
        if not 0.0 <= item.si("Length") <= hand.max_gap_m + ROUNDING_M:
            refuse(
                "XEI0702",
                f"`{item.name}` of {item.text} is not a gap of this gripper",
                item.span or work.span,
                f"expected 0 mm .. {_mm(hand.max_gap_m)}",
            )
    return _Widths(clearance, opening, closed)


def _sunk(work: Work, standing: Standing) -> float:
    """How deep the object stands in what carries it: from its bottom to the mouth of its slot, metres."""
    host = work.profile.object(standing.support)
    if host is None or host.slots is None or standing.support not in work.scene.standing:
        return 0.0
    mouth_z = host.slots.origin_m[2]
    T_host = work.scene.standing[host.name].T_world_object
    below = mouth_z - T_host.inverse().apply(standing.T_world_object.position_m)[2]
    return max(0.0, below) if standing.place else 0.0


def _floor(work: Work, known: LabObject, standing: Standing, sunk_m: float) -> tuple[float, str]:
    """How far up the object hand and fingers must stay, here and where it is set down next, and which place
    says so.
    """
    deepest, where = sunk_m, standing.place or standing.support
    for ref in work.destinations:
        host = work.profile.object(ref.object)
        seat = seat_of(ref, host) if host and accepts(host, ref, known.roles) else None
        if seat is not None and seat.grid is not None and seat.grid.depth_m > deepest:
            deepest, where = seat.grid.depth_m, place_text(ref)
    return deepest, where


def _request(work: Work, known: LabObject, closing: Closing, floor_m: float, seen: _Seen) -> Request:
    depth, standoff = work.layers.written("grasp_depth"), work.layers.written("standoff")
    return Request(
        height_of(known.shape),
        closing,
        floor_m,
        seen.hand,
        seen.T_base_object,
        seen.reach,
        work.profile.calibration.clearance_m + MIN_CLEARANCE_M,
        _elevations(work),
        depth.si("Length") if depth else None,
        standoff.si("Length") if standoff else math.inf,
    )


def _elevations(work: Work) -> tuple[float, ...]:
    approach = work.layers.written("approach")
    if approach is None:
        return ELEVATIONS_DEG
    if approach.text not in _APPROACHES:
        refuse(
            "XEI0702",
            f"`approach: {approach.text}` is not a way to approach",
            approach.span,
            f"expected one of {', '.join(sorted(_APPROACHES))}",
        )
    return _APPROACHES[approach.text]


def _standoff(work: Work, needed: float) -> Setting:
    """The written standoff, or the greater of the skill's default and what the family needs."""
    default = work.layers.skill.get("standoff")
    if default is not None and default.si("Length") >= needed:
        computed = None
    else:
        needed_mm = math.ceil(needed * 1000)
        computed = computed_length("standoff", needed_mm / 1000, "takes the fingertips clear of the object")
    merged = work.layers.merge("standoff", computed)
    assert merged is not None
    return merged


def _refuse_family(work: Work, known: LabObject, host: str, request: Request) -> NoReturn:
    free = request.height_m - request.floor_m
    refuse(
        "XEI0704",
        f"no grasp of `{known.name}` keeps the hand clear of `{host or 'its support'}`",
        work.span,
        f"{_mm(max(0.0, free))} of it stand free, the hand needs more",
        (Label(known.span, "its shape and its `grasp:` are stated here"),),
        notes=(
            "hand and fingers must stay above what the object stands in, here and where it is set down next",
        ),
    )


def _mm(length_m: float) -> str:
    return f"{round(length_m * 1000, 1):g} mm"


GRASP = Operation(
    "grasp",
    ("pregrasp", "grasp"),
    ("standoff", "jaw_clearance", "open_width", "grasp_width", "grasp_depth"),
    plan,
)
