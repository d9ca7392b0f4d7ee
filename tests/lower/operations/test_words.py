"""What profiles are checked against is what the operations are."""

from __future__ import annotations

from xei_lang.lower.operations import OPERATIONS
from xei_lang.lower.operations.tap import DIRECTIONS
from xei_lang.profiles.checks import operations
from xei_lang.profiles.checks.names import OPERATION_PARAMETERS
from xei_lang.profiles.checks.template_words import AREAS, AXES, POINTS


def test_the_bank_is_checked_against_the_operations_that_there_are() -> None:
    assert [item.name for item in operations.OPERATIONS] == [item.name for item in OPERATIONS]
    for words, operation in zip(operations.OPERATIONS, OPERATIONS, strict=True):
        assert words.of == operation.of
        assert words.points == operation.points
        assert words.axes == operation.axes
        assert words.areas == operation.areas
        assert sorted(words.parameters) == sorted(operation.parameters)
        assert tuple(words.needs) == operation.needs
        assert tuple(words.called) == operation.called


def test_every_word_of_an_operation_may_stand_in_a_template() -> None:
    for operation in OPERATIONS:
        assert set(operation.points) <= set(POINTS[operation.of])
        assert set(operation.axes) <= set(AXES.get(operation.of, ()))
        assert set(operation.areas) <= set(AREAS.get(operation.of, ()))
        assert set(operation.parameters) <= set(OPERATION_PARAMETERS)


def test_a_swipe_knows_the_directions_of_the_bank() -> None:
    assert tuple(DIRECTIONS) == operations.DIRECTIONS
