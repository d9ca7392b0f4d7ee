"""Values that are given on the command line: `--param volume="2 mL"`, `--bind tubes="[tube_1, tube_2]"`."""

from __future__ import annotations

from typing import Literal

from xei_lang.check.evaluate import Evaluator
from xei_lang.check.expectation import Expectation
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope, Usage
from xei_lang.check.state import State
from xei_lang.check.types import ANY_ARM, Types
from xei_lang.check.values import POISON, ListValue, Val
from xei_lang.diagnostics import Source
from xei_lang.diagnostics.options import option_value
from xei_lang.syntax.ast import Expression, Range, StringLit


class OptionValues:
    """Reads values as expressions of the language; what is wrong is shown in the text of the option."""

    def __init__(self, registry: Registry, evaluator: Evaluator, types: Types, reporter: Reporter) -> None:
        self._registry = registry
        self._evaluator = evaluator
        self._types = types
        self._reporter = reporter

    def read(
        self, flag: Literal["param", "bind"], name: str, given: str, expected: Expectation, state: State
    ) -> Val:
        """The value as what is expected; a text needs no quotes."""
        span = option_value(flag, name, given)
        if expected.type == "String" and not expected.lists:
            return given.strip('"') if len(given) > 1 and given[0] == given[-1] == '"' else given
        node = self._expression(Source(span.file, " " * span.start + given))
        if node is None:
            return POISON
        words = (*self._registry.arms, ANY_ARM) if expected.type == "Arm" else ()
        value = self._evaluator.value(node, Scope(Usage()), words)
        if isinstance(value, ListValue) and not self._evaluator.budget.spend(len(value.items), span):
            return POISON
        written = StringLit(given, span) if isinstance(node, Range) else node
        return self._types.coerce(value, expected, written, state)

    def _expression(self, source: Source) -> Expression | Range | None:
        """The syntax of a value; the parser is loaded only where the command line gives one."""
        from xei_lang.syntax import Parser

        node, diagnostics = Parser().expression(source)
        for diagnostic in diagnostics:
            self._reporter.keep(diagnostic)
        return None if diagnostics else node
