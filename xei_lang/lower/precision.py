"""Tasks that ask for more than is known: an object into a slot, a pipette onto a tip, a tip into a vessel, a
finger onto an element of a screen, whose place is known worse than the gap.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.check.effects import effects_of, moves
from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, SkillPlan, Step
from xei_lang.ir.tolerance import SIGMAS
from xei_lang.ir.world import Frame, World
from xei_lang.lower.precision_of_elements import element_fits
from xei_lang.lower.precision_of_tips import tip_fits
from xei_lang.lower.seats import place_text
from xei_lang.profiles.model import Profile
from xei_lang.quantity.lengths import error_mm
from xei_lang.world.precision import Benches, SlotPrecision
from xei_lang.world.transforms import Transform

_CHAMFER = ", or use slots with a wider chamfer"


def imprecise_tasks(plan: SkillPlan, profile: Profile, world: World) -> Iterator[Diagnostic]:
    """One warning for each object that something goes into and each size of what does, at the first step that
    does so.

    A simulation knows where everything is; on hardware such a task is a matter of luck.
    """
    warned: set[tuple[str, str, float]] = set()
    benches = Benches.of(world, profile)
    for step in plan.steps:
        for fit in (*tip_fits(step, benches), *element_fits(step, benches)):
            key = (fit.holder, fit.item, fit.found.capture_m)
            if key not in warned and not fit.found.is_enough:
                warned.add(key)
                yield _warning(step, fit.item, fit.where, fit.found, fit.label)
        for name, place in _insertions(step, profile):
            holder, item = profile.object(place.object), profile.object(name)
            if holder is None or item is None or (holder.name, "", max(item.size_m[:2])) in warned:
                continue
            found = benches.slot(holder, place.key, item)
            if found is not None and not found.is_enough:
                warned.add((holder.name, "", max(item.size_m[:2])))
                yield _warning(step, name, place_text(place), found, "the slot takes an error of", _CHAMFER)


def _insertions(step: Step, profile: Profile) -> Iterator[tuple[str, PlaceRef]]:
    skill = profile.bank.skill(step.skill)
    for subject, destination in moves(effects_of(skill)) if skill else ():
        item, place = step.arg(subject), step.arg(destination)
        if isinstance(item, ObjectRef) and isinstance(place, PlaceRef) and place.kind == "slot":
            yield item.name, place


def _warning(
    step: Step, name: str, where: str, found: SlotPrecision, label: str, mend: str = ""
) -> Diagnostic:
    return Diagnostic(
        "XEI0717",
        f"`{name}` may miss `{where}`",
        step.span,
        label=f"{label} {error_mm(found.capture_m)}, and may be {error_mm(found.tolerance_m)} off",
        notes=(f"known by way of {_shown(found.way)}",),
        help=(f"measure these transforms more closely{mend}; a simulation goes on",),
    )


def _shown(way: Transform) -> str:
    parts = [
        f"`{link.name}` ({_tolerance(link)})"
        for link in way.links
        if link.position_tolerance_m or link.rotation_tolerance_rad
    ]
    return " and ".join(parts)


def _tolerance(link: Frame) -> str:
    text = f"{error_mm(link.position_tolerance_m)}, {_degrees(link.rotation_tolerance_rad)}"
    return f"standard deviation {text}; {SIGMAS:g} of them count" if link.tolerance_as == "std" else text


def _degrees(angle_rad: float) -> str:
    return f"{math.degrees(angle_rad):.2g} deg"
