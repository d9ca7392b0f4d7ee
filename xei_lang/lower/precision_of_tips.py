"""How well a step with a pipette must know where things are: the nose over a tip, the tip in an opening."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Step
from xei_lang.lower.operations.draw import ASPIRATE, DISPENSE
from xei_lang.lower.operations.tip import TIP, alignment_tolerance
from xei_lang.lower.parameters import layers_of
from xei_lang.lower.seats import place_text
from xei_lang.profiles.grid import T_object_slot
from xei_lang.profiles.model import LabObject, Profile, SkillSpec, Tip
from xei_lang.world.precision import Benches, SlotPrecision


@dataclass(frozen=True, slots=True)
class Fit:
    """`item` goes into `where`, which is at `holder`; `label` begins what a warning says."""

    item: str
    where: str
    holder: str
    found: SlotPrecision
    label: str


def tip_fits(step: Step, benches: Benches) -> Iterator[Fit]:
    """The tips and openings that a step's template leads a pipette to, each once."""
    profile = benches.profile
    spec, pipette = profile.bank.skill(step.skill), _pipette(step, profile)
    if spec is None or pipette is None or pipette.tip is None:
        return
    points = (str(line.field("at") or "").partition(".") for line in spec.template)
    for argument, point in dict.fromkeys((argument, point) for argument, _, point in points):
        value, found = step.arg(argument), None
        if isinstance(value, PlaceRef) and point in TIP.points[1:]:
            found = _onto(step, spec, pipette, benches, value)
        elif isinstance(value, ObjectRef) and point in (ASPIRATE.points[1], DISPENSE.points[1]):
            found = _into(pipette, pipette.tip, benches, value.name)
        if found is not None:
            yield found


def _pipette(step: Step, profile: Profile) -> LabObject | None:
    named = (profile.object(item.value.name) for item in step.args if isinstance(item.value, ObjectRef))
    return next((known for known in named if known is not None and known.tip is not None), None)


def _onto(step: Step, spec: SkillSpec, pipette: LabObject, benches: Benches, ref: PlaceRef) -> Fit | None:
    box = benches.profile.object(ref.object)
    T_box_slot = T_object_slot(box, ref.key) if box else None
    if T_box_slot is None:
        return None
    capture_m = alignment_tolerance(layers_of(step, spec, pipette)).si("Length")
    found = benches.point(ref.object, T_box_slot.position_m, capture_m)
    text = place_text(ref)
    return Fit(pipette.name, text, ref.object, found, "the tip takes an error of") if found else None


def _into(pipette: LabObject, tip: Tip, benches: Benches, name: str) -> Fit | None:
    vessel = benches.profile.object(name)
    if vessel is None or vessel.liquid is None:
        return None
    capture_m = (vessel.liquid.inner_diameter_m - tip.diameter_m) / 2
    found = benches.point(name, (0.0, 0.0, vessel.size_m[2]), capture_m)
    return Fit(pipette.name, name, name, found, "the opening takes an error of") if found else None
