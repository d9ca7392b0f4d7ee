"""Handover: one hand holds the object upright in free air between the arms, the other takes it there.

Both arms ride on one slide, which therefore stays from then on until they have parted. While both hold the
object nothing but jaws moves. The taker's family is that of an object that stands there; which
of its members keeps clear of the giver's hand is for motion planning, as with any other body.
"""

from __future__ import annotations

import math
from dataclasses import replace

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import ObjectRef, Side
from xei_lang.lower.hand import SIDES
from xei_lang.lower.operations import grasp
from xei_lang.lower.operations.approach import back_off
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.held import held_upright, in_hand
from xei_lang.lower.operations.in_air import room_in_air
from xei_lang.lower.operations.place import release_width
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Held, Standing

_AIR = ("air_ahead", "air_clearance")


def plan_give(work: Work) -> Planned:
    """The aims `handover_hold`, the held object where the hands meet, and `handover_retreat`, the empty hand
    backed off from it.
    """
    held = _held(work, work.arm)
    pose, settings = _meeting(work, held)
    standoff = work.layers.merge(
        "standoff", computed_length("standoff", held.standoff_m, f"as when `{held.object}` was grasped")
    )
    assert standoff is not None
    family, turn = held.family.id, held.family.symmetric
    hold = ToolTarget(family, pose, turn_reference=turn)
    return Planned(
        {item.name: item for item in (*settings, standoff, *release_width(work, held))},
        {
            "handover_hold": Aim(hold, _AIR),
            "handover_retreat": Aim(
                back_off(family, pose, standoff.si("Length"), turn), ("standoff",), slide_stays=True
            ),
        },
        held.family,
    )


def plan_take(work: Work) -> Planned:
    """The family of the object in the other hand, and the aims `handover_pregrasp` and `handover_grasp`."""
    name = _name(work)
    giver = work.scene.holder(name)
    if giver is None or giver == work.arm:
        found = f"the {giver} hand holds it already" if giver else f"found `{name}` in no hand"
        refuse(
            "XEI0708",
            f"the {work.arm} hand cannot take `{name}` from the other one",
            work.span,
            f"expected `{name}` in the other hand, {found}",
        )
    held = work.scene.held[giver]
    pose, _ = _meeting(work, held)
    T_world_object = work.scene.epoch.T_world_base @ pose
    there = Standing(name, T_world_object, "", "", held.since)
    planned = grasp.plan(replace(work, scene=work.scene.detach(giver, there)))
    aims = {f"handover_{point}": replace(aim, slide_stays=True) for point, aim in planned.aims.items()}
    return replace(planned, aims=aims, T_world_placed=T_world_object)


def _meeting(work: Work, held: Held) -> tuple[Pose, tuple[Setting, Setting]]:
    """Where the object is handed over, upright, turned as it was grasped; the same for both hands."""
    known = work.profile.object(held.object)
    assert known is not None
    (x, y, z), ahead, clearance = room_in_air(work, SIDES, math.hypot(*known.size_m) / 2)
    return held_upright(held, (x, y, z - known.size_m[2] / 2)), (ahead, clearance)


def _held(work: Work, side: Side) -> Held:
    return in_hand(work, _name(work), "when it is handed over", side)


def _name(work: Work) -> str:
    assert isinstance(work.subject, ObjectRef)
    return work.subject.name


GIVE = Operation(
    "give",
    ("handover_hold", "handover_retreat"),
    (*_AIR, "standoff", "jaw_clearance", "release_width"),
    plan_give,
)
TAKE = Operation("take", ("handover_pregrasp", "handover_grasp"), grasp.GRASP.parameters, plan_take)
