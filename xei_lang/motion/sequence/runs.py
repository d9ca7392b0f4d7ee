"""Goals that wait for an instrument: they last as long as its work still takes when they start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from xei_lang.ir.goals import Instrument
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.sequence.motions import Motion


def awaited(motion: Motion, before: Sequence[Motion], timed: Sequence[TimedGoal], start_s: float) -> Motion:
    """The motion with its duration where it awaits a run, from what was timed before it; any other as it is.

    `before` and `timed` are the goals so far, in one order; times are the plan's, in seconds.
    """
    action = motion.goal.action
    if not isinstance(action, Instrument) or action.event != "await":
        return motion
    worked_s, since_s = 0.0, start_s
    for earlier, goal in zip(before, timed, strict=True):
        event = earlier.goal.action
        if not isinstance(event, Instrument) or event.run != action.run:
            continue
        if event.event == "pause":
            worked_s, since_s = worked_s + goal.start_s - since_s, start_s
        elif event.event in ("start", "resume"):
            since_s = goal.end_s
    worked_s += start_s - since_s
    return replace(motion, duration_s=max(motion.duration_s, action.work_s - worked_s))
