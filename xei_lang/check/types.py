"""Whether a value is of the type that is expected of it, and what to say where it is not."""

from __future__ import annotations

from fractions import Fraction

from xei_lang.check.budget import Budget
from xei_lang.check.expectation import Expectation
from xei_lang.check.places import Places
from xei_lang.check.poses import EXAMPLE
from xei_lang.check.quantities import no_such_type, quantity_value, rule_of
from xei_lang.check.registry import Registry
from xei_lang.check.report import Reporter, listed, replace
from xei_lang.check.roles import candidates, first_misfit, text, unmet
from xei_lang.check.state import State
from xei_lang.check.value_habits import NO_MEND, Mend, bare_slot
from xei_lang.check.values import (
    POISON,
    Interval,
    ListValue,
    ObjectValue,
    OpenPose,
    PlaceValue,
    Poison,
    Undecided,
    Val,
    Word,
    number,
)
from xei_lang.ir.skill_plan import PoseIn, StationRef
from xei_lang.quantity import TYPE_DIMENSIONS, Quantity
from xei_lang.quantity.dimension import NUMBER
from xei_lang.syntax.ast import Expression, ListLit, StringLit, TupleLit
from xei_lang.world.places import place_text

VALUE_TYPES = (*TYPE_DIMENSIONS, "Int", "Float", "Bool", "String", "Arm", "Place", "Pose", "Station")
"""The types that a parameter may have besides role expressions."""

ANY_ARM = "either"


class Types:
    """Turns values into what is expected, or reports why they are not; the result is POISON then."""

    def __init__(self, registry: Registry, places: Places, reporter: Reporter, budget: Budget) -> None:
        self._budget = budget
        self._registry = registry
        self._places = places
        self._reporter = reporter

    def coerce(  # noqa: PLR0911, PLR0912 one return for each type
        self, value: Val, expected: Expectation, node: Expression, state: State
    ) -> Val:
        """The value as the expected type has it: a place where an object is expected is its occupant in
        `state`.
        """
        if isinstance(value, Poison):
            return POISON
        if expected.lists:
            return self._list(value, expected, node, state)
        if expected.type in TYPE_DIMENSIONS:
            return quantity_value(value, expected, node, self._reporter)
        match expected.type:
            case "object":
                return self._object(value, expected, node, state)
            case "Place":
                return self._place(value, expected, node)
            case "Arm":
                return self._arm(value, expected, node)
            case "Int" | "Float":
                return self._number(value, expected, node)
            case "choice":
                return self._choice(value, expected, node)
            case "Bool" if isinstance(value, (bool, Undecided)):
                return value
            case "String" if isinstance(value, str):
                return value
            case "Station" if isinstance(value, StationRef):
                return value
            case "Pose" if isinstance(value, (PoseIn, OpenPose)):
                return value
            case _:
                return self._wrong(value, expected, node)

    def _list(self, value: Val, expected: Expectation, node: Expression, state: State) -> Val:
        if not isinstance(value, ListValue):
            return self._wrong(value, expected, node)
        if not self._budget.spend(len(value.items), node.span):
            return POISON
        written = node.items if isinstance(node, (ListLit, TupleLit)) else ()
        nodes = written if len(written) == len(value.items) else (node,) * len(value.items)
        pairs = zip(value.items, nodes, strict=True)
        items = tuple(self.coerce(item, expected.item, part, state) for item, part in pairs)
        return POISON if POISON in items else ListValue(items)

    def _number(self, value: Val, expected: Expectation, node: Expression) -> Val:
        probe = value.lower if isinstance(value, Interval) else value
        if isinstance(probe, Quantity) and probe.dimension == NUMBER:
            value = probe = number(probe.value)
        if isinstance(probe, bool) or not isinstance(probe, (int, Fraction)):
            return self._wrong(value, expected, node)
        if expected.type == "Int" and not isinstance(probe, int):
            return self._wrong(value, expected, node)
        return value

    def _object(self, value: Val, expected: Expectation, node: Expression, state: State) -> Val:
        if isinstance(value, PlaceValue):
            value = self._occupant(value, expected, node, state)
            if isinstance(value, Poison):
                return POISON
        if not isinstance(value, ObjectValue):
            return self._wrong(value, expected, node)
        return value if self._has_roles(value, expected, node) else POISON

    def _occupant(self, place: PlaceValue, expected: Expectation, node: Expression, state: State) -> Val:
        if place.owner.registered is None:
            return POISON
        name = state.occupant(place.ref)
        if name is not None:
            return ObjectValue(name, self._registry.objects.get(name))
        shown = place_text(place.ref)
        self._reporter.report(
            "XEI0311",
            f"nothing is known to stand in `{shown}`, but {expected.what} takes {expected.noun}",
            node.span,
            "a place stands for the object in it, and this one is empty",
            notes=rule_of(expected, self._reporter),
            help=(f"if something stands there, say so: `given at(...) == {shown}`",),
        )
        return POISON

    def _has_roles(self, value: ObjectValue, expected: Expectation, node: Expression) -> bool:
        if expected.roles is None:
            return True
        misfit = first_misfit(value, expected.roles, self._registry)
        if misfit is None:
            return True
        reason = unmet(expected.roles, misfit.roles)
        bound = (
            f"`{value.name}`"
            if misfit is value.registered
            else f"`{value.name}`, which may be `{misfit.name}`,"
        )
        fitting = candidates(expected.roles, self._registry)
        self._reporter.report(
            "XEI0309",
            f"{bound} {reason}, but {expected.what} takes {expected.noun} that is `{text(expected.roles)}`",
            node.span,
            f"`{misfit.name}` has the roles {', '.join(misfit.roles) or 'none'}",
            notes=rule_of(expected, self._reporter),
            help=(f"registered objects that would do: {listed(fitting)}",)
            if fitting
            else ("no registered object would do",),
        )
        return False

    def _place(self, value: Val, expected: Expectation, node: Expression) -> Val:
        if isinstance(value, PlaceValue):
            return value
        if not isinstance(value, ObjectValue):
            return self._wrong(value, expected, node)
        if expected.roles is None:
            return self._places.surface(value, expected, node)
        return PlaceValue(value, "surface", "") if self._has_roles(value, expected, node) else POISON

    def _arm(self, value: Val, expected: Expectation, node: Expression) -> Val:
        if isinstance(value, Word) and value.text in (*self._registry.arms, ANY_ARM):
            return value
        return self._wrong(value, expected, node)

    def _choice(self, value: Val, expected: Expectation, node: Expression) -> Val:
        word = value if isinstance(value, (Word, str)) else None
        chosen = word.text if isinstance(word, Word) else word
        return Word(chosen) if chosen in expected.choices else self._wrong(value, expected, node)

    def _wrong(self, value: Val, expected: Expectation, node: Expression) -> Val:
        if isinstance(value, (PoseIn, OpenPose)) and expected.type == "Place":
            help_ = (
                "a place is part of an object, such as a slot or a spot; a pose says nothing of what is there"
            )
            return no_such_type(value, expected, node, self._reporter, ((help_,), None))
        if expected.type == "Pose":
            help_ = f"write one as `{EXAMPLE}`"
            return no_such_type(value, expected, node, self._reporter, ((help_,), None))
        quoted = isinstance(node, StringLit) and isinstance(value, str) and expected.type != "String"
        mend = self._unquoted(value, expected, node) if quoted else NO_MEND
        return no_such_type(value, expected, node, self._reporter, mend)

    def _unquoted(self, value: Val, expected: Expectation, node: Expression) -> Mend:
        """What stands in quotes and should not: an object, an arm; a slot without its rack."""
        name = str(value)
        if name in self._registry.objects:
            return (f"write the object's name without quotes: `{name}`",), replace(node.span, name)
        if expected.type == "Arm" and name in (*self._registry.arms, ANY_ARM):
            return (f"write it without quotes: `{name}`",), replace(node.span, name)
        return bare_slot(name, node.span, self._registry) if expected.type in ("Place", "object") else NO_MEND
