"""Grasp: which tool poses may close on an object that stands, and how far they stand off before."""

from __future__ import annotations

import math
from typing import NoReturn

from xei_lang.diagnostics import Label
from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.hand import hand_of
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.closing import MIN_CLEARANCE_M, Closing, height_of, is_round
from xei_lang.lower.operations.grasp_family import Request, grasps
from xei_lang.lower.operations.grasp_limits import refuse_written
from xei_lang.lower.operations.grasp_ways import APPROACHES, ELEVATIONS_DEG
from xei_lang.lower.operations.jaws import Seen, jaws_on
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import reach_direction
from xei_lang.lower.seats import place_text, seat_of
from xei_lang.lower.walk import Standing
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import mm
from xei_lang.world.places import accepts


def plan(work: Work) -> Planned:
    """The family of the object that stands there, and the aims `pregrasp` and `grasp`."""
    assert isinstance(work.subject, ObjectRef)
    standing, known = _graspable(work, work.subject.name)
    hand = hand_of(work.profile)
    T_base_object = work.scene.T_base_object(known.name)
    seen = Seen(hand, T_base_object, reach_direction(work.profile, work.arm, T_base_object))
    jaws = jaws_on(work, known, seen)
    sunk_m = _sunk(work, standing)
    floor_m, host = _floor(work, known, standing, sunk_m)
    request = _request(work, known, jaws.closing, floor_m, seen)
    found = grasps(request)
    if found is None:
        refuse_written(work, known, request)
        _refuse_family(work, known, host, request)
    family = Family(work.family_id, known.name, found.members, is_round(known.shape))
    standoff = _standoff(work, found.standoff_m)
    settings = [standoff, jaws.clearance, jaws.opening, jaws.closed]
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
        wide_m=jaws.closing.width_m,
    )


def _graspable(work: Work, name: str) -> tuple[Standing, LabObject]:
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
    known = standing_object(work, name)
    _refuse_carrier(work, name)
    return work.scene.standing[name], known


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


def _request(work: Work, known: LabObject, closing: Closing, floor_m: float, seen: Seen) -> Request:
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
    if approach.text not in APPROACHES:
        refuse(
            "XEI0702",
            f"`approach: {approach.text}` is not a way to approach",
            approach.span,
            f"expected one of {', '.join(sorted(APPROACHES))}",
        )
    return APPROACHES[approach.text]


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
        f"{mm(max(0.0, free))} of it stand free, the hand needs more",
        (Label(known.span, "its shape and its `grasp:` are stated here"),),
        notes=(
            "hand and fingers must stay above what the object stands in, here and where it is set down next",
        ),
    )


GRASP = Operation(
    "grasp",
    ("pregrasp", "grasp"),
    ("standoff", "jaw_clearance", "open_width", "grasp_width", "grasp_depth"),
    plan,
)
