"""Lift: straight up, out of the slot along its axis, before anything moves freely."""

from __future__ import annotations

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Vec3
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.held import in_hand
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.quantity.lengths import exact_mm

_CLEAR_M = 0.020


def plan(work: Work) -> Planned:
    """The aim `lift`: the held object above where it stood, by `lift` along the axis that leads out."""
    assert isinstance(work.subject, ObjectRef)
    held = in_hand(work, work.subject.name, "when it is lifted")
    setting = clear_travel(work, "lift", held.sunk_m, "leaves the slot")
    T_base_grasped = work.scene.in_base(held.T_world_grasped)
    up = T_base_grasped.axes()[2] if held.sunk_m > 0.0 else (0.0, 0.0, 1.0)
    target = ToolTarget(held.family.id, T_base_grasped, along(up, setting.si("Length")))
    return Planned({"lift": setting}, {"lift": Aim(target, ("lift",))})


def clear_travel(work: Work, name: str, depth_m: float, why: str) -> Setting:
    """A travel along a slot's axis: written, or the skill's default, or longer where the slot is deeper
    than that.
    """
    default = work.layers.skill.get(name)
    needed_m = depth_m + _CLEAR_M
    if default is None or default.si("Length") < needed_m:
        rule = f"{why}: {exact_mm(depth_m)} deep, {exact_mm(_CLEAR_M)} clear"
        setting = work.layers.merge(name, computed_length(name, needed_m, rule))
    else:
        setting = work.layers.merge(name, None)
    assert setting is not None
    if setting.si("Length") <= depth_m:
        refuse(
            "XEI0702",
            f"`{name}` of {setting.text} does not clear a slot {exact_mm(depth_m)} deep",
            setting.span or work.span,
            f"expected more than {exact_mm(depth_m)}",
        )
    return setting


def along(axis: Vec3, length_m: float) -> Vec3:
    """The vector of this length along a unit axis."""
    return (axis[0] * length_m, axis[1] * length_m, axis[2] * length_m)


LIFT = Operation("lift", ("lift",), ("lift",), plan)
