"""A profile that does not load, as blockers: nothing can be made with it."""

from __future__ import annotations

from pathlib import PurePosixPath

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.doctor.blocker import Blocker


def fault_blockers(said: Diagnostics) -> tuple[Blocker, ...]:
    """One blocker for each error that was said of a profile when it was loaded."""
    return tuple(_blocker(item) for item in said if item.severity == "error")


def _blocker(item: Diagnostic) -> Blocker:
    file = PurePosixPath(item.span.file) if item.span else PurePosixPath("")
    measure = "; ".join(item.help) or item.label or "correct it"
    return Blocker(
        item.code, file.stem or "profile", item.message, "error", "simulate", measure, file.name, item.span
    )
