"""How the jaws close on an object that stands: across which way, and how wide they open and close."""

from __future__ import annotations

import math

from xei_lang.diagnostics import Label
from xei_lang.ir.geometry import Pose
from xei_lang.lower.hand import Hand
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.closing import MIN_CLEARANCE_M, Closing, closings
from xei_lang.lower.operations.jaws_hold import refuse_loose
from xei_lang.lower.parameters import ROUNDING_M, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import exact_mm
from xei_lang.record import Record, record

_SKILL_CLEARANCE_M = 0.004


@record
class Seen(Record):
    """The gripper, the object before the arm, and the level unit vector (x, y) from shoulder to object."""

    hand: Hand
    T_base_object: Pose
    reach: tuple[float, float]


@record
class Jaws(Record):
    """The way to close, and the settings `jaw_clearance` (on each side), `open_width` and `grasp_width`."""

    closing: Closing
    clearance: Setting
    opening: Setting
    closed: Setting


def jaws_on(work: Work, known: LabObject, seen: Seen) -> Jaws:
    """The jaws on this object. Refuses one that is too wide for them (XEI0703), and a width that is no gap
    of theirs, does not let them pass it, or does not hold it (XEI0702).
    """
    return _set(work, known, _closing(work, known, seen), seen.hand)


def _closing(work: Work, known: LabObject, seen: Seen) -> Closing:
    """The way to close that fits the jaws; of two, the one whose jaws open across the way from shoulder to
    object.
    """
    ways, hand = closings(known.shape), seen.hand
    fitting = [way for way in ways if way.width_m + 2 * MIN_CLEARANCE_M <= hand.max_gap_m + 1e-9]
    if not fitting:
        least = min(way.width_m for way in ways)
        refuse(
            "XEI0703",
            f"`{known.name}` is too wide for the gripper",
            work.span,
            f"{exact_mm(least)} wide where it is narrowest, the jaws open {exact_mm(hand.max_gap_m)} at most",
            (Label(known.span, f"its shape is {known.computed_from or 'stated here'}"),),
            notes=(f"the jaws must pass an object with {exact_mm(MIN_CLEARANCE_M)} to spare on each side",),
        )
    (reach_x, reach_y), rotate = seen.reach, seen.T_base_object.rotate

    def across(way: Closing) -> tuple[float, float]:
        heading = way.headings_rad[0]
        x, y, _ = rotate((math.cos(heading), math.sin(heading), 0.0))
        return (-round(abs(x * reach_x + y * reach_y), 3), way.width_m)

    return min(fitting, key=across) if len(fitting) > 1 else fitting[0]


def _set(work: Work, known: LabObject, closing: Closing, hand: Hand) -> Jaws:
    room_m = (hand.max_gap_m - closing.width_m) / 2
    default = work.layers.skill.get("jaw_clearance")
    wanted_m = default.si("Length") if default else _SKILL_CLEARANCE_M
    clearance = work.layers.written("jaw_clearance")
    if clearance is None and default is not None and wanted_m <= room_m:
        clearance = default
    elif clearance is None:
        rule = f"what {exact_mm(hand.max_gap_m)} leaves beside {exact_mm(closing.width_m)}"
        clearance = computed_length("jaw_clearance", min(room_m, wanted_m), rule)
    origin = f", {known.computed_from}" if known.computed_from else ""
    width = f"width of the object between the jaws{origin}"
    closed = work.layers.merge("grasp_width", computed_length("grasp_width", closing.width_m, width))
    assert closed is not None
    rule = f"{exact_mm(closing.width_m)} and {clearance.text} on each side"
    wide_m = closing.width_m + 2 * clearance.si("Length")
    opening = work.layers.merge("open_width", computed_length("open_width", wide_m, rule))
    assert opening is not None
    for item in (opening, closed):
        if not 0.0 <= item.si("Length") <= hand.max_gap_m + ROUNDING_M:
            refuse(
                "XEI0702",
                f"`{item.name}` of {item.text} is not a gap of this gripper",
                item.span or work.span,
                f"expected 0 mm .. {exact_mm(hand.max_gap_m)}",
            )
    refuse_loose(work, known, closing.width_m, clearance, opening, closed)
    return Jaws(closing, clearance, opening, closed)
