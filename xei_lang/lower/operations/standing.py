"""What must stand somewhere for an operation, and what to say where it does not."""

from __future__ import annotations

from xei_lang.lower.operations.base import Work
from xei_lang.lower.refusal import refuse
from xei_lang.profiles.model import LabObject


def standing_object(work: Work, name: str) -> LabObject:
    """The object of this name; refuses one of which it is not known where it stands (XEI0710)."""
    known = work.profile.object(name)
    if known is None or name not in work.scene.standing:
        refuse("XEI0710", f"it is not known where `{name}` stands", work.span, "not in the world")
    return known
