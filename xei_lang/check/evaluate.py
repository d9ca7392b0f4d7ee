"""Expressions to values, at compile time."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from xei_lang.check import arithmetic
from xei_lang.check.budget import Budget
from xei_lang.check.functions import STATE_VARIABLES, Functions
from xei_lang.check.lists import Lists
from xei_lang.check.places import METHODS, PROPERTIES, Places
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, guess, listed, meant, replace
from xei_lang.check.scope import Scope
from xei_lang.check.types import ANY_ARM
from xei_lang.check.values import (
    POISON,
    ListValue,
    ObjectValue,
    PlaceValue,
    RecordValue,
    TableValue,
    Val,
    Word,
    a,
    kind,
    number,
    show,
)
from xei_lang.diagnostics import Label, did_you_mean
from xei_lang.ir.skill_plan import StationRef
from xei_lang.quantity import DimensionError
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

_THINGS = (Word, ObjectValue, PlaceValue)
"""What a state may be: where something is can be a hand, an object's surface or a place of it."""

ANY_WORD = ("*",)
"""Given as `words`: whatever the name is, it may be a word (the argument of a skill that is not known)."""


class Evaluator:
    """Evaluates expressions in a scope. What is wrong is reported and becomes POISON."""

    def __init__(self, registry: Registry, places: Places, reporter: Reporter, budget: Budget) -> None:
        self._registry = registry
        self._places = places
        self._reporter = reporter
        self.budget = budget
        self.lists = Lists(reporter, self.value, budget)
        self._functions = Functions(reporter, budget)
        self._asked: Asked | None = None

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
        match node:
            case Name():
                return self._name(node, scope, words)
            case QuantityLit():
                return node.value
            case Number():
                return number(node.value)
            case StringLit() | Bool():
                return node.value
            case Unary():
                return self._unary(node, scope)
            case Binary():
                return self._binary(node, scope)
            case Compare():
                return self._compare(node, scope)
            case BoolOp():
                return self._bool_op(node, scope)
            case Attr():
                return self._attribute(node, scope)
            case CallExpr():
                return self._call(node, scope)
            case ListLit() | TupleLit():
                return ListValue(tuple(self.value(item, scope, words) for item in node.items))
            case Index():
                return self.lists.index(node, scope)
            case Range():
                return self.lists.range(node, scope)
            case Comprehension():
                return self.lists.comprehension(node, scope)

    def _name(self, node: Name, scope: Scope, words: tuple[str, ...]) -> Val:
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
        lower = node.id.lower()
        is_bool = lower in ("true", "false")
        self._reporter.report(
            "XEI0202",
            f"`{node.id}` is not known here",
            node.span,
            f"expected {' or '.join(f'`{word}`' for word in words)}"
            if len(words) > 1
            else "no object, station, parameter or variable has this name",
            help=(f"write `{lower}`",) if is_bool else meant(near) or _place_habit(node.id),
            fix=replace(node.span, lower) if is_bool else guess(node.span, near),
        )

    def _unary(self, node: Unary, scope: Scope) -> Val:
        value = self.value(node.operand, scope)
        if value is POISON:
            return POISON
        if node.op == "not":
            return (not value) if isinstance(value, bool) else self._not_a(value, "a Bool", node.operand)
        return (
            arithmetic.negate(value)
            if arithmetic.is_numeric(value)
            else self._not_a(value, "a number", node.operand)
        )

    def _binary(self, node: Binary, scope: Scope) -> Val:
        def combine(left: Val, right: Val) -> Val:
            return arithmetic.combine(node.op, left, right)

        return self._numbers(node, scope, combine)

    def _compare(self, node: Compare, scope: Scope) -> Val:
        def compare(left: Val, right: Val) -> Val:
            answer = arithmetic.compare(node.op, left, right)
            return POISON if answer is None else answer

        if node.op in ("==", "!="):
            left = self.value(node.left, scope)
            right = self.value(node.right, scope, self._state_words(node.left, scope))
            if left is POISON or right is POISON:
                return POISON
            if not (arithmetic.is_numeric(left) and arithmetic.is_numeric(right)):
                return self._same(node, left, right)
        return self._numbers(node, scope, compare)

    def _state_words(self, node: Expression, scope: Scope) -> tuple[str, ...]:
        if self._asked is None or not isinstance(node, CallExpr) or not node.args:
            return ()
        return self._asked.words(node, lambda: self.value(node.args[0].value, scope))

    def _same(self, node: Compare, left: Val, right: Val) -> Val:
        if self._asked is not None and isinstance(left, _THINGS) and isinstance(right, _THINGS):
            if _is_open(left) or _is_open(right):
                return POISON
            return (show(left) == show(right)) == (node.op == "==")
        if kind(left) != kind(right) and not {type(left), type(right)} <= {str, Word}:
            return self._mismatch(node, left, right, f"cannot compare {kind(left)} with {kind(right)}")
        if _is_open(left) or _is_open(right):
            return POISON
        return (show(left) == show(right)) == (node.op == "==")

    def _numbers(self, node: Binary | Compare, scope: Scope, apply: Callable[[Val, Val], Val]) -> Val:
        left = self.value(node.left, scope)
        right = self.value(node.right, scope)
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
        except arithmetic.TooLargeError:
            self._reporter.report(
                "XEI0312",
                "this number has too many digits",
                node.span,
                "no quantity in a laboratory is that large",
            )
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
        )
        return POISON

    def _bool_op(self, node: BoolOp, scope: Scope) -> Val:
        decisive = node.op == "or"
        found: list[Val] = []
        for side in (node.left, node.right):
            value = self.value(side, scope)
            if value is not POISON and not isinstance(value, bool):
                return self._not_a(value, "a Bool", side)
            found.append(value)
        if decisive in (value for value in found if value is not POISON):
            return decisive
        return POISON if POISON in found else not decisive

    def _attribute(self, node: Attr, scope: Scope) -> Val:
        owner = self.value(node.value, scope)
        if owner is POISON:
            return POISON
        name = node.name.id
        if isinstance(owner, RecordValue | TableValue):
            return self._column(owner, node)
        if isinstance(owner, ObjectValue) and name in PROPERTIES:
            return self._places.property(owner, name, node.span)
        known = (*METHODS, *PROPERTIES)
        if isinstance(owner, ObjectValue) and name in METHODS:
            shown, help = (
                f"`{name}` of `{show(owner)}` needs an argument",
                (f"write `{show(owner)}.{name}(...)`",),
            )
        elif isinstance(owner, ObjectValue):
            shown = f"`{show(owner)}` has no `{name}`"
            help = meant(did_you_mean(name, known)) or (
                f"an object has {', '.join(f'`{word}`' for word in known)}",
            )
        else:
            shown, help, known = f"{kind(owner)} has no `{name}`", (), ()
        fix = guess(node.name.span, did_you_mean(name, known))
        self._reporter.report("XEI0319", shown, node.name.span, "no such attribute", help=help, fix=fix)
        return POISON

    def _column(self, owner: RecordValue | TableValue, node: Attr) -> Val:
        columns = owner.fields if isinstance(owner, RecordValue) else owner.columns
        name = node.name.id
        if name in columns:
            return columns[name]
        self._reporter.report(
            "XEI0319",
            f"the table has no column `{name}`",
            node.name.span,
            f"its columns are {listed(tuple(columns), 12)}",
            help=meant(did_you_mean(name, columns)),
            fix=guess(node.name.span, did_you_mean(name, columns)),
        )
        return POISON

    def _call(self, node: CallExpr, scope: Scope) -> Val:
        function = node.function
        if isinstance(function, Attr) and function.name.id in METHODS:
            return self._method(node, function, scope)
        if isinstance(function, Attr):
            self._attribute(function, scope)
            return POISON
        if isinstance(function, Name):
            if function.id in self._functions.names:
                args = tuple(self.value(arg.value, scope) for arg in node.args)
                return self._functions.call(function, node, args)
            if self._asked is not None and function.id in STATE_VARIABLES:
                subject = self.value(node.args[0].value, scope) if node.args else POISON
                return self._asked.value(function, node, subject)
            return self._functions.unknown(function, tuple(self._registry.skills))
        self._reporter.report("XEI0319", "this cannot be called", function.span, "not a function")
        return POISON

    def _method(self, node: CallExpr, function: Attr, scope: Scope) -> Val:
        owner = self.value(function.value, scope)
        args = [self.value(arg.value, scope) for arg in node.args]
        if owner is POISON:
            return POISON
        if isinstance(owner, ObjectValue) and len(args) == 1:
            return self._places.method(owner, function.name.id, args[0], node)
        if isinstance(owner, ObjectValue):
            message, label = (
                f"`{function.name.id}` takes one argument, not {len(args)}",
                "expected one argument",
            )
        else:
            message, label = f"{kind(owner)} has no `{function.name.id}`", "only an object has places"
        self._reporter.report("XEI0319", message, node.span, label)
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


def _place_habit(name: str) -> tuple[str, ...]:
    looks = len(name) in (2, 3) and name[0].isupper() and name[1:].isdigit()
    return (
        (f'a slot belongs to a rack: write `rack.slot("{name}")` with the name of your rack',)
        if looks
        else ()
    )
