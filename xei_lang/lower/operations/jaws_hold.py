"""Whether jaws that open and close by written widths pass a thing and then hold it."""

from __future__ import annotations

from xei_lang.diagnostics import Label
from xei_lang.lower.operations.base import Work
from xei_lang.lower.operations.closing import MIN_CLEARANCE_M
from xei_lang.lower.parameters import ROUNDING_M, Setting
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject
from xei_lang.quantity.lengths import exact_mm


def refuse_loose(
    work: Work, known: LabObject, width_m: float, clearance: Setting, opened: Setting, closed: Setting
) -> None:
    """Give up a step whose jaws, opened, do not pass a thing that is `width_m` wide between them, or, closed,
    do not touch it (XEI0702). To close further than the width is to squeeze, which is allowed.
    """
    shape = (Label(known.span, f"its shape is {known.computed_from or 'stated here'}"),)
    least_m = width_m + 2 * MIN_CLEARANCE_M
    if opened.si("Length") < least_m - ROUNDING_M:
        blamed = clearance if opened.source == "computed" else opened
        spare = exact_mm(MIN_CLEARANCE_M)
        expected = exact_mm(least_m) if blamed is opened else spare
        refuse(
            "XEI0702",
            f"`{blamed.name}` of {blamed.text} does not let the jaws pass `{known.name}`",
            blamed.span or work.span,
            f"expected at least {expected}: `{known.name}` is {exact_mm(width_m)} wide between the jaws",
            shape,
            notes=(f"the jaws must pass an object with {spare} to spare on each side",),
        )
    if closed.si("Length") > width_m + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`{closed.name}` of {closed.text} does not hold `{known.name}`: the jaws would not touch it",
            closed.span or work.span,
            f"expected at most {exact_mm(width_m)}, its width between the jaws",
            shape,
            help=(f"write `{closed.name}: {exact_mm(width_m)}`, or less to squeeze it",),
        )
