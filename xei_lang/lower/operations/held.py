"""What a hand must hold for an operation, what to say where it does not, and how it holds that upright."""

from __future__ import annotations

import math
from typing import NoReturn

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import ObjectRef, Side
from xei_lang.lower.operations.base import Work
from xei_lang.lower.refusal import refuse
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject


def in_hand(work: Work, name: str, when: str, side: Side | None = None) -> Held:
    """What the arm (or `side`) holds, if it is this object; refuses otherwise (XEI0707).

    `when` ends the message: "when it is set down".
    """
    side = side or work.arm
    held = work.scene.held.get(side)
    return held if held is not None and held.object == name else _refuse(work, (name,), when, side)


def held_of_step(work: Work, when: str, but: str = "") -> tuple[Held, LabObject]:
    """What the arm holds, if the step names it and it is not `but`; refuses otherwise (XEI0707)."""
    held = work.scene.held.get(work.arm)
    named = tuple(item.value.name for item in work.step.args if isinstance(item.value, ObjectRef))
    wanted = tuple(name for name in named if name != but)
    if not wanted:
        _refuse_unnamed(work, when, but)
    known = work.profile.object(held.object) if held is not None and held.object in wanted else None
    return (held, known) if held is not None and known is not None else _refuse(work, wanted, when, work.arm)


def held_upright(held: Held, origin_m: Vec3) -> Pose:
    """The held object upright with its own origin at a point of the base frame, turned as it was grasped."""
    x, y, _ = held.T_base_grasped.axes()[0]
    return Pose.from_rpy(origin_m, (0.0, 0.0, math.atan2(y, x)))


def _refuse_unnamed(work: Work, when: str, but: str) -> NoReturn:
    """The step names nothing that the hand could hold."""
    held = work.scene.held.get(work.arm)
    beside = f" but `{but}`" if but else ""
    refuse(
        "XEI0707",
        f"`{work.step.skill}` names no object{beside} that the {work.arm} hand could hold {when}",
        work.span,
        f"expected another object in the {work.arm} hand, found {f'`{held.object}`' if held else 'nothing'}",
        (held.since,) if held else (),
    )


def _refuse(work: Work, wanted: tuple[str, ...], when: str, side: Side) -> NoReturn:
    """One wanted object is pointed at by its argument and by what happened to it last."""
    held, only = work.scene.held.get(side), wanted[0] if len(wanted) == 1 else None
    where = work.scene.standing.get(only) if only else None
    since = where.since if where else held.since if held else None
    shown = f"`{only}`" if only else "one of " + ", ".join(f"`{name}`" for name in wanted)
    said = f"`{only}` is not in the {side} hand" if only else f"the {side} hand holds nothing that fits"
    argument = next((item.span for item in work.step.args if item.value == ObjectRef(only or "")), work.span)
    refuse(
        "XEI0707",
        f"{said} {when}",
        argument,
        f"expected {shown} in the {side} hand, found {f'`{held.object}`' if held else 'nothing'} in it",
        (since,) if since else (),
        help=(f"pick `{only}` up before this step",) if where else (),
    )
