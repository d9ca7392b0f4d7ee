"""How long an `await` can still take, from what the plan says that happens since the start."""

from __future__ import annotations

import math
from collections.abc import Sequence

from xei_lang.check.works import Work
from xei_lang.ir.skill_plan import Step

_Bounds = tuple[float, float]


def remaining_s(work: Work, steps: Sequence[Step], tails: Sequence[str], when: tuple[object, ...]) -> _Bounds:
    """Shortest and longest time from the end of the steps `tails` to the end of the work, in seconds.

    `when` is the condition under which that matters: steps of other conditions need not have happened.
    Where steps that the work does not follow hold the end up, they may do so for any time.
    """
    low, high = elapsed_s(work.step_id, steps[work.index :], tails, when)
    return max(0.0, work.duration_s[0] - high), max(0.0, work.duration_s[1] - low)


def elapsed_s(start: str, steps: Sequence[Step], tails: Sequence[str], when: tuple[object, ...]) -> _Bounds:
    """Shortest and longest working time from the step `start`, the first of `steps`, to the end of `tails`.

    Longest paths over `after`; the time inside a pause is no working time.
    """
    known: dict[str, _Bounds] = {start: (0.0, 0.0)}
    paused = False
    for step in steps[1:]:
        low, high = _after(known, step.after)
        if step.kind in ("pause", "resume") and step.arg("step") == start:
            paused = step.kind == "pause"
        shortest, longest = (0.0, 0.0) if paused else step.duration_s
        surely = step.when == when[: len(step.when)]
        if any(before in known for before in step.after):
            known[step.step_id] = (low + shortest if surely else low, high + longest)
    return _after(known, tails)


def _after(known: dict[str, _Bounds], names: Sequence[str]) -> _Bounds:
    bounds = [known[name] for name in names if name in known]
    low = max((bound[0] for bound in bounds), default=0.0)
    high = max((bound[1] for bound in bounds), default=0.0) if len(bounds) == len(names) else math.inf
    return low, high
