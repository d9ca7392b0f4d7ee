"""Values of a plan's JSON form as values of a plan; the way back from `plan_json.value_form`.

The form says `"tube_1"` of an object, a word and a text alike, so an argument's type must be known.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import cast

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_json import POSE_PARTS
from xei_lang.ir.skill_plan import Fact, ObjectRef, PlaceRef, PoseIn, RunValue, StationRef, Value
from xei_lang.quantity import (
    TYPE_DIMENSIONS,
    UNITS,
    Quantity,
    QuantityError,
    parse_quantity,
    quantity,
    suggest_unit,
)

PLACE = re.compile(r"(?P<object>\w+)\.(?P<kind>slot|spot)\(\"(?P<key>.+)\"\)", re.DOTALL)
_EXACT = re.compile(r"-?[0-9]{1,300}/0*[1-9][0-9]{0,299}")
_STEP_ID = re.compile(r"[A-Za-z_]\w*(?:\[\d+\]|#\d+|~\d+|\.[A-Za-z_]\w*)*")
_HANDS = ("left", "right", "either")
_NOTHING = "nothing"
_NO_TURN = quantity(0, "deg")


Needs = Mapping[str, int]
"""The measuring steps that a step needs, by their ids, each with its place among them."""
_NO_NEEDS: Needs = MappingProxyType({})


class ValueReader:
    """Reads values of trees that follow the plan's schema. What cannot be a value is in `found`."""

    def __init__(self) -> None:
        self.found: list[Diagnostic] = []

    def value(  # noqa: PLR0911 one return for each type
        self, node: JsonNode, type_: str | None, needs: Needs = _NO_NEEDS
    ) -> Value:
        """The value where a type is expected; as it stands where it is not of that type, or there is none.

        `needs` are the measuring steps that a measured value may name.
        """
        if node.kind == "array":
            inner = type_[5:-1] if type_ and type_.startswith("List[") else None
            return tuple(self.value(item, inner, needs) for item in node.elements)
        if node.kind == "object":
            return self._compound(node, needs)
        scalar = cast("str | int | float | bool", node.value)
        if type_ == "Float" and isinstance(scalar, int) and not isinstance(scalar, bool):
            return float(scalar)
        if not isinstance(scalar, str):
            return scalar
        if type_ in TYPE_DIMENSIONS:
            return self._written(node, scalar) or scalar
        match type_:
            case "object":
                return ObjectRef(scalar)
            case "Place":
                return place(scalar)
            case "Station":
                return StationRef(scalar)
            case _:
                return scalar

    def _compound(self, node: JsonNode, needs: Needs) -> Value:
        if "measured" in node.items:
            return self._measured(node, needs)
        found = self._pose(node) if "pose" in node.items else self.quantity(node)
        return "" if found is None else found

    def _pose(self, node: JsonNode) -> PoseIn | None:
        """`{"pose": {"x": ..., ...}, "frame": "table"}`; a rotation that is left out is zero."""
        parts = node.items["pose"].items
        found = [self.quantity(parts[name]) if name in parts else _NO_TURN for name in POSE_PARTS]
        x, y, z, roll, pitch, yaw = found
        if x is None or y is None or z is None or roll is None or pitch is None or yaw is None:
            return None
        return PoseIn(str(node.items["frame"].value), (x, y, z), (roll, pitch, yaw))

    def quantity(self, node: JsonNode) -> Quantity | None:
        """`{"value": 2, "unit": "mL"}`; None where the unit is none, which is found."""
        value, unit, exact = node.items["value"], node.items["unit"], node.get("exact")
        if unit.value not in UNITS:
            self._wrong(_no_unit(str(unit.value)), unit, "a unit")
            return None
        number = Fraction(str(value.value))
        try:
            return quantity(number if exact is None else _exact(exact, number), str(unit.value))
        except QuantityError as error:
            self._wrong(error, exact or node, "an exact number")
            return None

    def _measured(self, node: JsonNode, needs: Needs) -> Value:
        ends = [self.value(node.items[key], None) for key in ("lower", "upper")]
        lower, upper = (end if isinstance(end, (Quantity, int, float)) else 0 for end in ends)
        formula = str(node.items["measured"].value)
        return RunValue(formula, named_steps(formula, needs), lower, upper)

    def facts(self, node: JsonNode | None) -> tuple[Fact, ...]:
        """`{"holding": {"left": "nothing"}}` as facts, sorted by variable and subject.

        An array under `holding` holds several facts: what is in which hand is not known.
        """
        facts: list[Fact] = []
        for variable, subjects in sorted(node.items.items() if node else ()):
            for subject, item in sorted(subjects.items.items()):
                several = item.elements if variable == "holding" and item.kind == "array" else [item]
                facts.extend(Fact(variable, subject, self.fact(variable, one)) for one in several)
        return tuple(dict.fromkeys(facts))

    def fact(self, variable: str, node: JsonNode) -> Value:
        """The value of a state variable: hands hold objects, things are in hands or at places."""
        if variable == "holding" and node.value != _NOTHING:
            return self.value(node, "object")
        if variable == "at" and node.value not in _HANDS:
            return self.value(node, "Place")
        text = node.value if isinstance(node.value, str) else ""
        return place(text) if PLACE.fullmatch(text) else self.value(node, None)

    def _written(self, node: JsonNode, text: str) -> Quantity | None:
        try:
            return parse_quantity(text)
        except QuantityError as error:
            self._wrong(error, node)
            return None

    def _wrong(self, error: QuantityError, node: JsonNode, what: str = "a quantity") -> None:
        text = f"{error.text[:60]}..." if len(error.text) > 60 else error.text
        help_ = (f"write `{error.suggestion}`",) if error.suggestion else ()
        said = f"`{text}` is not {what}"
        self.found.append(Diagnostic("XEI0111", said, node.span, error.reason[:200], help=help_))


def named_steps(text: str, needs: Needs) -> tuple[str, ...]:
    """Those of the steps that an expression of the plan names by their ids, in the order of the steps."""
    named = {name for name in _STEP_ID.findall(text) if name in needs}
    return tuple(sorted(named, key=needs.__getitem__))


def place(text: str) -> PlaceRef:
    """`rack_1.slot("A1")`, `table.spot("bottle")`, or an object as a surface."""
    found = PLACE.fullmatch(text)
    if found is None:
        return PlaceRef(text, "surface", "")
    return PlaceRef(found["object"], "slot" if found["kind"] == "slot" else "spot", found["key"])


def _no_unit(unit: str) -> QuantityError:
    better = suggest_unit(unit)
    return QuantityError(unit, f"expected `{better}`" if better else "there is no such unit", better)


def _exact(node: JsonNode, near: Fraction) -> Fraction:
    """The fraction; QuantityError where it is none or is not near the number that stands beside it."""
    text = str(node.value)
    if not _EXACT.fullmatch(text):
        raise QuantityError(text, "expected a fraction such as `10/3`")
    exact = Fraction(text)
    if abs(exact - near) > abs(near) * Fraction(1, 10**12):
        raise QuantityError(text, "expected the number of `value`, which is another")
    return exact
