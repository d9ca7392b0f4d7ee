"""Writes events into the chain of a trace, and tells whether a chain is still the one that was written."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.forms.trace_json import NO_HASH, from_line, is_sealed, line_hash, to_line
from xei_lang.ir.trace import Stage, TraceEvent


class Recorder:
    """Numbers, times and chains the events of one run and hands each on as soon as it exists."""

    def __init__(self, emit: Callable[[TraceEvent], None]) -> None:
        self._emit = emit
        self._seq = 0
        self._hash = NO_HASH
        self.t = 0.0

    def add(self, stage: Stage, representation: dict[str, Any], step_id: str = "", goal_id: str = "") -> None:
        """One more event at the run's present time."""
        event = TraceEvent(self._seq, self.t, stage, self._hash, step_id, goal_id, representation)
        self._seq += 1
        self._hash = line_hash(to_line(event))
        self._emit(event)

    def advance(self, t_s: float) -> None:
        """Bring the clock forward, to the microsecond; it never runs back."""
        self.t = max(self.t, round(t_s, 6))


def verify_chain(lines: Sequence[str]) -> Diagnostics:
    """Nothing for the lines of a whole trace (without line breaks), else the first that does not fit."""
    expected = NO_HASH
    for index, text in enumerate(lines):
        try:
            event = from_line(text)
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
            return (Diagnostic("XEI0960", f"line {index + 1} of the trace is no event"),)
        if event.seq != index:
            return _broken(
                index, f"it has the number {event.seq} and {index} is next: a line was added, cut or moved"
            )
        if event.prev_hash != expected:
            return _broken(index, "its `prev_hash` is not the hash of the line before it")
        if event.stage == "end":
            if index + 1 < len(lines):
                return _broken(index + 1, "a trace has no line after its end")
            return () if is_sealed(text) else _broken(index, "its `seal` does not fit what it says")
        expected = line_hash(text)
    return (Diagnostic("XEI0961", "the trace breaks off: its last line is not of stage `end`"),)


def _broken(index: int, note: str) -> Diagnostics:
    return (
        Diagnostic(
            "XEI0960", f"line {index + 1} of the trace is not the one that was written", notes=(note,)
        ),
    )
