"""What an expression can be worth while a protocol is checked.

Everything is decided here and now, but for four kinds: an `Interval` (a ranged parameter that is still open,
or what a measurement gives), an `OpenPose` (one with such parts), `Undecided` (a condition on that), and
`POISON` (something wrong that was reported already, or open without bounds), which fits everywhere and says
nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from fractions import Fraction
from typing import Final, Literal

from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, PoseIn, RunValue, StationRef, Value
from xei_lang.profiles.model import LabObject
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import NUMBER
from xei_lang.record import Record, Shown, record
from xei_lang.syntax.ast import TypeExpr


class Poison(Enum):
    """The type of `POISON`, an enumeration of one so that `is POISON` narrows types."""

    POISON = "poison"


POISON: Final = Poison.POISON

Numeric = Quantity | int | Fraction


@record
class Unknown(Shown):
    """Something between nothing and all that is not known yet: one for each value that is open by itself."""


Shares = tuple[tuple[Unknown, Numeric], ...]
"""How much of a value goes with each unknown, from its lower end to its upper one."""


@record
class Interval(Record):
    """A value of which only the bounds are known, ends included; `nominal` stands for it where one is
    needed.

    What the measuring steps `needs` give has a `formula` in their ids, and nothing may stand for it.
    `shares`, where they are known, say how it goes with what is unknown, so that `v - v` is nothing.
    """

    lower: Numeric
    upper: Numeric
    nominal: Numeric
    formula: str = ""
    needs: tuple[str, ...] = ()
    shares: Shares = ()


@record
class OpenPose(Record):
    """A pose with open ones among its `parts` (x, y, z, roll, pitch, yaw); the plan has its `nominal`."""

    nominal: PoseIn
    parts: tuple[Quantity | Interval, ...]


@record
class Undecided(Record):
    """A Bool that what is measured decides; `formula` and `needs` as an Interval has them."""

    formula: str
    needs: tuple[str, ...]


@record
class ObjectValue(Record):
    """A registered object; or, with `registered=None`, any object that has the declared roles."""

    name: str
    registered: LabObject | None
    declared: TypeExpr | None = None


@record
class PlaceValue(Record):
    """A place of an object; what stands in it is asked of the state, where an object is needed."""

    owner: ObjectValue
    kind: Literal["slot", "spot", "surface"]
    key: str

    @property
    def ref(self) -> PlaceRef:
        """The place as the plan names it."""
        return PlaceRef(self.owner.name, self.kind, self.key)


@record
class Word(Record):
    """A word of an enumeration: an arm, a value of a declared state, a choice of a skill."""

    text: str


@record
class ListValue(Record):
    """A list; a range of a million numbers is one without its members being made."""

    items: Sequence[Val]


@record
class RecordValue(Record):
    """A row of a table: its cells by the names of their columns."""

    fields: Mapping[str, Val]


@record
class TableValue(ListValue):
    """A table: a list of its rows, with each column as a list by its name."""

    columns: Mapping[str, ListValue]


Val = (
    Quantity
    | int
    | Fraction
    | bool
    | str
    | Word
    | ObjectValue
    | PlaceValue
    | StationRef
    | PoseIn
    | OpenPose
    | ListValue
    | RecordValue
    | Interval
    | Undecided
    | Poison
)


def number(value: int | Fraction | Quantity) -> Numeric:
    """The simplest form of a number: a whole one is an int, a quantity without unit no quantity."""
    if isinstance(value, Quantity):
        return number(value.value) if value.dimension == NUMBER and not value.unit else value
    return int(value) if value.denominator == 1 else value


def nominal(value: Val) -> Val:
    """The one value that stands for an open one, every other value being itself."""
    return value.nominal if isinstance(value, (Interval, OpenPose)) else value


def to_plan(value: Val) -> Value:  # noqa: PLR0911 one return for each kind of value
    """A checked value as the plan keeps it; an interval is its nominal value, poison an empty text."""
    match value:
        case Word():
            return value.text
        case ObjectValue():
            return ObjectRef(value.name)
        case PlaceValue():
            return value.ref
        case Fraction():
            return float(value)
        case ListValue():
            return tuple(to_plan(item) for item in value.items)
        case RecordValue():
            return tuple(to_plan(cell) for cell in value.fields.values())
        case Interval() if value.needs:
            return RunValue(value.formula, value.needs, _bound(value.lower), _bound(value.upper))
        case Interval() | OpenPose():
            return to_plan(value.nominal)
        case Undecided():
            return RunValue(value.formula, value.needs, False, True)
        case Poison():
            return ""
        case _:
            return value


def _bound(value: Numeric) -> Quantity | int | float:
    return float(value) if isinstance(value, Fraction) else value
