"""What an instrument holds while it works, and which steps would touch it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from xei_lang.check.effects import effects_of, moves
from xei_lang.check.registry import Registry
from xei_lang.check.works import Work
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Step, Value
from xei_lang.profiles.instruments import instrument_of
from xei_lang.profiles.model import SkillSpec
from xei_lang.record import Shown, record
from xei_lang.world.places import place_text


@record
class Touch(Shown):
    """A step touches `thing` (in words), and so `held`, which an instrument holds; `how` says why."""

    thing: str
    held: str
    how: str
    span: Span


def held(skill: SkillSpec, args: Mapping[str, Value]) -> tuple[str, ...]:
    """What an instrument's skill holds: the instrument, and the objects of the arguments it `occupies`."""
    things = [instrument_of(skill, args)]
    for name in skill.occupies:
        things.extend(name for name, _ in _things(args.get(name)))
    return tuple(name for name in dict.fromkeys(things) if name)


def touches(step: Step, work: Work, registry: Registry) -> Touch | None:
    """How a step touches what a work holds: by an argument that is held or stands in it, or by moving what
    the held thing stands on. None where it does not.
    """
    at = {fact.subject: fact.value for fact in step.state_before if fact.variable == "at"}
    moved = _moved(step, registry)
    for argument in step.args:
        span = argument.span if argument.source == "call" else step.span
        for name, words in _things(argument.value):
            inside = [name, *below(name, at)]
            found = next((thing for thing in inside if thing in work.holds), None)
            if found is not None:
                return Touch(words, found, _how(words, name, found), span)
            carried = next((thing for thing in work.holds if name in below(thing, at)), None)
            if carried is not None and name in moved:
                return Touch(words, carried, f"carries `{carried}`", span)
    return None


def below(name: str, at: Mapping[str, Value]) -> Iterator[str]:
    """What an object stands in or on, what that stands on, and so on."""
    seen = {name}
    while isinstance(place := at.get(name), PlaceRef) and place.object not in seen:
        name = place.object
        seen.add(name)
        yield name


def _how(words: str, name: str, found: str) -> str:
    if words == found:
        return "is held until then"
    return f"is in `{found}`" if name == found else f"stands in `{found}`"


def _moved(step: Step, registry: Registry) -> frozenset[str]:
    skill = registry.skills.get(step.skill)
    subjects = [] if skill is None else [subject for subject, _ in moves(effects_of(skill))]
    values = (step.arg(name) for name in subjects)
    return frozenset(value.name for value in values if isinstance(value, ObjectRef))


def _things(value: Value | None) -> Iterable[tuple[str, str]]:
    """The objects that a value speaks of, each with its words."""
    match value:
        case ObjectRef(name=name):
            return ((name, name),)
        case PlaceRef(object=name):
            return ((name, place_text(value)),)
        case tuple():
            return tuple(thing for item in value for thing in _things(item))
        case _:
            return ()
