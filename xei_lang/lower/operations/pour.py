"""Pour: the held vessel stands upright with its lip over the target's opening and tilts about that lip.

The lip stays where it is while the vessel tilts, so that the stream keeps its place. Upright, the vessel
reaches down below its own lip: the lip therefore stands so high above the target's rim that the vessel's
bottom clears it. Tilting only lifts the bottom.
"""

from __future__ import annotations

import math
from fractions import Fraction

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Cylinder, Pose, Vec3
from xei_lang.ir.skill_plan import ObjectRef, Side
from xei_lang.ir.tool_paths import Turn
from xei_lang.lower.operations.base import Aim, Axis, Operation, Planned, Work
from xei_lang.lower.operations.held import held_of_step, held_upright
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.operations.state_before import volume_in
from xei_lang.lower.operations.vessel import Vessel
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.robot import reach_direction
from xei_lang.lower.walk import Held
from xei_lang.profiles.model import LabObject, Liquid
from xei_lang.quantity import quantity
from xei_lang.quantity.lengths import exact_mm

_CLEARANCE_M = 0.015
_BEHIND_MIDDLE = 1 / 3
_FLOW_M3_S = 10e-6
_SETTLE_S = 1.0


def plan(work: Work) -> Planned:
    """The aims `pour_above` and `pour_tilt` of the held vessel over the subject, and the axis `pour_lip`."""
    assert isinstance(work.subject, ObjectRef)
    held, source = _held(work)
    target = standing_object(work, work.subject.name)
    shape, liquid = _round(work, source)
    opening_m = _round(work, target)[1].inner_diameter_m
    clearance = work.layers.merge(
        "pour_clearance", computed_length("pour_clearance", _CLEARANCE_M, "of the vessel over the rim")
    )
    assert clearance is not None
    height = _height(work, shape, clearance)
    angle, fill = _angle(work, source, shape, liquid)
    time = _time(work)
    T_base_target = work.scene.T_base_object(target.name)
    heading = _heading(work, work.arm, T_base_target)
    x, y, z = T_base_target.apply((0.0, 0.0, target.size_m[2]))
    back = _BEHIND_MIDDLE * opening_m / 2
    lip = (x - back * heading[0], y - back * heading[1], z + height.si("Length"))
    axis = Axis(lip, (-heading[1], heading[0], 0.0))
    above = _upright(held, shape, lip, heading)
    tilted = Turn(axis.point_m, axis.direction, angle.si("Angle")).end() @ above
    family, turn = held.family.id, held.family.symmetric
    settings = (clearance, height, fill, angle, time)
    return Planned(
        {item.name: item for item in settings},
        {
            "pour_above": Aim(
                ToolTarget(family, above, turn_reference=turn), ("pour_clearance", "pour_height")
            ),
            "pour_tilt": Aim(ToolTarget(family, tilted, turn_reference=turn), ("fill", "pour_angle")),
        },
        held.family,
        axes={"pour_lip": axis},
    )


def _held(work: Work) -> tuple[Held, LabObject]:
    """What the arm holds, if the step is about it and it is not the target itself."""
    same = [item.span for item in work.step.args if item.value == ObjectRef(_name(work))]
    if len(same) > 1:
        source = next((span for span in same if span != work.span), None)
        refuse(
            "XEI0718",
            f"`{_name(work)}` cannot be poured into itself",
            work.span,
            "expected another vessel to pour into",
            (Label(source, "it is poured from here"),) if source else (),
        )
    return held_of_step(work, "when it is poured", but=_name(work))


def _name(work: Work) -> str:
    return work.subject.name if isinstance(work.subject, ObjectRef) else work.subject.object


def _round(work: Work, known: LabObject) -> tuple[Cylinder, Liquid]:
    if isinstance(known.shape, Cylinder) and known.liquid is not None:
        return known.shape, known.liquid
    missing = "`liquid`" if known.liquid is None else "a round shape"
    return refuse(
        "XEI0718",
        f"`{known.name}` cannot be poured from or into: its profile lacks {missing}",
        work.span,
        "expected a round vessel with `liquid`",
        (Label(known.span, "the object is stated here"),),
    )


def _height(work: Work, shape: Cylinder, clearance: Setting) -> Setting:
    """How high the lip stands above the target's rim; never so low that the upright vessel meets it."""
    least_m = shape.height_m + clearance.si("Length")
    rule = f"the upright vessel, {exact_mm(shape.height_m)} high, clears the rim by {clearance.text}"
    height = work.layers.merge("pour_height", computed_length("pour_height", least_m, rule))
    assert height is not None
    if height.si("Length") < shape.height_m:
        refuse(
            "XEI0702",
            f"`pour_height` of {height.text} lets the upright vessel meet the rim",
            height.span or work.span,
            f"expected at least {exact_mm(shape.height_m)}",
        )
    return height


def _angle(work: Work, source: LabObject, shape: Cylinder, liquid: Liquid) -> tuple[Setting, Setting]:
    """The tilt at which what stays in the vessel is what was in it without the volume that is asked for."""
    volume, fill = work.layers.call.get("volume"), _fill(work, source, liquid)
    wall_m = shape.radius_m - liquid.inner_diameter_m / 2
    vessel = Vessel(liquid.inner_diameter_m / 2, shape.height_m - wall_m)
    wanted = volume.si("Volume") if volume is not None else fill.si("Volume")
    if wanted > fill.si("Volume") - liquid.dead_volume_m3 + 1e-12:
        refuse(
            "XEI0719",
            f"`{source.name}` cannot give {volume.text if volume else fill.text}",
            (volume.span if volume else None) or work.span,
            f"holds {fill.text}, of which {liquid.dead_volume_m3 * 1e6:g} mL stay behind",
            (Label(source.span, "its `liquid` is stated here"),),
            notes=(f"fill: {fill.rule}",),
        )
    tilt_rad = vessel.tilt_rad(fill.si("Volume") - wanted)
    rule = f"{fill.text} less {volume.text if volume else fill.text} are then level with the lip"
    degrees = Fraction(round(math.degrees(tilt_rad) * 100), 100)
    angle = work.layers.merge(
        "pour_angle", Setting("pour_angle", quantity(degrees, "deg"), "computed", rule, None)
    )
    assert angle is not None
    if not 0.0 < angle.si("Angle") <= math.radians(150.0):
        refuse(
            "XEI0702",
            f"`pour_angle` of {angle.text} pours nothing or turns the vessel over",
            angle.span or work.span,
            "expected more than 0 deg and at most 150 deg",
        )
    return angle, fill


def _fill(work: Work, source: LabObject, liquid: Liquid) -> Setting:
    """What is in the vessel: stated in the plan's state, else at most what it holds.

    Taken for full, it is never tilted too far: too little is poured rather than too much.
    """
    known = volume_in(work, source.name)
    if known is not None:
        stated = Setting("fill", known, "computed", f"what is in `{source.name}` at this step", None)
    else:
        full = quantity(Fraction(round(liquid.capacity_m3 * 1e9), 1000), "mL")
        rule = "its capacity: how much is in it is not known, so that no more is poured than asked for"
        stated = Setting("fill", full, "computed", rule, None)
    merged = work.layers.merge("fill", stated)
    assert merged is not None
    return merged


def _time(work: Work) -> Setting:
    """How long the vessel stays tilted: until the volume has run out, and a second for the last of it."""
    volume = work.layers.call.get("volume")
    seconds = _SETTLE_S + (volume.si("Volume") / _FLOW_M3_S if volume is not None else 0.0)
    rule = f"the volume at {_FLOW_M3_S * 1e6:g} mL/s, and {_SETTLE_S:g} s"
    value = quantity(Fraction(round(seconds * 10), 10), "s")
    time = work.layers.merge("pour_time", Setting("pour_time", value, "computed", rule, None))
    assert time is not None
    return time


def _heading(work: Work, arm: Side, T_base_target: Pose) -> tuple[float, float]:
    """Which way the vessel's top tilts: across the reach of the arm, towards the robot's middle; the vessel
    itself stays on the arm's own side.
    """
    x, y = reach_direction(work.profile, arm, T_base_target)
    return (-y, x) if arm == "right" else (y, -x)


def _upright(held: Held, shape: Cylinder, lip: Vec3, heading: tuple[float, float]) -> Pose:
    """The held vessel upright with the lip of this heading at a point, turned as it was grasped."""
    r = shape.radius_m
    foot = (lip[0] - r * heading[0], lip[1] - r * heading[1], lip[2] - shape.height_m)
    return held_upright(held, foot)


POUR = Operation(
    "pour",
    ("pour_above", "pour_tilt"),
    ("pour_clearance", "pour_height", "fill", "pour_angle", "pour_time"),
    plan,
    axes=("pour_lip",),
)
