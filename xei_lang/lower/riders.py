"""What rides on other things, screwed on by its thread: no hand just lifts it off, and none sets it on."""

from __future__ import annotations

from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef
from xei_lang.lower.operations.base import Operation, Work
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.operations.handover import TAKE
from xei_lang.lower.operations.place import PLACE
from xei_lang.lower.refusal import refuse
from xei_lang.lower.seats import place_text

_LIFTING = (GRASP, TAKE)


def refuse_fastened(operation: Operation, work: Work) -> None:
    """Give up a grasp that would lift what is screwed on something else (XEI0727)."""
    name = work.subject.name if isinstance(work.subject, ObjectRef) else ""
    carrier = work.scene.carrier_of(name)
    if operation not in _LIFTING or not carrier:
        return
    known = work.profile.object(name)
    thread = known.thread if known else None
    refuse(
        "XEI0727",
        f"`{name}` cannot be lifted: it is screwed on `{carrier}`",
        work.span,
        f"fastened on `{carrier}`, and comes off by its thread alone",
        (Label(thread.span, "its thread is stated here"),) if thread else (),
        help=(
            f"unscrew it: `twist_open(object={carrier}, hold=left, twist=right)`",
            f"or pick `{carrier}`, which takes it along",
        ),
    )


def refuse_set_on_thread(operation: Operation, work: Work) -> None:
    """Give up to set a cap down on the thread that it is turned along (XEI0729): there it would neither be
    screwed on nor stand by itself.
    """
    known, place = work.profile.object(work.object), work.subject
    thread = known.thread if known else None
    if operation is not PLACE or thread is None or not isinstance(place, PlaceRef):
        return
    if (place.object, place.key) != (thread.on_object, thread.on_key):
        return
    refuse(
        "XEI0729",
        f"`{work.object}` cannot be set down on `{place_text(place)}`: it is screwed on there",
        work.span,
        f"closes `{place.object}` by its thread, which `{work.step.skill}` does not turn",
        (Label(thread.span, "its thread is stated here"),),
        help=(
            f"leave it where it lies, and screw it on: `twist_close(object={place.object}, hold=left,"
            " twist=right)`",
        ),
    )
