"""What a skill brings about and what it occupies, read from its contract and template in the skill bank."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from xei_lang.check.state import EITHER, NOTHING, State
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Value
from xei_lang.profiles.instruments import instrument_of
from xei_lang.profiles.model import SkillSpec
from xei_lang.record import Shown, record
from xei_lang.syntax.ast import (
    Bool,
    CallExpr,
    Expression,
    Name,
    Number,
    QuantityLit,
    StringLit,
    Update,
)
from xei_lang.world.places import place_text

_ARM_PARTS = {
    "move_to": "arm",
    "open_gripper": "gripper",
    "close_gripper": "gripper",
    "attach": "gripper",
    "detach": "gripper",
}
_OTHER_PARTS = {
    "slide_move": "slide",
    "nav_to_pose": "base",
    "perceive": "perception",
    "set_do": "io",
    "confirm": "person",
}


@record
class Effect(Shown):
    """`variable(subject) := value`, the subject and perhaps the value being names of arguments."""

    variable: str
    subject: str
    value: Expression


def effects_of(skill: SkillSpec) -> tuple[Effect, ...]:
    """The settings (`:=`) among what a skill ensures, but for volumes: those are `transfers`."""
    found: list[Effect] = []
    for rule in skill.ensures:
        update = rule.predicate
        if isinstance(update, Update) and update.op == ":=" and isinstance(update.target, CallExpr):
            function, args = update.target.function, update.target.args
            if not isinstance(function, Name) or function.id == "volume":
                continue
            if len(args) == 1 and isinstance(args[0].value, Name):
                found.append(Effect(function.id, args[0].value.id, update.value))
    return tuple(found)


def moves(effects: tuple[Effect, ...]) -> tuple[tuple[str, str], ...]:
    """Pairs of names: which argument is brought to which place by `at(object) := place`."""
    return tuple((e.subject, e.value.id) for e in effects if e.variable == "at" and isinstance(e.value, Name))


def apply_effects(effects: tuple[Effect, ...], args: Mapping[str, Value], state: State) -> None:
    """Bring the state from before a step to after it. What is not known of an open value stays unknown."""
    objects = [value.name for value in args.values() if isinstance(value, ObjectRef)]
    for effect in effects:
        subject = _subject(args.get(effect.subject, effect.subject))
        value = _value(effect.value, args)
        if value is None:
            continue
        if effect.variable == "holding" and value == NOTHING:
            state.release(subject, objects)
        elif effect.variable == "at" and value == EITHER and state.get("at", subject) is not None:
            state.set("at", subject, state.holder(subject) or EITHER)
        else:
            state.set(effect.variable, subject, value)


def _subject(value: Value) -> str:
    match value:
        case ObjectRef():
            return value.name
        case PlaceRef():
            return place_text(value)
        case _:
            return str(value)


def _value(node: Expression, args: Mapping[str, Value]) -> Value | None:
    match node:
        case Name():
            return args.get(node.id, node.id)
        case QuantityLit() | StringLit() | Bool():
            return node.value
        case Number():
            return float(node.value) if isinstance(node.value, Fraction) else node.value
        case _:
            return None


def resources_of(skill: SkillSpec, args: Mapping[str, Value]) -> tuple[str, ...]:
    """What a step occupies, sorted: `left_arm`, `left_gripper`, `slide`, `base`, `perception`, `io`,
    `person`, and an instrument by its name.

    `either_arm` and `either_gripper` stand for those of one arm that is chosen later. A template line that
    moves the robot without naming an arm occupies all of it.
    """
    found = {instrument_of(skill, args)} - {""}
    for line in skill.template:
        part = _ARM_PARTS.get(line.kind)
        if part is None:
            found.update([_OTHER_PARTS[line.kind]] if line.kind in _OTHER_PARTS else [])
            continue
        named = line.field("tool") or line.field("arm")
        sides = ("left", "right") if named is None else (str(args.get(str(named), named)),)
        found.update(f"{side}_{part}" for side in sides)
    return tuple(sorted(found))
