"""Edits of fixes: whole fixes only, none over another, nothing outside of them changes."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from xei_lang.diagnostics import Diagnostic, Edit, Fix, Source, Span
from xei_lang.diagnostics.apply import apply_fixes

TEXT = "0123456789"


def offer(*edits: tuple[int, int, str], applicability: str = "safe", file: str = "t.xei") -> Diagnostic:
    made = tuple(Edit(Span(file, start, end), text) for start, end, text in edits)
    return Diagnostic("XEI0104", f"{edits}", fix=Fix(applicability, made))  # type: ignore[arg-type]


def applied(*diagnostics: Diagnostic, allowed: tuple[str, ...] = ("safe",)) -> tuple[str, int]:
    mended = apply_fixes(Source("t.xei", TEXT), diagnostics, allowed)
    return mended.source.text, len(mended.applied)


def test_edits_are_applied_in_any_order() -> None:
    assert applied(offer((8, 9, "b")), offer((1, 2, "a"), (4, 4, "+"))) == ("0a23+4567b9", 2)


def test_only_what_is_allowed_and_lies_in_the_file_is_applied() -> None:
    others = [
        offer((0, 1, "x"), applicability="unsafe"),
        offer((0, 1, "x"), applicability="display"),
        offer((0, 1, "x"), file="other.xei"),
        offer((0, 11, "x")),
        offer(),
        Diagnostic("XEI0104", "no fix"),
    ]
    assert applied(*others) == (TEXT, 0)
    assert applied(*others, allowed=("safe", "unsafe")) == ("x123456789", 1)


def test_a_fix_that_overlaps_another_is_left_out_whole() -> None:
    assert applied(offer((2, 5, "a")), offer((4, 6, "b"), (8, 9, "c"))) == ("01a56789", 1)
    assert applied(offer((2, 4, "a"), (3, 5, "b"))) == (TEXT, 0)
    assert applied(offer((2, 2, "a")), offer((2, 2, "b"))) == ("01a23456789", 1)
    assert applied(offer((2, 4, "a")), offer((4, 6, "b")), offer((4, 4, "+"))) == ("01a+b6789", 3)


spans = st.tuples(st.integers(0, 10), st.integers(0, 10)).map(sorted)
edits = st.tuples(spans, st.sampled_from(["", "x", "yz"])).map(lambda one: (*one[0], one[1]))


@given(st.lists(st.lists(edits, min_size=1, max_size=3), max_size=6))
def test_what_no_edit_covers_stays(fixes: list[list[tuple[int, int, str]]]) -> None:
    mended = apply_fixes(Source("t.xei", TEXT), tuple(offer(*fix) for fix in fixes), ("safe",))
    taken = [edit for one in mended.applied if one.fix for edit in one.fix.edits]
    covered = {index for edit in taken for index in range(edit.span.start, edit.span.end)}
    assert sum(edit.span.end - edit.span.start for edit in taken) == len(covered)
    kept = "".join(char for index, char in enumerate(TEXT) if index not in covered)
    assert "".join(char for char in mended.source.text if char.isdigit()) == kept
    assert len(mended.source.text) == len(kept) + sum(len(edit.text) for edit in taken)
