"""The clocks of instruments in a dry run: what each works on, and for how long it has."""

from __future__ import annotations

from dataclasses import dataclass, field

from xei_lang.ir.goals import Instrument
from xei_lang.ir.timed import TimedGoal

TIME_TOLERANCE_S = 1e-6


@dataclass(slots=True)
class _Clock:
    instrument: str
    worked_s: float
    since_s: float | None


@dataclass(slots=True)
class Clocks:
    """A clock for each run that goes on; it stands still while the run is paused."""

    _running: dict[str, _Clock] = field(default_factory=dict[str, _Clock])

    def act(self, action: Instrument, timed: TimedGoal) -> str:
        """Let a goal happen to its run; what stands against it in words, or nothing."""
        if action.event is None:
            return ""
        if action.event == "start":
            return self._start(action, timed)
        clock = self._running.get(action.run)
        if clock is None or clock.instrument != action.instrument:
            return f"`{action.instrument}` does not work on `{action.run}`"
        if (clock.since_s is None) != (action.event == "resume"):
            return f"the run `{action.run}` is {'paused' if clock.since_s is None else 'not paused'}"
        if clock.since_s is None:
            clock.since_s = timed.end_s
        elif action.event == "pause":
            clock.worked_s, clock.since_s = clock.worked_s + timed.start_s - clock.since_s, None
        else:
            return self._end(action, timed, clock.worked_s + timed.end_s - clock.since_s)
        return ""

    def _start(self, action: Instrument, timed: TimedGoal) -> str:
        for run, clock in self._running.items():
            if run == action.run or clock.instrument == action.instrument:
                return f"`{action.instrument}` still works on `{run}`"
        self._running[action.run] = _Clock(action.instrument, 0.0, timed.end_s)
        return ""

    def _end(self, action: Instrument, timed: TimedGoal, worked_s: float) -> str:
        del self._running[action.run]
        if action.event == "await" and worked_s < action.work_s - TIME_TOLERANCE_S:
            at = f"has worked {worked_s:g} of {action.work_s:g} s at {timed.end_s:.2f} s"
            return f"`{action.instrument}` {at}, and is taken to be done"
        return ""
