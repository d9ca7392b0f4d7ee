"""The functions of expressions: `zip`, `len`, `sum`, `min`, `max`, and those of `rearrange`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce
from math import prod

from xei_lang.check import arithmetic
from xei_lang.check.budget import Budget
from xei_lang.check.rearrange import chunks, pairs, products, shuffled
from xei_lang.check.report import Reporter, guess, meant
from xei_lang.check.value_words import a, kind
from xei_lang.check.values import POISON, Interval, ListValue, ObjectValue, Val, nominal
from xei_lang.diagnostics import Edit, Fix, Span, did_you_mean
from xei_lang.quantity import DimensionError, Quantity
from xei_lang.syntax.ast import CallExpr, Name, Number

STATE_VARIABLES = (
    "volume",
    "temperature",
    "contents",
    "age",
    "holding",
    "at",
    "cap",
    "door",
    "power",
    "upright",
)
"""Names that a protocol may ask for the state of something; values of these come with state checking."""


def not_yet(reporter: Reporter, words: str, span: Span) -> None:
    """Refuse a construct that belongs to the language and that this version gives no meaning to."""
    reporter.report(
        "XEI0105",
        f"{words} cannot be compiled yet",
        span,
        "not supported by this version",
        help=("leave it out for now, or write the same with the constructs that are supported",),
    )


class Functions:
    """Calls of functions whose arguments are already values."""

    def __init__(self, reporter: Reporter, budget: Budget) -> None:
        self._reporter = reporter
        self._budget = budget
        self._table: dict[str, Callable[[CallExpr, tuple[Val, ...]], Val]] = {
            "zip": self._zip,
            "len": self._len,
            "sum": self._sum,
            "min": self._least,
            "max": self._greatest,
            "ceil": self._ceil,
            "chunks": self._chunks,
            "pairs": self._pairs,
            "product": self._product,
            "shuffle": self._shuffle,
        }
        self.names = tuple(self._table)

    def call(self, function: Name, node: CallExpr, args: tuple[Val, ...]) -> Val:
        """The value of a call of a known function; POISON where an argument is."""
        allowed = ("seed",) if function.id == "shuffle" else ()
        named = next((arg for arg in node.args if arg.name is not None and arg.name.id not in allowed), None)
        if named is not None and named.name is not None:
            return self._wrong(f"`{function.id}` takes no argument `{named.name.id}`", named.span)
        return POISON if POISON in args else self._table[function.id](node, args)

    def unknown(self, function: Name, node: CallExpr, skills: tuple[str, ...]) -> Val:
        """Report a call of something that is no function of expressions."""
        name = function.id
        if name in STATE_VARIABLES:
            self._wrong(f"`{name}` cannot be asked for here", function.span, "there is no plan to follow")
        elif name == "range":
            self._range(function, node)
        elif name in skills:
            self._wrong(
                f"`{name}` is a skill and has no value", function.span, "a skill is a statement of its own"
            )
        else:
            known = (*self.names, "pose", *STATE_VARIABLES)
            self._reporter.report(
                "XEI0319",
                f"there is no function `{name}`",
                function.span,
                "not a function",
                help=meant(did_you_mean(name, known)) or (f"there are {', '.join(self.names)}",),
                fix=guess(function.span, did_you_mean(name, known)),
            )
        return POISON

    def _range(self, function: Name, node: CallExpr) -> None:
        ends = [arg.value.value for arg in node.args if isinstance(arg.value, Number)]
        whole = [end for end in ends if isinstance(end, int)]
        range_ = f"1 .. {whole[0]}" if len(whole) == 1 else "1 .. 8"
        if len(whole) == 2:
            range_ = f"{whole[0]} .. {whole[1] - 1}"
        self._reporter.report(
            "XEI0319",
            "`range` is written as `1 .. 8` here",
            function.span,
            "both ends are included",
            help=(f"write `for i in {range_}`, or as a list `[i for i in {range_}]`",),
            fix=Fix("display", (Edit(node.span, range_),)),
        )

    def _zip(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        lists = [arg for arg in args if isinstance(arg, ListValue)]
        if len(lists) < 2 or len(lists) < len(args):
            return self._wrong("`zip` takes two lists or more", node.span)
        lengths = [len(item.items) for item in lists]
        if not self._budget.spend(sum(lengths), node.span):
            return POISON
        if len(set(lengths)) > 1:
            self._reporter.report(
                "XEI0320",
                f"`zip` of lists of different lengths: {', '.join(map(str, lengths))}",
                node.span,
                "each turn takes one of each, so the lists must be equally long",
                help=("take a part of the longer list, as in `rack.slots[1 .. 6]`",),
            )
            return POISON
        return ListValue(tuple(ListValue(row) for row in zip(*(item.items for item in lists), strict=True)))

    def _len(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        if len(args) == 1 and isinstance(args[0], ListValue):
            return len(args[0].items)
        of_rack = len(args) == 1 and isinstance(args[0], ObjectValue)
        return self._wrong("`len` takes one list", node.span, "as in `len(rack.slots)`" if of_rack else "")

    def _sum(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        return self._fold(node, args, lambda left, right: arithmetic.combine("+", left, right))

    def _least(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        return self._fold(node, args, lambda left, right: arithmetic.extreme("min", left, right))

    def _greatest(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        return self._fold(node, args, lambda left, right: arithmetic.extreme("max", left, right))

    def _ceil(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        value = args[0] if len(args) == 1 else None
        probe = value.lower if isinstance(value, Interval) else value
        if value is None or not arithmetic.is_numeric(value) or isinstance(probe, Quantity):
            is_quantity = isinstance(probe, Quantity)
            label = f"divide it by its unit, as in `ceil(v / 1 {probe.unit})`" if is_quantity else ""
            return self._wrong("`ceil` takes one plain number", node.span, label)
        return arithmetic.rounded_up(value)

    def _chunks(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        size = _stand_in(args[1]) if len(args) == 2 else None
        if not isinstance(size, int) or isinstance(size, bool) or not isinstance(args[0], ListValue):
            return self._wrong("`chunks` takes a list and a number", node.span, "as in `chunks(tubes, 4)`")
        if size < 1:
            return self._wrong(f"chunks of {size} members are none", node.args[1].span, "expected 1 or more")
        return self._rearranged(node, len(args[0].items), args[0], lambda items: chunks(items, size))

    def _pairs(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        if len(args) != 1 or not isinstance(args[0], ListValue):
            return self._wrong("`pairs` takes one list", node.span, "each member is paired with the next")
        return self._rearranged(node, 2 * len(args[0].items), args[0], pairs)

    def _product(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        lists = [arg.items for arg in args if isinstance(arg, ListValue)]
        if len(lists) < 2 or len(lists) < len(args):
            return self._wrong("`product` takes two lists or more", node.span)
        count = prod(len(items) for items in lists) * len(lists)
        return products(lists) if self._budget.spend(count, node.span) else POISON

    def _shuffle(self, node: CallExpr, args: tuple[Val, ...]) -> Val:
        seed = _stand_in(args[1]) if len(args) == 2 and node.args[1].name is not None else None
        if not isinstance(seed, int) or isinstance(seed, bool) or not isinstance(args[0], ListValue):
            text = "`shuffle` takes a list and `seed=`, a whole number"
            return self._wrong(text, node.span, "as in `shuffle(tubes, seed=7)`")
        return self._rearranged(node, len(args[0].items), args[0], lambda items: shuffled(items, seed))

    def _rearranged(
        self, node: CallExpr, cost: int, value: ListValue, make: Callable[[Sequence[Val]], Val]
    ) -> Val:
        return make(value.items) if self._budget.spend(cost, node.span) else POISON

    def _fold(self, node: CallExpr, args: tuple[Val, ...], step: Callable[[Val, Val], Val]) -> Val:
        items = args[0].items if len(args) == 1 and isinstance(args[0], ListValue) else args
        if POISON in items or not self._are_numbers(node, items):
            return POISON
        if not self._budget.spend(len(items), node.span):
            return POISON
        try:
            return reduce(step, items)
        except arithmetic.TooLargeError as error:
            return self._wrong(str(error), node.span)
        except DimensionError as error:
            message = f"cannot {error.operation} {a(error.left.name)} and {a(error.right.name)}"
            self._reporter.report("XEI0312", message, node.span, "these do not go together")
            return POISON

    def _are_numbers(self, node: CallExpr, items: Sequence[Val]) -> bool:
        name = node.function.id if isinstance(node.function, Name) else ""
        wrong = next((item for item in items if not arithmetic.is_numeric(item)), None)
        if not items:
            self._wrong(f"`{name}` of an empty list has no value", node.span, "there is nothing in it")
        elif wrong is not None:
            text = f"`{name}` takes numbers or quantities, or a list of them, not {kind(wrong)}"
            self._wrong(text, node.span)
        return bool(items) and wrong is None

    def _wrong(self, message: str, span: Span, label: str = "") -> Val:
        self._reporter.report("XEI0319", message, span, label)
        return POISON


def _stand_in(value: Val) -> Val:
    """What stands for a number that is still open, unless it is measured."""
    return value if isinstance(value, Interval) and value.needs else nominal(value)
