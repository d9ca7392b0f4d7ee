"""Names to values: what is declared, the words that may stand bare, the objects and stations of the lab."""

from __future__ import annotations

from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, meant
from xei_lang.check.scope import Scope
from xei_lang.check.types import ANY_ARM
from xei_lang.check.value_habits import in_place_of_a_name
from xei_lang.check.values import POISON, ObjectValue, Val, Word
from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.skill_plan import StationRef
from xei_lang.syntax.ast import Name

ANY_WORD = ("*",)
"""Given as `words`: whatever the name is, it may be a word (the argument of a skill that is not known)."""


class Names:
    """Finds what a name means."""

    def __init__(self, registry: Registry, reporter: Reporter) -> None:
        self._registry = registry
        self._reporter = reporter

    def value(self, node: Name, scope: Scope, words: tuple[str, ...]) -> Val:
        """What a name is worth; `words` are those of an enumeration that may stand here bare."""
        symbol = scope.find(node.id)
        if symbol is not None:
            return symbol.value
        if node.id in words:
            return Word(node.id)
        thing = self._registry.objects.get(node.id)
        if thing is not None:
            return ObjectValue(thing.name, thing)
        if node.id in self._registry.stations:
            return StationRef(node.id)
        if node.id in self._registry.arms or node.id == ANY_ARM:
            return Word(node.id)
        if words is not ANY_WORD:
            self._unknown(node, scope, words)
        return POISON

    def _unknown(self, node: Name, scope: Scope, words: tuple[str, ...]) -> None:
        known = (*scope.names(), *words, *self._registry.objects, *self._registry.stations)
        near = did_you_mean(node.id, known)
        help, fix = in_place_of_a_name(node.id, node.span, self._registry)
        if near and (fix is None or fix.applicability != "safe"):
            help, fix = meant(near), guess(node.span, near)
        self._reporter.report(
            "XEI0202",
            f"`{node.id}` is not known here",
            node.span,
            f"expected {' or '.join(f'`{word}`' for word in words)}"
            if len(words) > 1
            else "no object, station, parameter or variable has this name",
            help=help,
            fix=fix,
        )
