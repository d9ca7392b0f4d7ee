"""Applying the fixes of diagnostics to a text."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Container
from dataclasses import dataclass
from itertools import pairwise

from xei_lang.diagnostics.diagnostic import Applicability, Diagnostic, Diagnostics, Edit
from xei_lang.diagnostics.span import Source


@dataclass(frozen=True, slots=True, eq=False)
class Mended:
    """A text with the edits of some diagnostics in it, and these diagnostics in the order of the text."""

    source: Source
    applied: Diagnostics


def apply_fixes(source: Source, diagnostics: Diagnostics, allowed: Container[Applicability]) -> Mended:
    """Apply the fixes of an allowed applicability that lie in this text alone.

    A fix is applied whole or not at all. Where two overlap, the one that begins first is applied; the other
    may be found again in the new text.
    """
    taken: list[Edit] = []
    applied: list[Diagnostic] = []
    for edits, diagnostic in _offered(source, diagnostics, allowed):
        if all(_room_for(edit, taken) for edit in edits):
            for edit in edits:
                insort(taken, edit, key=_place)
            applied.append(diagnostic)
    text: list[str] = []
    position = 0
    for edit in taken:
        text += [source.text[position : edit.span.start], edit.text]
        position = edit.span.end
    return Mended(Source(source.file, "".join(text) + source.text[position:]), tuple(applied))


def _offered(
    source: Source, diagnostics: Diagnostics, allowed: Container[Applicability]
) -> list[tuple[tuple[Edit, ...], Diagnostic]]:
    """The fixes that may be applied, in the order of the text."""
    found: list[tuple[tuple[Edit, ...], Diagnostic]] = []
    for diagnostic in diagnostics:
        fix = diagnostic.fix
        if fix is None or fix.applicability not in allowed or not fix.edits:
            continue
        edits = tuple(sorted(fix.edits, key=_place))
        inside = all(
            edit.span.file == source.file and 0 <= edit.span.start <= edit.span.end <= len(source.text)
            for edit in edits
        )
        if inside and all(_clear(left, right) for left, right in pairwise(edits)):
            found.append((edits, diagnostic))
    return sorted(found, key=lambda one: _place(one[0][0]))


def _room_for(edit: Edit, taken: list[Edit]) -> bool:
    """Whether an edit touches none of those that were taken, which are in order and apart."""
    index = bisect_left(taken, _place(edit), key=_place)
    before, behind = taken[max(0, index - 1) : index], taken[index : index + 1]
    return all(_clear(other, edit) for other in before) and all(_clear(edit, other) for other in behind)


def _clear(left: Edit, right: Edit) -> bool:
    """Whether the first ends before the second; side by side will do, but not two insertions in one place."""
    return left.span.end <= right.span.start and _place(left) != _place(right)


def _place(edit: Edit) -> tuple[int, int]:
    return edit.span.start, edit.span.end
