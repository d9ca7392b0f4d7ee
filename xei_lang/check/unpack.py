"""Several names for the members of one list: `let a, b = pair`, `for a, b in pairs`."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope, SymbolKind
from xei_lang.check.value_words import kind
from xei_lang.check.values import POISON, ListValue, RecordValue, Val
from xei_lang.diagnostics import Label, Span
from xei_lang.syntax.ast import Name


def unpack(
    names: tuple[Name, ...], value: Val, scope: Scope, reporter: Reporter, given: Span | None = None
) -> bool:
    """Declare the names: one has the value itself, several have its members.

    `given` is the value of a `let`; without it they are the names of a loop. Where the value has not as many
    members, that is reported, and whatever uses the names says nothing more.
    """
    several: SymbolKind = "loop variable" if given is None else "part of a list"
    what: SymbolKind = several if given is None or len(names) > 1 else "variable"
    parts: Sequence[Val] = [value] if len(names) == 1 else [POISON] * len(names)
    fits = len(names) == 1 or value is POISON
    if not fits and isinstance(value, ListValue) and len(value.items) == len(names):
        parts, fits = value.items, True
    if not fits:
        _report(names, value, reporter, given)
    for name, part in zip(names, parts, strict=True):
        scope.declare(name, what, part, reporter)
    return fits


def _report(names: tuple[Name, ...], value: Val, reporter: Reporter, given: Span | None) -> None:
    count = len(value.items) if isinstance(value, ListValue) else None
    found = kind(value) if count is None else "1 value" if count == 1 else f"{count} values"
    listing = found if count is None else f"a list of {found}"
    is_loop = given is None
    if isinstance(value, RecordValue):
        help_ = "`row.column` is a cell of the row"
    elif is_loop:
        help_ = "`zip(a, b)` gives two values in each turn"
    elif count is None:
        help_ = "only a list or a tuple such as `(a, b)` has members to give names to"
    else:
        help_ = f"give it {count} names, or take a part of the list, as in `list[1 .. {len(names)}]`"
        help_ = help_ if count > len(names) else f"give it {'1 name' if count == 1 else f'{count} names'}"
    reporter.report(
        "XEI0314",
        f"{len(names)} names for {found}{' in each turn' if is_loop else ''}",
        names[0].span.join(names[-1].span),
        f"each turn gives {found}" if is_loop else f"{len(names)} names",
        labels=() if given is None else (Label(given, f"this is {listing}"),),
        help=(help_,),
    )
