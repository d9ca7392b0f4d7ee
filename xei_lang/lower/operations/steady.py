"""Steady: one hand takes a vessel low, holds it upright in the air where the other has room over it, and sets
it down where it stood.

On a crowded table no two hands reach one vessel, so it is opened in the air between the arms. The hand comes
from the side, level or nearly, so low that the other one's fingertips stay over it, and in the air it heads
inwards, across the other one's way. That room was sought by trial: with the vessel 250 mm ahead of the
shoulders, a third of the way to the other arm's, and the shoulders 260 mm (for a left hand that turns 170 mm)
over the grasp point on the cap, every posture of a hand that heads 45 .. 90 deg inwards left the other one
grasps to turn a cap by 120 deg.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from xei_lang.diagnostics import Label
from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Cylinder, Pose
from xei_lang.ir.skill_plan import ObjectRef, Side
from xei_lang.lower.hand import SIDES, hand_of
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.caps import Cap, cap_on, depth_on_cap, refuse_capless
from xei_lang.lower.operations.in_air import room_in_air
from xei_lang.lower.operations.low_grasps import low_grasps, yaw_of
from xei_lang.lower.operations.round_jaws import round_jaws
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import reach_direction, shoulder_height_m
from xei_lang.lower.walk import Standing
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import mm

_INWARDS_RAD = math.radians(70.0)
"""Where the hand heads in the air, from straight ahead."""
_SHOULDERS_OVER_CAP_M: Mapping[Side, float] = MappingProxyType({"right": 0.26, "left": 0.17})
"""By the hand that turns: a thread is right-handed for either arm, so what one does is no mirror image of
what the other does.
"""
_BACK_M = 0.010


def plan(work: Work) -> Planned:
    """The hand's family on the vessel where it stands, and the aims `hold_pregrasp`, `hold_grasp`,
    `hold_lift`, `hold_air`, and back again `hold_above`, `hold_place`, `hold_retreat`; with
    `twist_slide`, the height of the slide for the other hand.
    """
    cap, stood = _vessel(work)
    hand, vessel = hand_of(work.profile), cap.vessel
    depth_m = depth_on_cap(work, cap, hand.fingertip_m).si("Length")
    T_base_stood = work.scene.in_base(stood.T_world_object)
    members = low_grasps(work, cap, T_base_stood, depth_m)
    family = Family(work.family_id, vessel.name, members, True)
    widths = round_jaws(work, vessel, hand, "hold", "vessel")
    half_m = vessel.size_m[0] / 2
    standoff = computed_length(
        "standoff", half_m + hand.fingertip_m + _BACK_M, "takes the fingertips clear of the vessel"
    )
    lift, above = work.layers.merge("lift", None), work.layers.merge("approach_height", None)
    assert lift is not None
    assert above is not None
    T_base_air, air = _air(work, vessel, T_base_stood)
    slide = _slide(work, cap, T_base_air, depth_m)
    standing = ToolTarget(family.id, T_base_stood)
    back = back_off(family.id, T_base_stood, standoff.si("Length"))
    T_world_air = work.scene.epoch.T_world_base @ T_base_air
    settings = (standoff, *widths, lift, above, *air, slide)
    return Planned(
        {item.name: item for item in settings},
        {
            "hold_pregrasp": Aim(back, ("standoff",)),
            "hold_grasp": Aim(standing, (), around=vessel.name),
            "hold_lift": Aim(_over(standing, lift), ("lift",)),
            "hold_air": Aim(
                ToolTarget(family.id, T_base_air),
                tuple(item.name for item in air),
                slide_stays=True,
                T_world_held=T_world_air,
            ),
            "hold_above": Aim(_over(standing, above), ("approach_height",)),
            "hold_place": Aim(standing, (), support=stood.support),
            "hold_retreat": Aim(back, ("standoff",)),
        },
        family,
        stood=stood,
    )


def _over(target: ToolTarget, height: Setting) -> ToolTarget:
    return ToolTarget(target.family, target.T_base_reference, (0.0, 0.0, height.si("Length")))


def _vessel(work: Work) -> tuple[Cap, Standing]:
    """The vessel with its cap, and how it stands; refuses one that does not stand, or is to be held and
    turned by one hand.
    """
    assert isinstance(work.subject, ObjectRef)
    name = work.subject.name
    sides = [item for item in work.step.args if item.value in SIDES]
    if len({item.value for item in sides}) < len(sides):
        refuse(
            "XEI0728",
            f"one hand cannot hold `{name}` and turn its cap",
            sides[-1].span,
            "expected the other arm",
            (Label(sides[0].span, f"the {sides[0].value} arm is named here"),),
            help=(f"say `{sides[-1].name}={_other(work.arm)}`",),
        )
    vessel, known = work.profile.object(name), cap_on(work.profile, name)
    if vessel is None or known is None or known.thread is None:
        refuse_capless(work.profile, name, work.span)
    if not isinstance(vessel.shape, Cylinder):
        label = Label(vessel.span, "the object is stated here")
        refuse("XEI0728", f"`{name}` is not round", work.span, "expected a round vessel", (label,))
    standing = work.scene.standing.get(name)
    if standing is None:
        holder = work.scene.holder(name)
        found = f"it is in the {holder} hand" if holder else "it is not known where it is"
        refuse("XEI0710", f"`{name}` does not stand where a hand could take it", work.span, found)
    return Cap(known, known.thread, vessel), standing


def _other(side: Side) -> Side:
    return "left" if side == "right" else "right"


def _air(work: Work, vessel: LabObject, T_base_stood: Pose) -> tuple[Pose, tuple[Setting, Setting]]:
    """Where the vessel is held, turned so that the hand heads inwards there."""
    (x, y, z), ahead, clearance = room_in_air(work, (_other(work.arm),), math.hypot(*vessel.size_m) / 2)
    reach = reach_direction(work.profile, work.arm, T_base_stood)
    inwards = _INWARDS_RAD if work.arm == "right" else -_INWARDS_RAD
    yaw = yaw_of(T_base_stood) + inwards - math.atan2(reach[1], reach[0])
    bottom = z - vessel.size_m[2] / 2
    return Pose.from_rpy((x, y, bottom), (0.0, 0.0, math.remainder(yaw, math.tau))), (ahead, clearance)


def _slide(work: Work, cap: Cap, T_base_air: Pose, depth_m: float) -> Setting:
    """The slide's height at which the shoulders are over the cap as an arm from above needs it."""
    cap_m = cap.T_vessel_seat.position_m[2] + cap.known.size_m[2] - depth_m + cap.rise_m / 2
    over_m = _SHOULDERS_OVER_CAP_M[_other(work.arm)]
    wanted = T_base_air.position_m[2] + cap_m + over_m - shoulder_height_m(work.profile, work.arm)
    joint = work.profile.robot.joint("slide_joint")
    height = wanted if joint is None else min(max(wanted, joint.lower), joint.upper)
    rule = f"brings the shoulders {mm(over_m)} over the grasp on the cap, or as near as it goes"
    found = work.layers.merge("twist_slide", computed_length("twist_slide", height, rule))
    assert found is not None
    return found


STEADY = Operation(
    "steady",
    ("hold_pregrasp", "hold_grasp", "hold_lift", "hold_air", "hold_above", "hold_place", "hold_retreat"),
    ("hold_width", "hold_open_width", "twist_slide"),
    plan,
    needs=("lift", "approach_height", "jaw_clearance"),
)
