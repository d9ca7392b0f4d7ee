"""A plan's JSON form as a SkillPlan: the way back from `plan_json.to_json`.

What `to_json` writes comes back as it was, but for its places: spans point into the JSON text. Of the form
only what its schema requires must be there; the rest is then what the schema says of a missing key.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import cast, get_args

from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.forms.plan_values import Needs, ValueReader, named_steps
from xei_lang.ir.skill_plan import (
    Argument,
    Call,
    Condition,
    SafetyNote,
    SkillPlan,
    Step,
    StepKind,
    TimeConstraint,
    UnmappedRequest,
    Value,
)
from xei_lang.quantity import Quantity

ArgumentType = Callable[[str, str], str | None]
"""The type of an argument, by the skill's name and its own; None where it is not known."""

WITH_SKILL: tuple[StepKind, ...] = ("skill", "start", "measure")
"""The kinds of steps that name a skill."""

STATEMENTS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "wait": ("duration", "Time"),
        "confirm": ("text", "String"),
        "require": ("condition", "String"),
        **dict.fromkeys(("await", "pause", "resume", "stop", "leave"), ("step", "Step")),
    }
)
"""The one argument of each kind of step without a skill, and its type; a `Step` is named by its id."""


def plan_from_json(root: JsonNode, type_of: ArgumentType) -> tuple[SkillPlan, Diagnostics]:
    """The plan of a tree that follows `plan.schema.json`, with what in it can be no value.

    Nothing is asked here of skills, objects and the order of the steps: that is the checker's work, or
    `verify_plan`'s for a plan that xei wrote itself. `type_of` is the skill bank's word on arguments.
    """
    reader = _PlanReader(type_of)
    return reader.plan(root), tuple(reader.values.found)


def step_kind(node: JsonNode) -> StepKind:
    """The kind that a step says, or that its skill's name is; a step of any other name is a skill."""
    said, name = node.get("kind"), node.items["skill"].value
    if said is not None:
        return cast("StepKind", said.value)
    kinds = cast("tuple[StepKind, ...]", get_args(StepKind))
    named: list[StepKind] = [kind for kind in kinds if kind == name and kind not in WITH_SKILL]
    return named[0] if named else "skill"


class _PlanReader:
    def __init__(self, type_of: ArgumentType) -> None:
        self.type_of = type_of
        self.values = ValueReader()

    def plan(self, root: JsonNode) -> SkillPlan:
        steps: list[Step] = []
        for node in root.items["skill_calls"].elements:
            steps.append(self.step(node, (steps[-1].step_id,) if steps else ()))
        return SkillPlan(
            _text(root, "protocol"),
            _text(root, "profile"),
            tuple(steps),
            self.values.facts(root.get("initial_state")),
            tuple(_constraint(node) for node in _elements(root, "constraints")),
            tuple(
                UnmappedRequest(_text(node, "text"), _text(node, "reason"), _after_step(node), node.span)
                for node in _elements(root, "unmapped_requests")
            ),
            tuple(
                SafetyNote(_text(node, "text"), _after_step(node), node.span)
                for node in _elements(root, "safety_notes")
            ),
        )

    def step(self, node: JsonNode, before: tuple[str, ...]) -> Step:
        kind, name = step_kind(node), _text(node, "skill")
        skill = name if kind in WITH_SKILL else ""
        defaults = frozenset(_texts(node, "defaults"))
        needs = {name: place for place, name in enumerate(_texts(node, "needs"))}
        args = node.get("args")
        arguments = tuple(
            self._argument(skill or kind, key, item, key in defaults, needs)
            for key, item in (args.items.items() if args else ())
        )
        after = node.get("after")
        return Step(
            _text(node, "step_id"),
            kind,
            node.span,
            skill,
            _text(node, "owner"),
            arguments,
            _duration(node, kind, arguments),
            before if after is None else tuple(_texts(node, "after")),
            _text(node, "branch"),
            tuple(int(cast("int", item.value)) for item in _elements(node, "turn")),
            _conditions(node, "when", needs),
            tuple(sorted(_texts(node, "resources"))),
            self.values.facts(node.get("state_before")),
            tuple(Call(_text(item, "procedure"), item.span) for item in _elements(node, "origin")),
            _conditions(node, "keep", needs),
            tuple(_texts(node, "needs")),
        )

    def _argument(self, skill: str, name: str, node: JsonNode, by_default: bool, needs: Needs) -> Argument:
        own = STATEMENTS.get(skill)
        type_ = own[1] if own and own[0] == name else self.type_of(skill, name)
        value = self.values.value(node, type_, needs)
        source = "default" if by_default else "call"
        return Argument(name, value, type_ or _own_type(value), source, node.span)


def _conditions(node: JsonNode, key: str, needs: Needs) -> tuple[Condition, ...]:
    """Conditions, each with those of the needed steps that its text names."""
    texts = [(str(item.value), item.span) for item in _elements(node, key)]
    return tuple(Condition(text, named_steps(text, needs), span) for text, span in texts)


def _duration(node: JsonNode, kind: StepKind, arguments: Iterable[Argument]) -> tuple[float, float]:
    """What the step says; else what a wait waits for, and for other steps nothing is known."""
    said = _elements(node, "duration_s")
    if said:
        longest = said[1].value
        return _seconds(said[0]), math.inf if longest is None else _seconds(said[1])
    waits = next((item.value for item in arguments if kind == "wait" and item.name == "duration"), None)
    return (waits.si, waits.si) if isinstance(waits, Quantity) else (0.0, math.inf)


def _constraint(node: JsonNode) -> TimeConstraint:
    upper = node.items["upper_s"]
    return TimeConstraint(
        _text(node, "from_step"),
        "start" if _text(node, "from_end") == "start" else "end",
        _text(node, "to_step"),
        "start" if _text(node, "to_end") == "start" else "end",
        _seconds(node.items["lower_s"]),
        math.inf if upper.value is None else _seconds(upper),
        node.span,
    )


def _own_type(value: Value) -> str:
    """The type of a value of which nothing else says it."""
    match value:
        case bool():
            return "Bool"
        case int():
            return "Int"
        case float():
            return "Float"
        case Quantity():
            return value.dimension.name
        case _:
            return "String"


def _elements(node: JsonNode, key: str) -> list[JsonNode]:
    found = node.get(key)
    return found.elements if found else []


def _texts(node: JsonNode, key: str) -> list[str]:
    return [str(item.value) for item in _elements(node, key)]


def _text(node: JsonNode, key: str) -> str:
    found = node.get(key)
    return str(found.value) if found else ""


def _after_step(node: JsonNode) -> str | None:
    found = node.get("after_step")
    return None if found is None or found.value is None else str(found.value)


def _seconds(node: JsonNode) -> float:
    return float(cast("float", node.value))
