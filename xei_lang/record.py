"""Records: slotted dataclasses that are cheap to define, because every start of `xei` defines most of them.

`@dataclass(frozen=True)` writes and compiles methods anew for each class, at each start, and was half of the
CPU time of `xei check`. A record inherits its text and its equality by value from `Record` (or the text alone
from `Shown`), and is frozen for the type checker, which refuses to assign to its fields; nothing checks that
at run time. Equality and hash take every field, so a class with `field(compare=False)` keeps its own.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, TypeVar, dataclass_transform

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

T = TypeVar("T")


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(field,))
def record(cls: type[T]) -> type[T]:
    """Make a class that inherits `Record` or `Shown` a dataclass with slots."""
    return dataclass(slots=True, eq=False, repr=False)(cls)


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
