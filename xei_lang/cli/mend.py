"""Mending a text by the fixes of its diagnostics, again and again until none is left."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass

from xei_lang.diagnostics import Applicability, Diagnostic, Diagnostics, Source
from xei_lang.diagnostics.apply import apply_fixes

MAX_ROUNDS = 100


@dataclass(frozen=True, slots=True, eq=False)
class Checked:
    """What is wrong with a text; `faults` counts the places where it does not follow the grammar."""

    source: Source
    faults: float
    said: Diagnostics


@dataclass(frozen=True, slots=True, eq=False)
class Repaired:
    """The text in the end, each fix with the text that it was made in, and what is still wrong."""

    end: Checked
    fixed: tuple[tuple[Source, Diagnostic], ...]


Check = Callable[[Source], Checked]


def mend(source: Source, check: Check, allowed: Container[Applicability]) -> Repaired:
    """Apply fixes, check, and begin again, until no fix is left or `MAX_ROUNDS` are over.

    A fix that leaves more faults of syntax than before, or leads back to an earlier text, is not applied.
    """
    now = check(source)
    seen = {source.text}
    fixed: list[tuple[Source, Diagnostic]] = []
    for _ in range(MAX_ROUNDS):
        found = _round(now, check, allowed, seen)
        if found is None:
            break
        fixed += [(now.source, diagnostic) for diagnostic in found[1]]
        now = found[0]
        seen.add(now.source.text)
    return Repaired(now, tuple(fixed))


def _round(
    now: Checked, check: Check, allowed: Container[Applicability], seen: Container[str]
) -> tuple[Checked, Diagnostics] | None:
    """All fixes at once, or where that does harm the first one that alone does none."""
    together = apply_fixes(now.source, now.said, allowed)
    attempts = [together]
    if len(together.applied) > 1:
        attempts += [apply_fixes(now.source, (diagnostic,), allowed) for diagnostic in together.applied]
    for attempt in attempts:
        if not attempt.applied or attempt.source.text in seen:
            continue
        after = check(attempt.source)
        if after.faults <= now.faults:
            return after, attempt.applied
    return None
