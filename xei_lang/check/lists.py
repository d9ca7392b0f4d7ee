"""Lists: ranges that are counted before anything is made, indices that count from 1, comprehensions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol, overload

from xei_lang.check import arithmetic
from xei_lang.check.budget import Budget
from xei_lang.check.report import Reporter
from xei_lang.check.run_time import known_now
from xei_lang.check.scope import Scope
from xei_lang.check.unpack import unpack
from xei_lang.check.value_habits import NO_MEND, slot_of
from xei_lang.check.value_words import kind, show
from xei_lang.check.values import POISON, ListValue, Numeric, ObjectValue, Val, nominal
from xei_lang.diagnostics import Span
from xei_lang.quantity import DimensionError, Quantity
from xei_lang.syntax.ast import Comprehension, Expression, Index, Name, Range


class Evaluate(Protocol):
    """How the parts of an expression are evaluated."""

    def __call__(self, node: Expression | Range, scope: Scope, words: tuple[str, ...] = ()) -> Val:
        """The value of an expression or a range; `words` may stand in it bare."""
        ...


@dataclass(frozen=True, slots=True)
class Progression(Sequence[Val]):
    """`first, first + step, ...`, so many of them; each is made when it is asked for."""

    first: Numeric
    step: Numeric
    length: int

    def __len__(self) -> int:
        return self.length

    @overload
    def __getitem__(self, index: int) -> Val: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Val]: ...
    def __getitem__(self, index: int | slice) -> Val | Sequence[Val]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(self.length))]
        index += self.length if index < 0 else 0
        if not 0 <= index < self.length:
            raise IndexError(index)
        return arithmetic.combine("+", self.first, arithmetic.combine("*", self.step, index))


class Lists:
    """Evaluates what makes lists and what takes them apart."""

    def __init__(self, reporter: Reporter, evaluate: Evaluate, budget: Budget) -> None:
        self._reporter = reporter
        self._evaluate = evaluate
        self._budget = budget

    def range(self, node: Range, scope: Scope) -> Val:
        """`1 .. 8`, `0 mL .. 5 mL step 1 mL`: both ends included; empty where they are the wrong way."""
        parts = [self._now(part, "an end of a range", scope) for part in (node.lower, node.upper)]
        step = 1 if node.step is None else self._now(node.step, "the step of a range", scope)
        if POISON in parts or step is POISON:
            return POISON
        for value, part in zip(
            (*parts, step), (node.lower, node.upper, node.step or node.upper), strict=True
        ):
            if not arithmetic.is_numeric(value):
                return self._wrong(
                    "XEI0305", f"`{show(value)}` is {kind(value)}, but a range needs numbers", part.span
                )
        if node.step is None and not (isinstance(parts[0], int) and isinstance(parts[1], int)):
            return self._wrong(
                "XEI0314",
                f"the range `{show(parts[0])} .. {show(parts[1])}` needs a step",
                node.span,
                "only whole numbers go up by one by themselves",
                (f"write for example `{show(parts[0])} .. {show(parts[1])} step {_one_of(parts[1])}`",),
            )
        return self._progression(node, parts[0], parts[1], step)

    def _now(self, node: Expression, what: str, scope: Scope) -> Val:
        """What must be known before anything runs; an open parameter is its nominal value."""
        return nominal(known_now(self._evaluate(node, scope), what, node.span, self._reporter))

    def _progression(self, node: Range, lower: Val, upper: Val, step: Val) -> Val:
        span = (node.step or node).span
        try:
            width = arithmetic.combine("-", upper, lower)
            if not arithmetic.compare(">", step, arithmetic.combine("-", step, step)):
                return self._wrong(
                    "XEI0314", f"the step `{show(step)}` does not go up", span, "expected more than zero"
                )
            turns = arithmetic.combine("/", width, step)
        except DimensionError as error:
            names = f"{error.left.name} and {error.right.name}"
            return self._wrong("XEI0312", f"the parts of this range do not go together: {names}", node.span)
        if isinstance(turns, Quantity):
            return self._wrong(
                "XEI0312", "the step of this range is of another dimension than its ends", span
            )
        assert isinstance(turns, (int, Fraction))
        assert isinstance(lower, (int, Fraction, Quantity))
        assert isinstance(step, (int, Fraction, Quantity))
        return ListValue(Progression(lower, step, max(0, int(turns) + 1 if turns >= 0 else 0)))

    def index(self, node: Index, scope: Scope) -> Val:
        """`list[2]`, `list[1 .. 4]`, counted from 1."""
        value = self._evaluate(node.value, scope)
        which = known_now(
            self._evaluate(node.index, scope), "the number of a member", node.index.span, self._reporter
        )
        if value is POISON or which is POISON:
            return POISON
        if not isinstance(value, ListValue):
            return self._no_list(value, which, node)
        if isinstance(which, ListValue):
            return self._part(value, which, node)
        position = self._position(nominal(which), value, node)
        return POISON if position is None else value.items[position]

    def _no_list(self, value: Val, which: Val, node: Index) -> Val:
        help, fix = NO_MEND
        if isinstance(value, ObjectValue):
            written = node.value.id if isinstance(node.value, Name) else value.name
            if isinstance(which, str):
                help, fix = slot_of(value, which, written, node.span)
            elif value.registered is not None and value.registered.slots is not None:
                help = (f"its places are lists: `{written}.slots[1]`, `{written}.row(...)[1]`",)
        message = f"`{show(value)}` is {kind(value)}, not a list"
        self._reporter.report("XEI0314", message, node.value.span, "expected a list", help=help, fix=fix)
        return POISON

    def _part(self, value: ListValue, which: ListValue, node: Index) -> Val:
        chosen: list[Val] = []
        ends = (which.items[0], which.items[-1]) if which.items else ()
        if any(self._position(end, value, node) is None for end in ends):
            return POISON
        if not self._budget.spend(len(which.items), node.span):
            return POISON
        for item in which.items:
            position = self._position(item, value, node)
            if position is None:
                return POISON
            chosen.append(value.items[position])
        return ListValue(tuple(chosen))

    def _position(self, which: Val, value: ListValue, node: Index) -> int | None:
        count = len(value.items)
        if not isinstance(which, int) or isinstance(which, bool):
            self._wrong("XEI0314", f"`{show(which)}` cannot number a member of a list", node.index.span)
            return None
        if not 1 <= which <= count:
            self._wrong(
                "XEI0314",
                f"there is no member {which} in a list of {count}",
                node.index.span,
                f"expected 1 .. {count}" if count else "the list is empty",
                _counting(which, node),
            )
            return None
        return which - 1

    def comprehension(self, node: Comprehension, scope: Scope) -> Val:
        """`[element for names in list if condition]`."""
        source = self.members(self._evaluate(node.iterable, scope), node.iterable)
        if source is None or not self._budget.spend(len(source), node.span):
            return POISON
        made: list[Val] = []
        for item in source:
            inner = scope.child()
            if not unpack(node.names, item, inner, self._reporter):
                return POISON
            keep = True if node.condition is None else self._evaluate(node.condition, inner)
            if node.condition is not None:
                keep = known_now(keep, "what this list has in it", node.condition.span, self._reporter)
            if keep is POISON or not self._is_condition(keep, node):
                return POISON
            if keep is True:
                made.append(self._evaluate(node.element, inner))
        return ListValue(tuple(made))

    def _is_condition(self, value: Val, node: Comprehension) -> bool:
        if isinstance(value, bool):
            return True
        assert node.condition is not None
        message = f"`{show(value)}` is {kind(value)}, but `if` takes a condition"
        self._wrong("XEI0305", message, node.condition.span, f"expected a Bool, found {kind(value)}")
        return False

    def members(self, value: Val, node: Expression | Range) -> Sequence[Val] | None:
        """What a loop goes through; None where that is no list, which is reported if it is new."""
        if isinstance(value, ListValue):
            return value.items
        if value is not POISON:
            self._wrong(
                "XEI0314",
                f"`{show(value)}` is {kind(value)}, and a loop goes through a list",
                node.span,
                "expected a list or a range such as `1 .. 4`",
            )
        return None

    def _wrong(self, code: str, message: str, span: Span, label: str = "", help: tuple[str, ...] = ()) -> Val:
        self._reporter.report(code, message, span, label, help=help)
        return POISON


def _one_of(value: Val) -> str:
    """One of the unit of a value: `1 mL` of `5 mL`."""
    return f"1 {value.unit}" if isinstance(value, Quantity) else "1"


def _counting(which: int, node: Index) -> tuple[str, ...]:
    if which == 0:
        return ("members are counted from 1",)
    if which < 0 and isinstance(node.value, Name):
        return (f"the last one is `{node.value.id}[len({node.value.id})]`",)
    return ()
