"""What frozen dataclasses of many kinds share: their text, and equality by value.

`@dataclass` writes and compiles these methods anew for each class, at each start: an eighth of the CPU time
of `xei check`. The classes that every start defines inherit them, and say `eq=False, repr=False`.
Equality and hash take every field, so a class with `field(compare=False)` keeps its own.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


class Shown:
    """A dataclass whose text is `Name(field=value, ...)`, as `@dataclass` would write it."""

    __slots__ = ()

    def __repr__(self: DataclassInstance) -> str:
        inner = ", ".join(f"{field.name}={getattr(self, field.name)!r}" for field in fields(self))
        return f"{type(self).__qualname__}({inner})"


class Record(Shown):
    """A dataclass that is equal to another of its class with equal fields, and hashes by them."""

    __slots__ = ()

    def __eq__(self: DataclassInstance, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return _values(self) == _values(other)

    def __hash__(self: DataclassInstance) -> int:
        return hash(_values(self))


def _values(record: DataclassInstance) -> tuple[Any, ...]:
    return tuple([getattr(record, name) for name in record.__dataclass_fields__])
