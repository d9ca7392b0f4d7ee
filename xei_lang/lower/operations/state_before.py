"""What is known of a vessel when a step begins: its cap, and how much is in it."""

from __future__ import annotations

from xei_lang.ir.skill_plan import Value
from xei_lang.lower.operations.base import Work
from xei_lang.profiles.model import LabObject
from xei_lang.quantity import Quantity

CAP = "cap"
"""The state that says whether a vessel is open or closed."""


def cap_of(work: Work, vessel: LabObject) -> str:
    """`open` or `closed`: as the plan knows it, else as the profile says; empty where it has none."""
    initial = next((state.initial for state in vessel.states if state.name == CAP), "")
    return planned_cap(work, vessel.name) or initial


def planned_cap(work: Work, vessel: str) -> str:
    """`open` or `closed` as the plan knows it; empty where it does not."""
    value = _value(work, vessel, CAP)
    return "" if value is None else str(value)


def volume_in(work: Work, vessel: str) -> Quantity | None:
    """How much the plan knows to be in a vessel."""
    value = _value(work, vessel, "volume")
    return value if isinstance(value, Quantity) else None


def _value(work: Work, subject: str, variable: str) -> Value | None:
    facts = (fact for fact in work.step.state_before if fact.variable == variable)
    return next((fact.value for fact in facts if fact.subject == subject), None)
