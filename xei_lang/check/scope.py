"""Names and what they stand for: parameters, objects, `let`s and loop variables, block in block."""

from __future__ import annotations

from typing import Literal

from xei_lang.check.report import Reporter
from xei_lang.check.values import POISON, Val
from xei_lang.diagnostics import Label, Span
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import Name

SymbolKind = Literal[
    "object", "parameter", "variable", "part of a list", "loop variable", "measurement", "table"
]
_SHOULD_BE_USED = ("object", "parameter", "variable", "table")


@record
class Symbol(Shown):
    """A declared name: what it is worth, and where it was declared."""

    name: str
    kind: SymbolKind
    value: Val
    span: Span


class Usage:
    """Which declarations were ever used; shared by all scopes of one check."""

    def __init__(self) -> None:
        self._declared: dict[Span, Symbol] = {}
        self._used: set[Span] = set()

    def declare(self, symbol: Symbol) -> None:
        """Remember a declaration that somebody should use."""
        self._declared.setdefault(symbol.span, symbol)

    def use(self, symbol: Symbol) -> None:
        """Remember that it was used."""
        self._used.add(symbol.span)

    def warn(self, reporter: Reporter, file: str) -> None:
        """Report objects, parameters and variables of a file that nothing uses; what is wrong is let be."""
        for span, symbol in self._declared.items():
            if (
                span.file == file
                and span not in self._used
                and symbol.kind in _SHOULD_BE_USED
                and symbol.value is not POISON
            ):
                reporter.report(
                    "XEI0501",
                    f"{symbol.kind} `{symbol.name}` is never used",
                    span,
                    "declared here and not used",
                    help=(f"use `{symbol.name}` or remove its declaration",),
                )


class Scope:
    """The names of one block, and through `parent` those of the blocks around it."""

    def __init__(self, usage: Usage, parent: Scope | None = None) -> None:
        self._usage = usage
        self._parent = parent
        self._symbols: dict[str, Symbol] = {}

    def child(self) -> Scope:
        """The scope of a block inside this one."""
        return Scope(self._usage, self)

    def declare(self, name: Name, kind: SymbolKind, value: Val, reporter: Reporter) -> None:
        """Give a name its value; a second declaration in the same block is an error and keeps the first."""
        before = self._symbols.get(name.id)
        if before is not None:
            reporter.report(
                "XEI0209",
                f"`{name.id}` is declared twice in this block",
                name.span,
                "declared again here",
                labels=(Label(before.span, f"first declared here, as {_article(before.kind)}"),),
                help=("give one of the two another name",),
            )
            return
        symbol = Symbol(name.id, kind, value, name.span)
        self._symbols[name.id] = symbol
        self._usage.declare(symbol)

    def find(self, name: str) -> Symbol | None:
        """What a name stands for here, marked as used; None where it is not declared."""
        scope: Scope | None = self
        while scope is not None:
            symbol = scope._symbols.get(name)
            if symbol is not None:
                self._usage.use(symbol)
                return symbol
            scope = scope._parent
        return None

    def names(self) -> tuple[str, ...]:
        """Every name that can be used here."""
        own = tuple(self._symbols)
        return own if self._parent is None else own + self._parent.names()


def _article(kind: str) -> str:
    return f"an {kind}" if kind == "object" else f"a {kind}"
