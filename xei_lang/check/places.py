"""Places of objects: the slots, rows and columns of a rack, the spots of a surface."""

from __future__ import annotations

from typing import Literal

from xei_lang.check.expectation import Expectation
from xei_lang.check.report import Reporter, guess, listed, meant
from xei_lang.check.value_words import show
from xei_lang.check.values import POISON, ListValue, ObjectValue, PlaceValue, Val
from xei_lang.diagnostics import Span, did_you_mean
from xei_lang.profiles.grid import slot_keys
from xei_lang.profiles.model import LabObject, SlotGrid
from xei_lang.syntax.ast import CallExpr, Expression, StringLit

METHODS = ("slot", "row", "column", "spot")
PROPERTIES = ("slots", "spots")

SURFACE_ROLE = "surface"


class Places:
    """Finds places; one that does not exist is reported and becomes POISON.

    The places of an object that is still open cannot be looked up: a named slot is taken on trust, a list of
    unknown length is POISON.
    """

    def __init__(self, reporter: Reporter) -> None:
        self._reporter = reporter

    def property(self, owner: ObjectValue, name: str, span: Span) -> Val:
        """`rack.slots`, `table.spots`: all places of that kind, in order."""
        thing = owner.registered
        if thing is None:
            return POISON
        if name == "spots":
            return ListValue(tuple(PlaceValue(owner, "spot", spot.name) for spot in thing.spots))
        grid = self._grid(thing, span)
        return POISON if grid is None else _slots(owner, slot_keys(grid))

    def method(self, owner: ObjectValue, name: str, argument: Val, node: Expression) -> Val:
        """`rack.slot("A1")`, `rack.row("A")`, `rack.column(1)`, `table.spot("bottle")`."""
        if argument is POISON:
            return POISON
        wanted = "a number" if name == "column" else "a String"
        right = (
            isinstance(argument, int) and not isinstance(argument, bool)
            if name == "column"
            else isinstance(argument, str)
        )
        if not right:
            self._reporter.report(
                "XEI0305",
                f"`{owner.name}.{name}` takes {wanted}, not `{show(argument)}`",
                node.span,
                f"expected {wanted}",
                help=(_EXAMPLES[name].format(owner.name),),
            )
            return POISON
        if owner.registered is None:
            return self._trusted(owner, name, str(argument))
        if name == "spot":
            known = tuple(spot.name for spot in owner.registered.spots)
            return self._one(owner, "spot", str(argument), known, node)
        grid = self._grid(owner.registered, node.span)
        if grid is None:
            return POISON
        return self._in_grid(owner, name, str(argument), grid, node)

    def keys(self, owner: ObjectValue, name: str) -> tuple[str, ...]:
        """What may stand in the parentheses of `owner.name("...")`; none where the owner is still open."""
        thing = owner.registered
        if thing is None or name == "column":
            return ()
        if name == "spot":
            return tuple(spot.name for spot in thing.spots)
        if thing.slots is None:
            return ()
        return slot_keys(thing.slots) if name == "slot" else tuple(thing.slots.rows)

    def surface(self, value: ObjectValue, expected: Expectation, node: Expression) -> Val:
        """A whole object as a place to set something down on; it must have the role `surface`."""
        thing = value.registered
        if thing is None or SURFACE_ROLE in thing.roles:
            return PlaceValue(value, "surface", "")
        self._reporter.report(
            "XEI0305",
            f"`{value.name}` is an object without the role `{SURFACE_ROLE}`, "
            f"but {expected.what} takes a place",
            node.span,
            "expected a place, such as a slot, a spot or a surface",
            notes=(self._reporter.rule(expected.rule),) if expected.rule else (),
            help=_place_help(thing),
        )
        return POISON

    def _trusted(self, owner: ObjectValue, name: str, key: str) -> Val:
        if name in ("slot", "spot"):
            return PlaceValue(owner, "spot" if name == "spot" else "slot", key)
        return POISON

    def _in_grid(self, owner: ObjectValue, name: str, key: str, grid: SlotGrid, node: Expression) -> Val:
        if name == "slot":
            return self._one(owner, "slot", key, slot_keys(grid), node)
        if name == "row":
            if key in grid.rows:
                return _slots(owner, tuple(f"{key}{column}" for column in range(1, grid.columns + 1)))
            return self._missing(owner, "row", key, grid.rows, node)
        columns = tuple(str(column) for column in range(1, grid.columns + 1))
        if key in columns:
            return _slots(owner, tuple(f"{row}{key}" for row in grid.rows))
        return self._missing(owner, "column", key, columns, node)

    def _one(
        self,
        owner: ObjectValue,
        kind: Literal["slot", "spot"],
        key: str,
        known: tuple[str, ...],
        node: Expression,
    ) -> Val:
        return PlaceValue(owner, kind, key) if key in known else self._missing(owner, kind, key, known, node)

    def _missing(
        self, owner: ObjectValue, kind: str, key: str, known: tuple[str, ...], node: Expression
    ) -> Val:
        thing = owner.registered
        rule = thing.slots.span if thing and thing.slots and kind != "spot" else thing.span if thing else None
        there = (
            f"`{owner.name}` has the {kind}s {listed(known, 12)}"
            if known
            else f"`{owner.name}` has no {kind}s"
        )
        near = _nearest(kind, key, known)
        quoted = tuple(f'"{name}"' for name in near)
        key_node = node.args[0].value if isinstance(node, CallExpr) and node.args else node
        self._reporter.report(
            "XEI0205",
            f"`{owner.name}` has no {kind} `{key}`",
            node.span,
            f"there is no such {kind}",
            notes=(there, *((self._reporter.rule(rule),) if rule else ())),
            help=meant(near),
            fix=guess(key_node.span, quoted) if isinstance(key_node, StringLit) else None,
        )
        return POISON

    def _grid(self, thing: LabObject, span: Span) -> SlotGrid | None:
        if thing.slots is None:
            self._reporter.report(
                "XEI0205",
                f"`{thing.name}` has no slots",
                span,
                f"`{thing.name}` is no rack or plate",
                notes=(self._reporter.rule(thing.span),),
                help=_place_help(thing),
            )
        return thing.slots


def _slots(owner: ObjectValue, keys: tuple[str, ...]) -> ListValue:
    return ListValue(tuple(PlaceValue(owner, "slot", key) for key in keys))


def _nearest(kind: str, key: str, known: tuple[str, ...]) -> tuple[str, ...]:
    """Names of spots are words; a slot's name is too short for a guess, unless only one is near (`a1`)."""
    suggestions = did_you_mean(key, known)
    return suggestions if kind == "spot" or len(suggestions) == 1 else ()


def _place_help(thing: LabObject) -> tuple[str, ...]:
    if thing.slots is not None:
        return (f'name one of its slots: `{thing.name}.slot("{slot_keys(thing.slots)[0]}")`',)
    if thing.spots:
        return (f'name one of its spots: `{thing.name}.spot("{thing.spots[0].name}")`',)
    return ()


_EXAMPLES = {
    "slot": 'write for example `{}.slot("A1")`',
    "row": 'write for example `{}.row("A")`',
    "column": "write for example `{}.column(1)`",
    "spot": 'write for example `{}.spot("bottle")`',
}
