"""Expressions to values, at compile time."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from xei_lang.check.budget import Budget
from xei_lang.check.functions import Functions
from xei_lang.check.lists import Lists
from xei_lang.check.members import Members
from xei_lang.check.names import Names
from xei_lang.check.operators import Operators
from xei_lang.check.places import Places
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter
from xei_lang.check.scope import Scope
from xei_lang.check.values import POISON, ListValue, Val, number
from xei_lang.syntax.ast import (
    Attr,
    Binary,
    Bool,
    BoolOp,
    CallExpr,
    Compare,
    Comprehension,
    Expression,
    Index,
    ListLit,
    Name,
    Number,
    QuantityLit,
    Range,
    StringLit,
    TupleLit,
    Unary,
)

if TYPE_CHECKING:
    from xei_lang.check.conditions import Asked
    from xei_lang.check.nominal import Nominal


class Evaluator:
    """Evaluates expressions in a scope. What is wrong is reported and becomes POISON."""

    def __init__(self, registry: Registry, places: Places, reporter: Reporter, budget: Budget) -> None:
        self.budget = budget
        self.lists = Lists(reporter, self.value, budget)
        self._names = Names(registry, reporter)
        self._operators = Operators(reporter, self.value, budget)
        self._members = Members(registry, places, Functions(reporter, budget), reporter, self.value)
        self._asked: Asked | None = None
        self.nominal: Nominal | None = None
        """Answers what is asked of the state outside of conditions, where the walk has come to."""

    @contextmanager
    def asking(self, asked: Asked) -> Generator[None]:
        """While a condition is evaluated that may ask for states."""
        self._asked = asked
        try:
            yield
        finally:
            self._asked = None

    def value(  # noqa: PLR0911, PLR0912 one return for each kind of node
        self, node: Expression | Range, scope: Scope, words: tuple[str, ...] = ()
    ) -> Val:
        """The value of an expression; `words` are the words of an enumeration that may stand here bare."""
        if not self.budget.spend(1, node.span):
            return POISON
        match node:
            case Name():
                return self._names.value(node, scope, words)
            case QuantityLit():
                return node.value
            case Number():
                return number(node.value)
            case StringLit() | Bool():
                return node.value
            case Unary():
                return self._operators.unary(node, scope)
            case Binary():
                return self._operators.binary(node, scope)
            case Compare():
                return self._operators.compare(node, scope, self._asked)
            case BoolOp():
                return self._operators.bool_op(node, scope)
            case Attr():
                return self._members.attribute(node, scope)
            case CallExpr():
                return self._members.call(node, scope, self._asked or self.nominal)
            case ListLit() | TupleLit():
                return ListValue(tuple(self.value(item, scope, words) for item in node.items))
            case Index():
                return self.lists.index(node, scope)
            case Range():
                return self.lists.range(node, scope)
            case Comprehension():
                return self.lists.comprehension(node, scope)
