"""What people see: layout, several places, several files, and text that must not reach the terminal raw."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.diagnostics import Diagnostic, Label, Source, Span
from xei_lang.diagnostics.render.full import render_full

LINES = [*("# line" for _ in range(10)), "  given cap(bottle) == closed", *("# line" for _ in range(4))]
POUR = "    pour(source=bottle, target=tube, volume=volume) within 30 s"
PROTOCOL = Source("protocols/aliquot.xei", "\n".join(["# line", *LINES, POUR, "}", ""]))


def span_of(source: Source, words: str, after: int = 0) -> Span:
    start = source.text.index(words, after)
    return Span(source.file, start, start + len(words))


def show(*diagnostics: Diagnostic, sources: tuple[Source, ...]) -> str:
    return render_full(diagnostics, {source.file: source for source in sources})


def test_the_example_of_the_language_description() -> None:
    diagnostic = Diagnostic(
        "XEI0104",
        "`buffer_bottle` is still closed when it is poured",
        span_of(PROTOCOL, "source"),
        "`pour` requires cap(source) == open",
        (Label(span_of(PROTOCOL, "cap(bottle) == closed"), "closed since here"),),
        notes=("rule: profiles/openarm_bench/development_profile.yaml:212",),
        help=("insert `twist_open(object=bottle, hold=left, twist=right)` before this step",),
    )
    assert (
        show(diagnostic, sources=(PROTOCOL,))
        == """\
error[XEI0104]: `buffer_bottle` is still closed when it is poured
  --> protocols/aliquot.xei:17:10
   |
12 |   given cap(bottle) == closed
   |         --------------------- closed since here
17 |     pour(source=bottle, target=tube, volume=volume) within 30 s
   |          ^^^^^^ `pour` requires cap(source) == open
   |
   = rule: profiles/openarm_bench/development_profile.yaml:212
   = help: insert `twist_open(object=bottle, hold=left, twist=right)` before this step
"""
    )


def test_many_shapes(golden: Callable[[str, str], None]) -> None:
    main = Source(
        "main.xei", 'import "caps.xei"\n\tpick(\ta=b)  # tab\ndo {\n  wait 1 s\n\n  home()\n} within 5 s\n'
    )
    other = Source("caps.xei", "# caps\nprocedure open_cap() { }\n")
    wide = Source("wide.xei", 'note "液体を注ぐ" because e\u0301 x\n')
    long = Source("long.xei", "a" * 500 + " wrong " + "b" * 500)
    diagnostics = (
        Diagnostic("XEI0101", "`gone.xei` does not exist", help=("look again",)),
        Diagnostic("XEI0104", "after tabs", span_of(main, "a=b"), "here"),
        Diagnostic("XEI0104", "several lines", span_of(main, "do {\n  wait 1 s\n\n  home()\n}"), "all of it"),
        Diagnostic(
            "XEI0104",
            "in two files",
            span_of(main, '"caps.xei"'),
            "imported here",
            (Label(span_of(other, "open_cap"), "defined here"), Label(Span("x.csv", 3, 4), "no source")),
        ),
        Diagnostic(
            "XEI0104",
            "several on one line",
            span_of(main, "a=b"),
            "the argument",
            (Label(span_of(main, "pick"), "the skill"), Label(span_of(main, "# tab"), "a comment")),
        ),
        Diagnostic("XEI0104", "wide characters", span_of(wide, "because"), "after them"),
        Diagnostic("XEI0104", "wide and marked", span_of(wide, '"液体を注ぐ"'), "these\nand more"),
        Diagnostic("XEI0104", "after a combining mark", span_of(wide, "x"), "x"),
        Diagnostic("XEI0104", "in a long line", span_of(long, "wrong"), "here"),
        Diagnostic("XEI0104", "at the end", Span("main.xei", 999, 999), "expected more"),
        Diagnostic("XEI0104", "a file that was not read", Span("x.csv", 3, 4), "unseen"),
        Diagnostic(
            "XEI0104", "notes", span_of(main, "home"), notes=("one\ntwo", "rule: bank.yaml:3"), help=("a\nb",)
        ),
    )
    golden("render_full.txt", show(*diagnostics, sources=(main, other, wide, long)))


def test_nothing_is_printed_raw() -> None:
    evil = "\x1b[31mred\x07\u202e\x9b\x00"
    source = Source(evil, f"{evil}\n{evil}")
    everything = Diagnostic(
        "XEI0104", evil, Span(evil, 2, 20), evil, (Label(Span(evil, 0, 1), evil),), (evil,), (evil,)
    )
    shown = render_full((everything,), {evil: source})
    assert all(char == "\n" or char.isprintable() for char in shown)
    assert "<U+001B>" in shown


def test_colour_adds_escape_codes_and_nothing_else() -> None:
    diagnostic = Diagnostic("XEI0104", "wrong", span_of(PROTOCOL, "source"), "here", help=("mend it",))
    sources = {PROTOCOL.file: PROTOCOL}
    coloured = render_full((diagnostic,), sources, color=True)
    assert "\x1b[" in coloured
    assert re.sub(r"\x1b\[[0-9;]*m", "", coloured) == render_full((diagnostic,), sources)


def test_none_is_empty() -> None:
    assert render_full((), {}) == ""


@pytest.mark.parametrize("text", ["", "\n", "a", "\r\n", "ab\ncd\n\n"])
@given(data=st.data())
def test_any_span_can_be_shown(text: str, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(text) + 2))
    span = Span("t.xei", start, data.draw(st.integers(start, len(text) + 3)))
    shown = render_full((Diagnostic("XEI0104", "m", span, "here"),), {"t.xei": Source("t.xei", text)})
    assert shown.count("here") == 1
    assert "^" in shown
