"""Slots, tips and elements of screens whose place is known worse than the gap around what goes there."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.grid import T_object_slot, is_tip_grid, slot_keys
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.quantity import Quantity
from xei_lang.quantity.lengths import error_mm
from xei_lang.world.ground import ground
from xei_lang.world.precision import Benches, SlotPrecision


def precision_blockers(profile: Profile) -> Iterator[Blocker]:
    """One blocker for each object with slots that the widest object they accept may miss, whose tips a
    pipette may miss, or whose elements a finger may miss.
    """
    world, _ = ground(profile)
    if world is None:
        return
    benches = Benches.of(world, profile)
    for holder in profile.objects:
        worst = _worst(profile, benches, holder)
        if worst is not None:
            name, found = worst
            mend = (
                f"calibrate `{{frame}}` more closely, or give `{holder.name}` wider chamfers: its slots take"
            )
            yield _blocker(profile, holder, "slots", name, found, mend)
        for pipette in profile.objects:
            missed = _missed_tip(profile, benches, holder, pipette)
            if missed is not None:
                mend = f"calibrate `{{frame}}` more closely: the tips of `{holder.name}` take"
                yield _blocker(profile, holder, "slots", pipette.name, missed, mend)
        element = _missed_element(benches, holder)
        if element is not None:
            mend = "calibrate `{frame}` more closely, or use larger elements: a touch meets"
            yield _blocker(profile, holder, "elements", *element, mend)


def _missed_tip(
    profile: Profile, benches: Benches, holder: LabObject, pipette: LabObject
) -> SlotPrecision | None:
    """The tip of a box that a pipette misses most, by what the skills state as `alignment_tolerance`."""
    grid, tip = holder.slots, pipette.tip
    stated = [
        item.value.si
        for skill in profile.bank.skills
        for item in skill.parameters
        if item.name == "alignment_tolerance" and isinstance(item.value, Quantity)
    ]
    if grid is None or tip is None or not stated or not is_tip_grid(grid, tip):
        return None
    mouths = (T_object_slot(holder, key) for key in slot_keys(grid))
    found = [
        benches.point(holder.name, mouth.position_m, min(stated)) for mouth in mouths if mouth is not None
    ]
    missed = [item for item in found if item is not None and not item.is_enough]
    return max(missed, key=lambda item: item.tolerance_m, default=None)


def _missed_element(benches: Benches, screen: LabObject) -> tuple[str, SlotPrecision] | None:
    """The element of a screen that a finger misses most."""
    found = [(item.name, benches.element(screen, item)) for item in screen.elements]
    missed = [(name, item) for name, item in found if item is not None and not item.is_enough]
    return max(missed, key=lambda pair: pair[1].tolerance_m - pair[1].capture_m, default=None)


def _worst(profile: Profile, benches: Benches, holder: LabObject) -> tuple[str, SlotPrecision] | None:
    grid = holder.slots
    takes = [item for item in profile.objects if grid and set(item.roles) & set(grid.accepts)]
    if grid is None or not takes:
        return None
    widest = max(takes, key=lambda item: max(item.size_m[:2]))
    found = [benches.slot(holder, key, widest) for key in slot_keys(grid)]
    known = [item for item in found if item is not None and not item.is_enough]
    return (widest.name, max(known, key=lambda item: item.tolerance_m)) if known else None


def _blocker(
    profile: Profile, holder: LabObject, kind: str, name: str, found: SlotPrecision, mend: str
) -> Blocker:
    calibrated = {frame.name for frame in profile.calibration.frames}
    shares = [share for share in found.way.shares if share.link.name in calibrated]
    weak = max(shares, key=lambda share: share.most_m, default=found.way.shares[-1]).link
    item = f"frames.{weak.name}.tolerance"
    measure = (
        f"{mend.format(frame=weak.name)} `{name}` with an error of {error_mm(found.capture_m)}, and may "
        f"be {error_mm(found.tolerance_m)} off"
    )
    where = f"{kind}.{holder.name}"
    return Blocker(
        "XEI0676", "world", where, "imprecise", "hardware", measure, f"{CALIBRATION}:{item}", holder.span
    )
