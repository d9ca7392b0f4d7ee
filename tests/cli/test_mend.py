"""Mending ends, and never with more errors of syntax than there were."""

from __future__ import annotations

import math

import pytest
from hypothesis import given

from tests.syntax.corpus import in_protocol
from tests.syntax.test_properties import mutated
from xei_lang.cli.mend import MAX_ROUNDS, Checked, mend
from xei_lang.diagnostics import Diagnostic, Edit, Fix, Source, Span
from xei_lang.syntax import Parser

PARSER = Parser()


def check(source: Source) -> Checked:
    module, said = PARSER.module(source)
    faults = math.inf if module is None else sum(item.severity == "error" for item in said)
    return Checked(source, faults, said)


@pytest.mark.parametrize("allowed", [("safe",), ("safe", "unsafe")])
@given(text=mutated())
def test_a_text_never_ends_worse(allowed: tuple[str, ...], text: str) -> None:
    repaired = mend(Source("t.xei", text), check, allowed)
    assert repaired.end.faults <= check(Source("t.xei", text)).faults
    assert bool(repaired.fixed) == (repaired.end.source.text != text)


def test_many_mistakes_are_mended_in_few_checks() -> None:
    checks = 0

    def counted(source: Source) -> Checked:
        nonlocal checks
        checks += 1
        return check(source)

    text = in_protocol("wait 5 sec;\n" * 80)
    repaired = mend(Source("t.xei", text), counted, ("safe",))
    assert repaired.end.source.text == in_protocol("wait 5 s\n" * 80)
    assert checks < 12


def offering(*edits: tuple[str, str, float]) -> dict[str, Checked]:
    """For each text, what a check of it says: a fix that replaces it all, and its number of faults."""
    found: dict[str, Checked] = {}
    for text, mended, faults in edits:
        fix = Fix("safe", (Edit(Span("t", 0, len(text)), mended),))
        said = (Diagnostic("XEI0104", "wrong", Span("t", 0, len(text)), fix=fix),)
        found[text] = Checked(Source("t", text), faults, said)
    return found


def test_fixes_that_lead_in_a_circle_end() -> None:
    states = offering(("a", "b", 1), ("b", "c", 1), ("c", "a", 1))
    repaired = mend(Source("t", "a"), lambda source: states[source.text], ("safe",))
    assert repaired.end.source.text == "c"
    assert len(repaired.fixed) == 2


def test_fixes_without_end_are_bounded() -> None:
    repaired = mend(
        Source("t", ""),
        lambda source: offering((source.text, source.text + "x", 1))[source.text],
        ("safe",),
    )
    assert len(repaired.fixed) == MAX_ROUNDS


def test_a_fix_that_harms_is_not_applied() -> None:
    states = offering(("a", "b", 1), ("b", "a", 2))
    repaired = mend(Source("t", "a"), lambda source: states[source.text], ("safe",))
    assert (repaired.end.source.text, repaired.fixed) == ("a", ())
