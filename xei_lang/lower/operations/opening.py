"""The opening of a vessel as a tip sees it: how deep the tip may go, how high the liquid stands, and what
forbids going in at all.

Vessels are taken as straight cylinders with a bottom as thick as their wall, as in pouring.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Cylinder
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.pipette import Pipette, goes_in_m
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.operations.state_before import cap_of, volume_in
from xei_lang.lower.parameters import Setting
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject, Liquid
from xei_lang.quantity.lengths import exact_mm

FROM_BOTTOM_M = 0.003
_FROM_WALL_M = 0.0005
_FROM_RIM_M = 0.005
_LEAST_M = 0.010
_ROUNDING_M3 = 1e-12


@dataclass(frozen=True, slots=True)
class Opening:
    """Heights above the vessel's own origin, m: its bottom inside, its rim, and the level of the liquid
    before and after the step, None where that is not known. `slim_m` is how deep the pipette goes in before
    a part that is too wide comes near the rim.
    """

    vessel: LabObject
    liquid: Liquid
    floor_m: float
    rim_m: float
    slim_m: float
    before_m: float | None
    after_m: float | None

    @property
    def deepest_m(self) -> float:
        """The lowest that the tip's end may come, above the vessel's origin."""
        return max(self.floor_m + FROM_BOTTOM_M, self.rim_m - self.slim_m)


def opening_of(work: Work, pipette: Pipette, volume: Setting, sign: int) -> Opening:
    """The subject's opening before and after the volume is added (`sign` 1) or taken (-1).

    Refuses what is no round vessel, is closed, too narrow, or does not give or take the volume.
    """
    vessel, shape, liquid = _vessel(work)
    radius_m = liquid.inner_diameter_m / 2
    wall_m = shape.radius_m - radius_m
    slim_m = goes_in_m(pipette.known.geometry, radius_m - _FROM_WALL_M) - _FROM_RIM_M
    stated = (Label(vessel.span, "the vessel is stated here"),)
    if cap_of(work, vessel) == "closed":
        refuse(
            "XEI0725",
            f"`{vessel.name}` is closed: the tip would meet its cap",
            work.span,
            "expected an open vessel",
            stated,
            help=(f"open `{vessel.name}` first, or say `given cap({vessel.name}) == open`",),
        )
    if slim_m < _LEAST_M:
        refuse(
            "XEI0726",
            f"a tip of `{pipette.known.name}` does not fit into `{vessel.name}`",
            work.span,
            f"{exact_mm(pipette.tip.diameter_m)} wide, the opening {exact_mm(liquid.inner_diameter_m)}",
            stated,
        )
    known = volume_in(work, vessel.name)
    area_m2 = math.pi * radius_m**2
    if known is None:
        return Opening(vessel, liquid, wall_m, shape.height_m, slim_m, None, None)
    fill = known.si
    after = fill + sign * volume.si("Volume")
    _refuse_volume(work, vessel, liquid, volume, fill, after)
    levels = (wall_m + fill / area_m2, wall_m + after / area_m2)
    return Opening(vessel, liquid, wall_m, shape.height_m, slim_m, *levels)


def _vessel(work: Work) -> tuple[LabObject, Cylinder, Liquid]:
    assert isinstance(work.subject, ObjectRef)
    vessel = standing_object(work, work.subject.name)
    if not isinstance(vessel.shape, Cylinder) or vessel.liquid is None:
        missing = "`liquid`" if vessel.liquid is None else "a round shape"
        refuse(
            "XEI0726",
            f"a tip cannot go into `{vessel.name}`: its profile lacks {missing}",
            work.span,
            "expected a round vessel with `liquid`",
            (Label(vessel.span, "the object is stated here"),),
        )
    return vessel, vessel.shape, vessel.liquid


def _refuse_volume(
    work: Work, vessel: LabObject, liquid: Liquid, volume: Setting, fill: float, after: float
) -> None:
    if after < fill and after < liquid.dead_volume_m3 - _ROUNDING_M3:
        message = f"`{vessel.name}` cannot give {volume.text}"
        found = f"holds {_ml(fill)}, of which {_ml(liquid.dead_volume_m3)} stay behind"
    elif after > fill and after > liquid.capacity_m3 + _ROUNDING_M3:
        message = f"`{vessel.name}` cannot take {volume.text} more"
        found = f"holds {_ml(fill)} of at most {_ml(liquid.capacity_m3)}"
    else:
        return
    stated = (Label(vessel.span, "its `liquid` is stated here"),)
    refuse("XEI0719", message, volume.span or work.span, found, stated)


def _ml(volume_m3: float) -> str:
    return f"{volume_m3 * 1e6:g} mL"
