"""What must stand somewhere for an operation, and what to say where it does not."""

from __future__ import annotations

from xei_lang.lower.in_hands import refuse_unplaced
from xei_lang.lower.operations.base import Work
from xei_lang.profiles.model import LabObject


def standing_object(work: Work, name: str) -> LabObject:
    """The object of this name; refuses one that a hand has, or whose place is not known (XEI0710)."""
    known = work.profile.object(name)
    if known is None or name not in work.scene.standing:
        refuse_unplaced(work.scene, name, work.span, f"used by `{work.step.skill}` where it is")
    return known
