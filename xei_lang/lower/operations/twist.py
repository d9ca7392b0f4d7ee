"""Twist: a hand over a cap takes it, turns it stroke by stroke along its thread, and carries it.

Threads are right-handed: turned to the left, seen from above, a cap rises by its lead. Between two strokes
the jaws open and the hand turns back about the same axis, round the cap, which stays where it is.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.families import Family, Members, ToolTarget, Turned
from xei_lang.ir.geometry import Pose
from xei_lang.ir.tool_paths import Turn
from xei_lang.lower.hand import hand_of, tool_axes
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Axis, Operation, Planned, Work
from xei_lang.lower.operations.cap_place import refuse_elsewhere
from xei_lang.lower.operations.caps import (
    Cap,
    depth_on_cap,
    raised,
    strokes_of,
    subject_cap,
    up,
)
from xei_lang.lower.operations.round_jaws import round_jaws
from xei_lang.lower.parameters import computed_length

_ELEVATIONS_DEG = (90.0, 75.0, 60.0)
_ELEVATION_COSTS = {90.0: 0.0, 75.0: 0.02, 60.0: 0.1}
"""Steeper hands keep clear of the one that holds the vessel."""
_HEADINGS = 24
_LEAST_CLEARANCE_M = 0.001
_BACK_M = 0.010


def plan_cap(work: Work) -> Planned:
    """The family of hands over the cap where it is now, and the aims `cap_pregrasp`, `cap_grasp` and
    `cap_lift`.
    """
    cap, hand = subject_cap(work), hand_of(work.profile)
    refuse_elsewhere(work, cap)
    depth = depth_on_cap(work, cap, hand.fingertip_m)
    widths = round_jaws(work, cap.known, hand, "cap", "cap")
    members = cap_members(cap, depth.si("Length"))
    family = Family(work.family_id, cap.known.name, members, True)
    standoff = computed_length(
        "standoff", depth.si("Length") + hand.fingertip_m + _BACK_M, "takes the fingertips clear of the cap"
    )
    lift = work.layers.merge("cap_lift", None)
    assert lift is not None
    T_base_cap = work.scene.in_base(work.scene.T_world_of(cap.known.name))
    z = up(T_base_cap)
    riding = bool(work.scene.carrier_of(cap.known.name))
    lifted = tuple(value * lift.si("Length") for value in z)
    back = back_off(family.id, T_base_cap, standoff.si("Length"))
    settings = (depth, *widths, standoff, lift)
    return Planned(
        {item.name: item for item in settings},
        {
            "cap_pregrasp": Aim(back, ("standoff",), slide_stays=riding),
            "cap_grasp": Aim(
                ToolTarget(family.id, T_base_cap), ("cap_depth",), around=cap.known.name, slide_stays=riding
            ),
            "cap_lift": Aim(
                ToolTarget(family.id, T_base_cap, (lifted[0], lifted[1], lifted[2])), ("cap_lift",)
            ),
        },
        family,
    )


def cap_members(cap: Cap, depth_m: float) -> Members:
    """Hands over a cap: elevation x heading x roll, the grasp point `depth_m` under its top."""
    point = ("", (0.0, 0.0, cap.known.size_m[2] - depth_m))
    return Members([(cost, turned, point) for cost, turned in _WAYS])


def _ways() -> Iterator[tuple[float, Turned]]:
    for elevation in _ELEVATIONS_DEG:
        for k in range(_HEADINGS):
            azimuth = k * 360.0 / _HEADINGS
            level = (math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth)), 0.0)
            for turned in (False,) if elevation == 90.0 else (False, True):
                x, y, z = tool_axes(level, math.radians(elevation), turned)
                kind = "straight down" if elevation == 90.0 else f"{elevation:g} deg down"
                name = f"on the cap, {kind}, azimuth {azimuth:g} deg{', rolled' if turned else ''}"
                quaternion = Pose.from_axes((0.0, 0.0, 0.0), x, y, z).quaternion
                yield _ELEVATION_COSTS[elevation], (name, quaternion)


_WAYS = sorted(_ways())
"""What each way to take a cap costs, its words and the tool's orientation in the cap's frame."""


def plan_thread(work: Work) -> Planned:
    """What the thread asks for from where the cap is now: the aims `cap_turned` and `cap_tightened`, one
    stroke up or down in the hand; `cap_back`, the open hand turned back; `cap_off`, lifted off; `cap_over`
    and `cap_on`, over the mouth and where the thread begins; `cap_clear`, the open hand backed off after the
    last stroke. All about `cap_axis`.
    """
    cap = subject_cap(work)
    settings = strokes_of(work, cap)
    lift = work.layers.merge("cap_lift", None)
    assert lift is not None
    angle, lift_m = settings["stroke_angle"].si("Angle"), lift.si("Length")
    T_base_seat = work.scene.in_base(work.scene.T_world_of(cap.vessel.name)) @ cap.T_vessel_seat
    T_base_cap = work.scene.in_base(work.scene.T_world_of(cap.known.name))
    axis = Axis(T_base_seat.position_m, up(T_base_seat))
    hand = hand_of(work.profile)
    depth_m = depth_on_cap(work, cap, hand.fingertip_m).si("Length")

    def turned(sign: float, lead_m: float) -> Pose:
        return Turn(axis.point_m, axis.direction, sign * angle, lead_m).end() @ T_base_cap

    def aim(T_base_reference: Pose, *uses: str, over_m: float = 0.0, lies: bool = True) -> Aim:
        z = (axis.direction[0] * over_m, axis.direction[1] * over_m, axis.direction[2] * over_m)
        target = ToolTarget(work.family_id, T_base_reference, z, turn_reference=True)
        there = work.scene.epoch.T_world_base @ Pose(z) @ T_base_reference
        touches = cap.vessel.name if over_m == 0.0 else ""
        return Aim(target, uses, support=touches, slide_stays=True, T_world_held=there if lies else None)

    begun = raised(T_base_seat, cap.rise_m)
    lead_m = cap.thread.lead_m
    aims = {
        "cap_turned": aim(turned(1.0, lead_m)),
        "cap_tightened": aim(turned(-1.0, lead_m)),
        "cap_off": aim(T_base_cap, "cap_lift", over_m=lift_m),
        "cap_over": aim(begun, "cap_lift", over_m=lift_m),
        "cap_on": aim(begun),
        "cap_back": Aim(
            ToolTarget(work.family_id, T_base_cap, turn_reference=True),
            (),
            around=cap.known.name,
            slide_stays=True,
        ),
        "cap_clear": Aim(
            back_off(work.family_id, turned(-1.0, 0.0), depth_m + hand.fingertip_m + _BACK_M, True),
            (),
            slide_stays=True,
        ),
    }
    return Planned({**settings, "cap_lift": lift}, aims, axes={"cap_axis": axis})


CAP = Operation(
    "cap",
    ("cap_pregrasp", "cap_grasp", "cap_lift"),
    ("cap_width", "cap_open_width", "cap_depth"),
    plan_cap,
    of="cap",
    needs=("jaw_clearance", "cap_lift"),
)
THREAD = Operation(
    "thread",
    ("cap_turned", "cap_tightened", "cap_back", "cap_off", "cap_over", "cap_on", "cap_clear"),
    ("lead", "stroke_angle", "more_strokes"),
    plan_thread,
    axes=("cap_axis",),
    fresh=True,
    of="cap",
    needs=("stroke", "cap_lift"),
)
