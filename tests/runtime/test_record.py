from __future__ import annotations

from hypothesis import assume, given
from hypothesis import strategies as st

from tests.runtime.small import handoffs
from xei_lang.ir.forms.trace_json import from_line, to_line
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.record import verify_chain
from xei_lang.runtime.run import run


def _lines() -> tuple[str, ...]:
    lines: list[str] = []
    run(handoffs(), "dry-run", Answers({"confirm#1": True}), lambda event: lines.append(to_line(event)))
    return tuple(lines)


LINES = _lines()
index = st.integers(0, len(LINES) - 1)


def test_the_chain_of_a_run_holds_and_reads_back() -> None:
    assert verify_chain(LINES) == ()
    assert [to_line(from_line(line)) for line in LINES] == list(LINES)


@given(index, st.data())
def test_any_edit_shows(at: int, data: st.DataObject) -> None:
    line = LINES[at]
    place = data.draw(st.integers(0, len(line) - 1))
    cut = data.draw(st.integers(0, 3))
    edited = line[:place] + data.draw(st.text(max_size=3)) + line[place + cut :]
    assume(edited != line)
    assert verify_chain((*LINES[:at], edited, *LINES[at + 1 :]))


@given(index)
def test_a_removed_line_shows(at: int) -> None:
    assert verify_chain((*LINES[:at], *LINES[at + 1 :]))


@given(st.integers(0, len(LINES) - 1))
def test_a_cut_trace_shows(length: int) -> None:
    assert [item.code for item in verify_chain(LINES[:length])] == ["XEI0961"]


@given(index, index)
def test_swapped_or_repeated_lines_show(one: int, other: int) -> None:
    assume(one != other)
    swapped = list(LINES)
    swapped[one], swapped[other] = swapped[other], swapped[one]
    assert verify_chain(swapped)
    assert verify_chain((*LINES[:one], LINES[other], *LINES[one:]))


@given(st.lists(st.text(max_size=40), max_size=4))
def test_anything_else_is_no_trace(lines: list[str]) -> None:
    assert verify_chain(lines)
