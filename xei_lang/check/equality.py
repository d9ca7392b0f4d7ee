"""Whether two values are the same, of any type."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from xei_lang.check import arithmetic
from xei_lang.check.run_time import needs_of
from xei_lang.check.value_words import show
from xei_lang.check.values import ListValue, OpenPose, RecordValue, Val, Word
from xei_lang.ir.skill_plan import PoseIn
from xei_lang.quantity import DimensionError

Spend = Callable[[int], bool]
"""Whether so many more members may be looked at."""


def same(left: Val, right: Val, spend: Spend) -> bool | None:  # noqa: PLR0911 one for each kind of value
    """Lists, rows and poses by their parts, numbers and quantities by what they are worth, all else as it is
    written. None where parameters that are still open leave it open; False where the budget is spent, which
    has been reported then.
    """
    if isinstance(left, ListValue) and isinstance(right, ListValue):
        if len(left.items) != len(right.items) or not spend(len(left.items)):
            return False
        return _all(same(a, b, spend) for a, b in zip(left.items, right.items, strict=True))
    if isinstance(left, RecordValue) and isinstance(right, RecordValue):
        names = left.fields.keys()
        if names != right.fields.keys():
            return False
        return _all(same(left.fields[n], right.fields[n], spend) for n in names)
    if isinstance(left, (PoseIn, OpenPose)) and isinstance(right, (PoseIn, OpenPose)):
        return _poses(left, right, spend)
    if arithmetic.is_numeric(left) and arithmetic.is_numeric(right):
        return _numbers(left, right)
    if isinstance(left, (str, Word)) and isinstance(right, (str, Word)):
        return _word(left) == _word(right)
    return show(left) == show(right)


def _all(answers: Iterable[bool | None]) -> bool | None:
    """Whether all are: one that is not decides it."""
    is_open = False
    for answer in answers:
        if answer is False:
            return False
        is_open = is_open or answer is None
    return None if is_open else True


def _poses(left: PoseIn | OpenPose, right: PoseIn | OpenPose, spend: Spend) -> bool | None:
    frames = [pose.nominal.frame if isinstance(pose, OpenPose) else pose.frame for pose in (left, right)]
    if frames[0] != frames[1]:
        return False
    return _all(same(a, b, spend) for a, b in zip(_parts(left), _parts(right), strict=True))


def _parts(pose: PoseIn | OpenPose) -> tuple[Val, ...]:
    return pose.parts if isinstance(pose, OpenPose) else (*pose.position, *pose.rotation)


def _numbers(left: Val, right: Val) -> bool | None:
    try:
        answer = arithmetic.compare("==", left, right)
    except DimensionError:
        return False
    # What is measured has no formula inside of a list, so nothing could decide it later.
    return False if answer is None and needs_of(left, right) else answer


def _word(value: str | Word) -> str:
    return value.text if isinstance(value, Word) else value
