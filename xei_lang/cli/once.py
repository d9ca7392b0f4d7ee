"""A mistake in a file that many protocols use is told once, not once for each of them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace

from xei_lang.cli.check_run import Checked
from xei_lang.diagnostics import Diagnostic, Span

_Key = tuple[str, int, int, str, str]
_CIRCLE = "XEI0121"


def told_once(checked: Sequence[Checked]) -> list[Checked]:
    """The same files; what is wrong with an import, a table or a profile is left with one of them.

    That is the file itself where it was checked too and says the same, else the first that uses it. A circle
    of imports is told of once, at whichever of them the first file closes it.
    """
    real: dict[str, str] = {}
    told = {_key(item, real) for one in checked for item in one.said if _is_own(item, one)}
    kept: list[Checked] = []
    for one in checked:
        said: list[Diagnostic] = []
        for item in one.said:
            key = _key(item, real)
            if _is_own(item, one) or key not in told:
                said.append(item)
                told.add(key)
        kept.append(one if len(said) == len(one.said) else replace(one, said=tuple(said)))
    return kept


def _is_own(item: Diagnostic, one: Checked) -> bool:
    return item.span is not None and item.span.file == one.file


def _key(item: Diagnostic, real: dict[str, str]) -> _Key:
    if item.span is None:
        return ("", 0, 0, item.code, item.message)
    if item.code == _CIRCLE:
        return _circle(item, item.span, real)
    return (*_place(item.span, real), item.code, item.message)


def _circle(item: Diagnostic, span: Span, real: dict[str, str]) -> _Key:
    """Of a circle of imports: all of them, for each of its files ends it with another one."""
    first, *others = sorted(_place(at, real) for at in (span, *(label.span for label in item.labels)))
    return (*first, item.code, repr(others))


def _place(span: Span, real: dict[str, str]) -> tuple[str, int, int]:
    if span.file not in real:
        real[span.file] = os.path.realpath(span.file)
    return (real[span.file], span.start, span.end)
