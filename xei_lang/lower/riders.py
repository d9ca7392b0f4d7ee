"""What rides on other things, screwed on by its thread: where it would be fastened, and that no hand just
lifts it off.
"""

from __future__ import annotations

from xei_lang.diagnostics import Label
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef
from xei_lang.lower.operations.base import Operation, Work
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.operations.handover import TAKE
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import Profile

_LIFTING = (GRASP, TAKE)


def carrier_at(profile: Profile, name: str, place: PlaceRef) -> str:
    """The object that this one is fastened on where it stands in a place; empty where it just stands."""
    known = profile.object(name)
    thread = known.thread if known else None
    is_on = thread is not None and (thread.on_object, thread.on_key) == (place.object, place.key)
    return place.object if is_on else ""


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
