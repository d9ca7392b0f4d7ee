"""Values in messages: as a protocol would write them, and what sort they are."""

from __future__ import annotations

from fractions import Fraction

from xei_lang.check.values import (
    Interval,
    ListValue,
    ObjectValue,
    OpenPose,
    PlaceValue,
    Poison,
    RecordValue,
    TableValue,
    Undecided,
    Val,
    Word,
)
from xei_lang.ir.forms.pose_text import written_pose
from xei_lang.ir.skill_plan import PoseIn, StationRef
from xei_lang.quantity import Quantity
from xei_lang.quantity.text import format_magnitude
from xei_lang.world.places import place_text


def show(value: Val) -> str:  # noqa: PLR0911, PLR0912 one return for each kind of value
    """A value as it would be written in a protocol."""
    match value:
        case bool():
            return "true" if value else "false"
        case int() | Fraction():
            return format_magnitude(Fraction(value))
        case str():
            return f'"{value}"'
        case Word():
            return value.text
        case ObjectValue() | StationRef():
            return value.name
        case PlaceValue():
            return place_text(value.ref)
        case PoseIn():
            return written_pose(value)
        case OpenPose():
            return written_pose(value.nominal)
        case RecordValue():
            shown = [f"{name}: {_part(cell)}" for name, cell in list(value.fields.items())[:3]]
            return f"({', '.join(shown)}{', ...' if len(value.fields) > 3 else ''})"
        case TableValue():
            return f"[{_part(value.items[0])}, ...]" if value.items else "[]"
        case ListValue():
            shown = [_part(item) for item in value.items[:3]]
            return f"[{', '.join(shown)}{', ...' if len(value.items) > 3 else ''}]"
        case Interval():
            return f"{show(value.lower)} .. {show(value.upper)}"
        case Undecided():
            return value.formula
        case Poison():
            return "?"
        case Quantity():
            return str(value)


def _part(value: Val) -> str:
    """A member as its list is shown: of lists in lists, which can be of any depth, only that they are."""
    parts = value.items[:3] if isinstance(value, ListValue) else ()
    return "[...]" if any(isinstance(part, (ListValue, RecordValue)) for part in parts) else show(value)


def kind(value: Val) -> str:  # noqa: PLR0911, PLR0912 one return for each kind of value
    """What sort of value it is, with its article, for messages."""
    match value:
        case bool() | Undecided():
            return "a Bool"
        case int():
            return "a number"
        case Fraction():
            return "a number"
        case str():
            return "a String"
        case Word():
            return "a word"
        case ObjectValue():
            return "an object"
        case PlaceValue():
            return "a place"
        case StationRef():
            return "a station"
        case PoseIn() | OpenPose():
            return "a pose"
        case TableValue():
            return "a table"
        case ListValue():
            return "a list"
        case RecordValue():
            return "a row of a table"
        case Interval():
            return kind(value.lower)
        case Poison():
            return "unknown"
        case Quantity():
            return a(value.dimension.name)


def a(noun: str) -> str:
    """The noun with its indefinite article."""
    return f"{'an' if noun[:1] in 'AEIOaeio' else 'a'} {noun}"
