"""How wide the jaws close on a round thing and open round it, where two hands have settings of their own:
`hold_width` and `hold_open_width` on the vessel, `cap_width` and `cap_open_width` on its cap.
"""

from __future__ import annotations

from typing import Literal

from xei_lang.lower.hand import Hand
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.closing import MIN_CLEARANCE_M
from xei_lang.lower.operations.jaws_hold import refuse_loose
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import exact_mm


def round_jaws(
    work: Work, known: LabObject, hand: Hand, prefix: Literal["hold", "cap"], what: str
) -> tuple[Setting, Setting, Setting]:
    """`<prefix>_width`, the same as `grasp_width`, and `<prefix>_open_width`; `what` is the thing in a
    rule's words. Refuses what is too wide for the gripper (XEI0703), and widths that do not pass or hold it
    (XEI0702).
    """
    wide_m = known.size_m[0]
    if wide_m + 2 * MIN_CLEARANCE_M > hand.max_gap_m + 1e-9:
        refuse(
            "XEI0703",
            f"`{known.name}` is too wide for the gripper",
            work.span,
            f"{exact_mm(wide_m)} wide, the jaws open {exact_mm(hand.max_gap_m)} at most",
        )
    default = work.layers.merge("jaw_clearance", None)
    assert default is not None
    room_m = min(default.si("Length"), (hand.max_gap_m - wide_m) / 2)
    closing = computed_length(f"{prefix}_width", wide_m, f"width of the {what}")
    opening = computed_length(
        f"{prefix}_open_width", wide_m + 2 * room_m, f"{exact_mm(wide_m)} and {exact_mm(room_m)} on each side"
    )
    closed = work.layers.merge(closing.name, closing)
    opened = work.layers.merge(opening.name, opening)
    assert closed is not None
    assert opened is not None
    refuse_loose(work, known, wide_m, default, opened, closed)
    return (closed, computed_length("grasp_width", closed.si("Length"), "as the jaws close"), opened)
