"""What hands write where a value stands, with its mend: `A1`, `rack["A1"]`, `True`, `None`, `tube.cap`."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.check.registry import Registry
from xei_lang.check.report import guess, replace
from xei_lang.check.values import ObjectValue
from xei_lang.diagnostics import Fix, Span
from xei_lang.profiles.grid import slot_keys

Mend = tuple[tuple[str, ...], Fix | None]
"""The lines of help, and an edit where there is one."""

NO_MEND: Mend = ((), None)
_ANSWERS = {"yes": "true", "no": "false", "on": "true", "off": "false"}
_NOTHING = ("none", "null", "nil", "undefined", "nan")


def in_place_of_a_name(name: str, span: Span, registry: Registry) -> Mend:
    """The mend of a name that nothing has, where hands bring it along from elsewhere."""
    lower = name.lower()
    if lower in ("true", "false"):
        return (f"write `{lower}`",), replace(span, lower)
    if lower in _ANSWERS:
        return (f"write `{_ANSWERS[lower]}`",), replace(span, _ANSWERS[lower], "unsafe")
    if lower in _NOTHING:
        return ("there is no such value: leave the argument out, and its default holds",), None
    return bare_slot(name, span, registry)


def bare_slot(key: str, span: Span, registry: Registry) -> Mend:
    """`A1` for a slot of a rack that is not named: the racks that have one."""
    if not (2 <= len(key) <= 3 and key[0].isalpha() and key[1:].isdigit()):
        return NO_MEND
    key = key.upper()
    racks = [
        thing.name
        for thing in registry.objects.values()
        if thing.slots is not None and key in slot_keys(thing.slots)
    ]
    places = tuple(f'{rack}.slot("{key}")' for rack in racks[:3])
    if not places:
        return (f'a slot belongs to a rack: write `rack.slot("{key}")` with the name of your rack',), None
    shown = " or ".join(f"`{place}`" for place in places)
    return (f"a slot belongs to a rack: write {shown}",), guess(span, places)


def slot_of(owner: ObjectValue, key: str, written: str, span: Span) -> Mend:
    """`rack.A1` and `rack["A1"]` for a slot of `owner`, which is `written` so."""
    thing = owner.registered
    if thing is None or thing.slots is None or key.upper() not in slot_keys(thing.slots):
        return NO_MEND
    place = f'{written}.slot("{key.upper()}")'
    return (f"write `{place}`",), replace(span, place)


def unquoted_key(key: str, method: str, known: Sequence[str], span: Span) -> Mend:
    """`rack.slot(A1)` for `rack.slot("A1")`, where the object has such a place."""
    if key not in known:
        return NO_MEND
    return (f'write `{method}("{key}")`: the name of a place is a text',), replace(span, f'"{key}"')


def state_of(owner: ObjectValue, name: str, written: str, span: Span) -> Mend:
    """`tube.cap` for `cap(tube)`, the tube being `written` so."""
    states = owner.registered.states if owner.registered is not None else ()
    if name not in ("volume", "at", *(state.name for state in states)):
        return NO_MEND
    return (f"a state is asked for as `{name}({written})`",), replace(span, f"{name}({written})")
