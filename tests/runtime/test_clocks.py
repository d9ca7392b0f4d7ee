"""The dry run's clocks of instruments: work takes its time, and pauses do not count."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.goals import Instrument, RunEvent
from xei_lang.ir.timed import TimedGoal
from xei_lang.runtime.executors.instruments import Clocks


def happen(clocks: Clocks, event: RunEvent, start_s: float, end_s: float, run: str = "warm") -> str:
    timed = TimedGoal(f"{run}/{event}", run, "instrument", "block", ("block",), 0, start_s, end_s)
    return clocks.act(Instrument("block", event, run, event, 60.0), timed)


@given(st.lists(st.tuples(st.floats(0.0, 20.0), st.floats(0.0, 20.0)), max_size=2), st.floats(0.01, 5.0))
def test_an_await_that_ends_too_soon_is_found(pauses: list[tuple[float, float]], short_s: float) -> None:
    now, worked = 10.0, 0.0
    early, late = Clocks(), Clocks()
    for clocks in (early, late):
        assert happen(clocks, "start", 5.0, 10.0) == ""
    for work_s, pause_s in pauses:
        now, worked = now + work_s, worked + work_s
        for clocks in (early, late):
            assert happen(clocks, "pause", now, now) == ""
            assert happen(clocks, "resume", now + pause_s, now + pause_s) == ""
        now += pause_s
    done = now + 60.0 - worked
    assert happen(late, "await", now, done) == ""
    assert "is taken to be done" in happen(early, "await", now, done - short_s)


@pytest.mark.parametrize(
    ("events", "words"),
    [
        (("stop",), "does not work on `warm`"),
        (("start", "start"), "still works on `warm`"),
        (("start", "stop", "await"), "does not work on `warm`"),
        (("start", "resume"), "is not paused"),
        (("start", "pause", "pause"), "is paused"),
        (("start", "pause", "stop"), "is paused"),
    ],
)
def test_what_cannot_happen_fails(events: tuple[RunEvent, ...], words: str) -> None:
    clocks = Clocks()
    *before, last = [happen(clocks, event, 0.0, 0.0) for event in events]
    assert not any(before)
    assert words in last


def test_an_instrument_is_free_again_once_it_was_stopped() -> None:
    clocks = Clocks()
    said = [
        happen(clocks, "start", 0.0, 0.0),
        happen(clocks, "stop", 5.0, 5.0),
        happen(clocks, "start", 6.0, 6.0, "b"),
    ]
    assert said == ["", "", ""]
