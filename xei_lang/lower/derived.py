"""What an argument of a template leads to beyond itself: `object.cap` is the cap that closes the object, and
`object.rest` is where that one lies while the object is open.
"""

from __future__ import annotations

from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Step, Value
from xei_lang.lower.operations.caps import cap_on, refuse_capless
from xei_lang.profiles.model import Profile


def leads_to(profile: Profile, step: Step, span: Span, name: str) -> Value | None:
    """The value of an argument, or what it leads to; None for words that mean nothing here. Refuses an object
    that no cap closes (XEI0728).
    """
    argument, _, word = name.partition(".")
    value = step.arg(argument)
    if not word or not isinstance(value, ObjectRef):
        return None if word else value
    cap = cap_on(profile, value.name)
    if cap is None or cap.thread is None:
        refuse_capless(profile, value.name, span)
    if word == "cap":
        return ObjectRef(cap.name)
    return PlaceRef(cap.thread.rest_object, "spot", cap.thread.rest_key) if word == "rest" else None


def cap_meant(profile: Profile, step: Step, name: str) -> str:
    """The cap that `object.cap` or `object.rest` speaks of; empty for any other argument."""
    argument, _, word = name.partition(".")
    value = step.arg(argument)
    cap = cap_on(profile, value.name) if word and isinstance(value, ObjectRef) else None
    return cap.name if cap else ""
