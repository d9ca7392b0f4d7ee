"""Aspirate and dispense: the tip's end goes straight down a vessel's axis, through its opening, and no
further than it must.

Where it is not known how much is in a vessel, the tip goes as deep as pipette and bottom allow to aspirate,
and stays just below the rim to dispense.
"""

from __future__ import annotations

from fractions import Fraction

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.lift import along
from xei_lang.lower.operations.opening import FROM_BOTTOM_M, Opening, opening_of
from xei_lang.lower.operations.pipette import Pipette, held_pipette
from xei_lang.lower.parameters import ROUNDING_M, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject
from xei_lang.quantity import quantity
from xei_lang.quantity.lengths import exact_mm

_ABOVE_M = 0.030
_IMMERSION_M = 0.003
_FROM_LIQUID_M = 0.005
_BELOW_RIM_M = 0.010
_FLOW_M3_S = 0.5e-6
_SETTLE_S = 1.0


def plan_aspirate(work: Work) -> Planned:
    """The aims `aspirate_above` and `aspirate` of the held pipette in the subject."""
    pipette, volume = _pipette_for(work)
    opening = opening_of(work, pipette, volume, -1)
    deepest, level = opening.deepest_m, opening.after_m
    if level is not None and deepest > level:
        refuse(
            "XEI0726",
            f"a tip of `{pipette.known.name}` does not reach the liquid in `{opening.vessel.name}`",
            work.span,
            f"it comes within {exact_mm(deepest)} of the bottom, where {exact_mm(level)} are left",
            (Label(opening.vessel.span, "the vessel is stated here"),),
        )
    end, rule = deepest, "as deep as it goes: how much is in the vessel is not known"
    if level is not None:
        end = max(deepest, level - _IMMERSION_M)
        immersed = f"{exact_mm(_IMMERSION_M)} below the level that is left"
        rule = immersed if end > deepest else "as deep as it goes"
    depth = computed_length("tip_depth", opening.rim_m - end, rule)
    return _planned(work, "aspirate", pipette, opening, depth)


def plan_dispense(work: Work) -> Planned:
    """The aims `dispense_above` and `dispense` of the held pipette in the subject."""
    pipette, volume = _pipette_for(work)
    opening = opening_of(work, pipette, volume, 1)
    depth, rule = _BELOW_RIM_M, "just inside the opening"
    if opening.after_m is not None and opening.rim_m - opening.after_m - _FROM_LIQUID_M < depth:
        depth = opening.rim_m - opening.after_m - _FROM_LIQUID_M
        rule = f"{exact_mm(_FROM_LIQUID_M)} above the level that is then reached"
    return _planned(work, "dispense", pipette, opening, computed_length("tip_depth", depth, rule))


def _pipette_for(work: Work) -> tuple[Pipette, Setting]:
    """The held pipette, and the volume of the call, which its tip must hold."""
    pipette, volume = held_pipette(work), work.layers.call["volume"]
    if volume.si("Volume") > pipette.tip.capacity_m3 + 1e-12:
        refuse(
            "XEI0719",
            f"`{pipette.known.name}` cannot take {volume.text} at once",
            volume.span or work.span,
            f"its tips hold {pipette.tip.capacity_m3 * 1e6:g} mL",
            (Label(pipette.tip.span, "the tips are stated here"),),
        )
    return pipette, volume


def _planned(work: Work, name: str, pipette: Pipette, opening: Opening, computed: Setting) -> Planned:
    depth, vessel = _tip_depth(work, opening, computed), opening.vessel
    above = work.layers.merge(
        "rim_clearance", computed_length("rim_clearance", _ABOVE_M, "from the rim to the end of the tip")
    )
    assert above is not None
    end_m = opening.rim_m - depth.si("Length")
    T_base_end = work.scene.T_base_object(vessel.name) @ Pose((0.0, 0.0, end_m))
    end = pipette.upright(T_base_end.position_m)
    up = along((0.0, 0.0, 1.0), depth.si("Length") + above.si("Length"))
    family = pipette.held.family
    settings = (depth, above, _time(work, f"{name}_time"), pipette.tool_point())
    target = ToolTarget(family.id, end, turn_reference=family.symmetric)
    return Planned(
        {item.name: item for item in settings},
        {
            f"{name}_above": Aim(
                ToolTarget(family.id, end, up, turn_reference=family.symmetric), (above.name,)
            ),
            name: Aim(target, (depth.name, "tool_point"), entered=_entered(work, vessel, end_m)),
        },
        family,
    )


def _tip_depth(work: Work, opening: Opening, computed: Setting) -> Setting:
    """How deep the tip's end goes below the rim: written, or computed; never so deep that it meets the bottom
    or that the pipette meets the rim.
    """
    depth = work.layers.merge("tip_depth", computed)
    assert depth is not None
    most = opening.rim_m - opening.deepest_m
    if depth.si("Length") > most + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`tip_depth` of {depth.text} is deeper than a tip may go into `{opening.vessel.name}`",
            depth.span or work.span,
            f"expected at most {exact_mm(most)} below the rim",
            (Label(opening.vessel.span, "the vessel is stated here"),),
        )
    return depth


def _entered(work: Work, vessel: LabObject, end_m: float) -> tuple[str, ...]:
    """The vessel, and what it stands in where the tip's end comes below the mouth of its slot."""
    standing = work.scene.standing[vessel.name]
    host = work.profile.object(standing.support)
    if host is None or host.slots is None or host.name not in work.scene.standing:
        return (vessel.name,)
    T_host_vessel = work.scene.standing[host.name].T_world_object.inverse() @ standing.T_world_object
    height_m = T_host_vessel.apply((0.0, 0.0, end_m))[2]
    return (vessel.name, host.name) if height_m < host.size_m[2] + FROM_BOTTOM_M else (vessel.name,)


def _time(work: Work, name: str) -> Setting:
    """How long the pipette takes for the volume, and a second for the last of it."""
    seconds = _SETTLE_S + work.layers.call["volume"].si("Volume") / _FLOW_M3_S
    rule = f"the volume at {_FLOW_M3_S * 1e6:g} mL/s, and {_SETTLE_S:g} s"
    value = quantity(Fraction(round(seconds * 10), 10), "s")
    time = work.layers.merge(name, Setting(name, value, "computed", rule, None))
    assert time is not None
    return time


_SHARED = ("tip_depth", "rim_clearance", "tool_point")
ASPIRATE = Operation(
    "aspirate",
    ("aspirate_above", "aspirate"),
    (*_SHARED, "aspirate_time"),
    plan_aspirate,
    called=("volume",),
)
DISPENSE = Operation(
    "dispense",
    ("dispense_above", "dispense"),
    (*_SHARED, "dispense_time"),
    plan_dispense,
    called=("volume",),
)
