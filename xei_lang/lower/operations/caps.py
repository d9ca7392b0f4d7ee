"""Caps: which one closes a vessel, where it is, and what its thread asks of the hand that turns it.

A cap's family is that of a hand over it: straight down or steep, its fingertips on the cap alone. The cap is
round, so its nominal pose never turns; where the hand has turned it to is the hand's own matter.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import NoReturn

from xei_lang.diagnostics import Label, Span
from xei_lang.ir.geometry import Cylinder, Pose, Vec3
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.lower.operations.base import Work
from xei_lang.lower.parameters import Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import MOST_TIMES, LabObject, Profile, Thread
from xei_lang.quantity import Quantity, quantity
from xei_lang.quantity.dimension import NUMBER
from xei_lang.quantity.lengths import exact_mm
from xei_lang.record import Record, record

MOST_STROKE_RAD = math.radians(270.0)
"""A turn of more leads every arm out of a joint's range: 270 deg was planned in free air, 330 deg never."""
_WHOLE_DEG = 360.0


@record
class Cap(Record):
    """A cap with its thread, and the vessel that it closes."""

    known: LabObject
    thread: Thread
    vessel: LabObject

    @property
    def T_vessel_seat(self) -> Pose:
        """Where the cap sits on the closed vessel."""
        spots = (spot.T_object_spot for spot in self.vessel.spots if spot.name == self.thread.on_key)
        return next(spots, Pose())

    @property
    def rise_m(self) -> float:
        """How far the cap rises until it is off."""
        return self.thread.lead_m * self.thread.turns


def cap_on(profile: Profile, vessel: str) -> LabObject | None:
    """The cap whose thread closes the vessel, on it or not; None where no object of the profile does."""
    return next((item for item in profile.objects if item.thread and item.thread.on_object == vessel), None)


def refuse_capless(profile: Profile, name: str, span: Span) -> NoReturn:
    """Give up a step about an object that no cap of the profile closes (XEI0728)."""
    known = profile.object(name)
    closed = [f"`{item.thread.on_object}`" for item in profile.objects if item.thread]
    others = (f"with a screw cap: {', '.join(closed)}",) if closed else ()
    refuse(
        "XEI0728",
        f"`{name}` has no cap that could be turned",
        span,
        "no object of the profile closes it with a `thread`",
        (Label(known.span, "the object is stated here"),) if known else (),
        help=(*others, f"if it has one, state it, with `thread: {{closes: '{name}.spot(...)', ...}}`"),
    )


def subject_cap(work: Work) -> Cap:
    """The cap that an operation works with: its subject. Refuses caps and vessels that are not round
    (XEI0728).
    """
    assert isinstance(work.subject, ObjectRef)
    known = work.profile.object(work.subject.name)
    thread = known.thread if known else None
    vessel = work.profile.object(thread.on_object) if thread else None
    assert known is not None
    assert thread is not None
    assert vessel is not None
    for item in (known, vessel):
        if not isinstance(item.shape, Cylinder):
            refuse(
                "XEI0728",
                f"`{vessel.name}` cannot be opened or closed: `{item.name}` is not round",
                work.span,
                "expected a round cap on a round vessel",
                (Label(item.span, "its shape is stated here"),),
            )
    return Cap(known, thread, vessel)


def strokes_of(work: Work, cap: Cap) -> dict[str, Setting]:
    """The settings `lead`, `stroke_angle` and `more_strokes`: the turns of the thread in even strokes, each
    at most `stroke`, and how many follow the first. Refuses a stroke that no wrist makes, or too many of
    them (XEI0702).
    """
    stroke = work.layers.merge("stroke", None)
    assert stroke is not None
    most_rad = stroke.si("Angle")
    if not 0.0 < most_rad <= MOST_STROKE_RAD + 1e-9:
        refuse(
            "XEI0702",
            f"`stroke` of {stroke.text} is not a turn of this wrist",
            stroke.span or work.span,
            f"expected more than 0 deg and at most {math.degrees(MOST_STROKE_RAD):g} deg",
            notes=("a hand lets go and turns back between two strokes",),
        )
    turns = cap.thread.turns
    count = max(1, math.ceil(turns * math.tau / most_rad - 1e-9))
    if count - 1 > MOST_TIMES:
        refuse(
            "XEI0702",
            f"`stroke` of {stroke.text} makes {count} strokes of a thread",
            stroke.span or work.span,
            f"expected at least {math.ceil(turns * _WHOLE_DEG / (MOST_TIMES + 1) * 100) / 100:g} deg",
            (Label(cap.thread.span, f"the thread has {turns:g} turn{'' if turns == 1 else 's'}"),),
            notes=(f"a template repeats lines up to {MOST_TIMES} times",),
        )
    angle = Fraction(round(turns * _WHOLE_DEG / count * 1000), 1000)
    why = f"`thread: turns` of {turns:g} in {count} strokes of at most {stroke.text}"
    return {
        "lead": Setting(
            "lead",
            quantity(Fraction(round(cap.thread.lead_m * 1_000_000), 1000), "mm"),
            "usage_profile",
            "`thread: lead` of the cap",
            cap.thread.span,
        ),
        "stroke_angle": Setting("stroke_angle", quantity(angle, "deg"), "computed", why, None),
        "more_strokes": Setting(
            "more_strokes", Quantity(Fraction(count - 1), NUMBER, ""), "computed", why, None
        ),
    }


def depth_on_cap(work: Work, cap: Cap, fingertip_m: float) -> Setting:
    """How deep under the cap's top the jaws' grasp point lies: the fingertips end above the cap's rim."""
    height_m = cap.known.size_m[2]
    deepest_m = height_m - fingertip_m - 0.002
    rule = f"the fingertips reach {exact_mm(fingertip_m)} further, and stay 2 mm over the cap's rim"
    depth = work.layers.merge("cap_depth", computed_length("cap_depth", max(0.002, deepest_m), rule))
    assert depth is not None
    if not 0.0 < depth.si("Length") <= height_m:
        refuse(
            "XEI0702",
            f"`cap_depth` of {depth.text} is not on `{cap.known.name}`",
            depth.span or work.span,
            f"expected more than 0 mm and at most {exact_mm(height_m)}",
        )
    return depth


def raised(T_base_x: Pose, height_m: float) -> Pose:
    """The pose moved along its own z axis."""
    return T_base_x @ Pose((0.0, 0.0, height_m))


def up(T_base_x: Pose) -> Vec3:
    """The pose's z axis."""
    return T_base_x.axes()[2]
