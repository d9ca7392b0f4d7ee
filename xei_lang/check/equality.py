"""Whether two values are the same, of any type but numbers that are still open."""

from __future__ import annotations

from collections.abc import Callable

from xei_lang.check import arithmetic
from xei_lang.check.values import ListValue, RecordValue, Val, Word, show
from xei_lang.ir.skill_plan import PoseIn
from xei_lang.quantity import DimensionError

Spend = Callable[[int], bool]
"""Whether so many more members may be looked at."""


def same(left: Val, right: Val, spend: Spend) -> bool:  # noqa: PLR0911 one return for each kind of value
    """Lists, rows and poses by their parts, numbers and quantities by what they are worth, all else as it is
    written. False where the budget is spent, which has been reported then.
    """
    if isinstance(left, ListValue) and isinstance(right, ListValue):
        pairs = zip(left.items, right.items, strict=False)
        if len(left.items) != len(right.items) or not spend(len(left.items)):
            return False
        return all(same(a, b, spend) for a, b in pairs)
    if isinstance(left, RecordValue) and isinstance(right, RecordValue):
        names = left.fields.keys()
        return names == right.fields.keys() and all(
            same(left.fields[n], right.fields[n], spend) for n in names
        )
    if isinstance(left, PoseIn) and isinstance(right, PoseIn):
        return left == right
    if arithmetic.is_numeric(left) and arithmetic.is_numeric(right):
        try:
            return arithmetic.compare("==", left, right) is True
        except DimensionError:
            return False
    if isinstance(left, (str, Word)) and isinstance(right, (str, Word)):
        return _word(left) == _word(right)
    return show(left) == show(right)


def _word(value: str | Word) -> str:
    return value.text if isinstance(value, Word) else value
