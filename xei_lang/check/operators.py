"""Operators: arithmetic, comparisons, `and`, `or`, `not`."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from xei_lang.check import arithmetic
from xei_lang.check.budget import Budget
from xei_lang.check.equality import same
from xei_lang.check.lists import Evaluate
from xei_lang.check.names import ANY_WORD
from xei_lang.check.report import Reporter
from xei_lang.check.run_time import MAX_FORMULA, formula_of, joined, needs_of, negated
from xei_lang.check.scope import Scope
from xei_lang.check.value_words import a, kind, show
from xei_lang.check.values import POISON, Interval, ObjectValue, PlaceValue, Undecided, Val, Word
from xei_lang.diagnostics import Label
from xei_lang.quantity import DimensionError, Quantity
from xei_lang.syntax.ast import Attr, Binary, BoolOp, CallExpr, Compare, Expression, Unary

if TYPE_CHECKING:
    from xei_lang.check.conditions import Asked

_THINGS = (Word, ObjectValue, PlaceValue)
"""What a state may be: where something is can be a hand, an object's surface or a place of it."""


class Operators:
    """Applies operators to what their sides are worth."""

    def __init__(self, reporter: Reporter, evaluate: Evaluate, budget: Budget) -> None:
        self._reporter = reporter
        self._budget = budget
        self._evaluate = evaluate

    def unary(self, node: Unary, scope: Scope) -> Val:
        """`-a`, `not a`."""
        value = self._evaluate(node.operand, scope)
        if value is POISON:
            return POISON
        if node.op == "not":
            if isinstance(value, Undecided):
                return negated(value)
            return (not value) if isinstance(value, bool) else self._not_a(value, "a Bool", node.operand)
        return (
            arithmetic.negate(value)
            if arithmetic.is_numeric(value)
            else self._not_a(value, "a number", node.operand)
        )

    def binary(self, node: Binary, scope: Scope) -> Val:
        """`a + b` and the like."""

        def combine(left: Val, right: Val) -> Val:
            return arithmetic.combine(node.op, left, right)

        return self._numbers(node, scope, combine)

    def compare(self, node: Compare, scope: Scope, asked: Asked | None) -> Val:
        """`a == b` and the like; where a condition asks for states, of things and words too."""

        def compare(left: Val, right: Val) -> Val:
            answer = arithmetic.compare(node.op, left, right)
            return self._open(node.op, left, right) if answer is None else answer

        if node.op in ("==", "!="):
            left = self._evaluate(node.left, scope)
            lost = left is POISON and isinstance(node.left, Attr)
            words = ANY_WORD if lost else self._state_words(node.left, scope, asked)
            right = self._evaluate(node.right, scope, words)
            if left is POISON or right is POISON:
                return POISON
            if not (arithmetic.is_numeric(left) and arithmetic.is_numeric(right)):
                return self._same(node, left, right, asked)
        return self._numbers(node, scope, compare)

    def bool_op(self, node: BoolOp, scope: Scope) -> Val:
        """`a and b`, `a or b`: decided by one side where that is enough."""
        decisive = node.op == "or"
        found: list[Val] = []
        for side in (node.left, node.right):
            value = self._evaluate(side, scope)
            if value is not POISON and not isinstance(value, (bool, Undecided)):
                return self._not_a(value, "a Bool", side)
            found.append(value)
        if decisive in (value for value in found if isinstance(value, bool)):
            return decisive
        undecided = [value for value in found if isinstance(value, Undecided)]
        if POISON in found or not undecided:
            return POISON if POISON in found else not decisive
        return self._short(joined(node.op, undecided), node)

    def _open(self, op: str, left: Val, right: Val) -> Val:
        """A comparison that is not decided here: by what is measured when it runs, if anything is."""
        needs = needs_of(left, right)
        return Undecided(f"{formula_of(left)} {op} {formula_of(right)}", needs) if needs else POISON

    def _short(self, value: Undecided, node: Expression) -> Val:
        if len(value.formula) <= MAX_FORMULA:
            return value
        self._reporter.report(
            "XEI0312",
            "this condition is too long to be carried in a plan",
            node.span,
            f"takes {len(value.formula)} characters where its names are written out, at most {MAX_FORMULA}",
        )
        return POISON

    def _state_words(self, node: Expression, scope: Scope, asked: Asked | None) -> tuple[str, ...]:
        if asked is None or not isinstance(node, CallExpr) or not node.args:
            return ()
        return asked.words(node, lambda: self._evaluate(node.args[0].value, scope))

    def _same(self, node: Compare, left: Val, right: Val, asked: Asked | None) -> Val:
        if asked is not None and isinstance(left, _THINGS) and isinstance(right, _THINGS):
            if _is_open(left) or _is_open(right):
                return POISON
            return (show(left) == show(right)) == (node.op == "==")
        if kind(left) != kind(right) and not {type(left), type(right)} <= {str, Word}:
            return self._mismatch(node, left, right, f"cannot compare {kind(left)} with {kind(right)}")
        if isinstance(left, Undecided) or isinstance(right, Undecided):
            return self._open(node.op, left, right)
        if _is_open(left) or _is_open(right):
            return POISON
        answer = same(left, right, lambda count: self._budget.spend(count, node.span))
        return POISON if self._budget.is_spent or answer is None else answer == (node.op == "==")

    def _numbers(self, node: Binary | Compare, scope: Scope, apply: Callable[[Val, Val], Val]) -> Val:
        left = self._evaluate(node.left, scope)
        right = self._evaluate(node.right, scope)
        if left is POISON or right is POISON:
            return POISON
        for value, side in ((left, node.left), (right, node.right)):
            if not arithmetic.is_numeric(value):
                return self._not_a(value, "a number or quantity", side)
        try:
            return apply(left, right)
        except DimensionError as error:
            text = f"cannot {error.operation} {a(error.left.name)} and {a(error.right.name)}"
            return self._mismatch(node, left, right, text)
        except arithmetic.TooLargeError as error:
            self._reporter.report("XEI0312", str(error), node.span, "no laboratory needs one as large")
            return POISON
        except ZeroDivisionError:
            self._reporter.report(
                "XEI0313", f"`{show(left)}` is divided by zero", node.right.span, f"this is {show(right)}"
            )
            return POISON

    def _mismatch(self, node: Binary | Compare, left: Val, right: Val, message: str) -> Val:
        self._reporter.report(
            "XEI0312",
            message,
            node.span,
            f"`{node.op}` needs two of a kind" if node.op not in ("*", "/") else "these do not go together",
            labels=(
                Label(node.left.span, f"{kind(left)}: {show(left)}"),
                Label(node.right.span, f"{kind(right)}: {show(right)}"),
            ),
            help=_with_unit(node.op, left, right),
        )
        return POISON

    def _not_a(self, value: Val, wanted: str, node: Expression) -> Val:
        self._reporter.report(
            "XEI0305",
            f"`{show(value)}` is {kind(value)}, but {wanted} is needed here",
            node.span,
            f"expected {wanted}, found {kind(value)}",
        )
        return POISON


def _is_open(value: Val) -> bool:
    owner = value.owner if isinstance(value, PlaceValue) else value
    return isinstance(owner, ObjectValue) and owner.registered is None


def _with_unit(op: str, left: Val, right: Val) -> tuple[str, ...]:
    """What to say where a bare number stands beside a quantity: the number, with the quantity's unit."""
    for one, other in ((left, right), (right, left)):
        quantity = one.lower if isinstance(one, Interval) else one
        if isinstance(quantity, Quantity) and quantity.unit and op not in ("*", "/") and _is_plain(other):
            return (f"write the number with its unit, for example `{show(other)} {quantity.unit}`",)
    return ()


def _is_plain(value: Val) -> bool:
    return isinstance(value, int | Fraction) and not isinstance(value, bool)
