"""Invert and shake: a closed vessel in the hand turns about a level axis through its middle, and back.

A hand that holds the vessel from the side, its approach along the axis, turns mostly about its last joint,
and what that lacks the elbow gives. So the axis leads away from the robot, towards its middle, and the top
tips outwards: of 152 grasps of a tube in a rack 16 then turn it by 180 degrees, with the axis straight ahead
of the shoulder 9, inwards hardly any.
"""

from __future__ import annotations

import math
from fractions import Fraction

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Vec3
from xei_lang.ir.skill_plan import ObjectRef, Side
from xei_lang.ir.tool_paths import Turn
from xei_lang.lower.operations.base import Aim, Axis, Operation, Planned, Work
from xei_lang.lower.operations.held import held_upright, in_hand
from xei_lang.lower.operations.in_air import room_in_air
from xei_lang.lower.operations.state_before import CAP, cap_of
from xei_lang.lower.parameters import Setting
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject
from xei_lang.quantity import quantity

_INWARDS_RAD = math.radians(30.0)

Angles = dict[str, float]


def plan_invert(work: Work) -> Planned:
    """The aims `invert_above`, the vessel upright in the air, and `inverted`, turned by the call's `angle`;
    both about the axis `invert_axis`.
    """
    angle = work.layers.merge("angle", None)
    assert angle is not None
    return _plan(work, "invert_axis", angle, {"invert_above": 0.0, "inverted": angle.si("Angle")})


def plan_shake(work: Work) -> Planned:
    """The aims `shake_above`, the vessel upright in the air, and `shake_left` and `shake_right`, tilted to
    both sides by the call's `amplitude`; all about the axis `shake_axis`.
    """
    tilt = work.layers.merge("amplitude", None)
    assert tilt is not None
    angle = tilt.si("Angle")
    angles = {"shake_above": 0.0, "shake_left": angle, "shake_right": -angle}
    swing = Setting(
        "shake_swing", quantity(_degrees(2 * angle), "deg"), "computed", "twice the amplitude", None
    )
    return _plan(work, "shake_axis", tilt, angles, swing)


def _axis(arm: Side) -> Vec3:
    """The level direction of the axis in the base frame: by the right-hand rule the top tips outwards."""
    x, y = math.cos(_INWARDS_RAD), math.sin(_INWARDS_RAD)
    return (x, y, 0.0) if arm == "right" else (-x, y, 0.0)


def _degrees(angle_rad: float) -> Fraction:
    return Fraction(round(math.degrees(angle_rad) * 1000), 1000)


def _plan(work: Work, axis_name: str, angle: Setting, angles: Angles, *more: Setting) -> Planned:
    held, known = _closed(work)
    height_m = known.size_m[2]
    radius_m = math.hypot(*known.size_m) / 2
    middle, ahead, clearance = room_in_air(work, (work.arm,), radius_m)
    axis = Axis(middle, _axis(work.arm))
    upright = held_upright(held, (middle[0], middle[1], middle[2] - height_m / 2))
    uses = (ahead.name, clearance.name)

    def aim(turned_rad: float) -> Aim:
        turned = Turn(axis.point_m, axis.direction, turned_rad).end() @ upright
        target = ToolTarget(held.family.id, turned, turn_reference=held.family.symmetric)
        return Aim(target, uses if turned_rad == 0.0 else (angle.name,))

    return Planned(
        {item.name: item for item in (ahead, clearance, angle, *more)},
        {name: aim(turned_rad) for name, turned_rad in angles.items()},
        held.family,
        axes={axis_name: axis},
    )


def _closed(work: Work) -> tuple[Held, LabObject]:
    """What the hand holds, if it is the subject and nothing can run out of it."""
    assert isinstance(work.subject, ObjectRef)
    name = work.subject.name
    held, known = in_hand(work, name, "when it is turned over"), work.profile.object(name)
    assert known is not None
    if known.liquid is None:
        return held, known
    if cap_of(work, known) != "closed":
        has_cap = any(state.name == CAP for state in known.states)
        found = "its cap is open" if has_cap else "its profile states no `cap`"
        refuse(
            "XEI0723",
            f"`{name}` would be spilled: it is turned over and not closed",
            work.span,
            f"expected a closed vessel, {found}",
            (Label(known.span, "the vessel is stated here"),),
        )
    return held, known


_AIR = ("air_ahead", "air_clearance")

INVERT = Operation(
    "invert",
    ("invert_above", "inverted"),
    _AIR,
    plan_invert,
    axes=("invert_axis",),
    needs=("angle",),
)
SHAKE = Operation(
    "shake",
    ("shake_above", "shake_left", "shake_right"),
    (*_AIR, "shake_swing"),
    plan_shake,
    axes=("shake_axis",),
    needs=("amplitude",),
)
