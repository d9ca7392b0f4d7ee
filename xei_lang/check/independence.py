"""What steps use, and whether steps that may overlap use the same: the rule of `parallel` and `unordered`.

Two branches may overlap where no thing is used in both, unless both uses leave it as it is. Exclusive are: an
object that a step is about, a slot or spot, an arm that is named, the base where it drives, the slide where
it is moved for itself, an output, and an instrument that no object stands for. Shared are what an object
stands on or in, which only a move of that disturbs, and the base under arms at work.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from xei_lang.check.effects import effects_of, moves
from xei_lang.check.registry import Registry
from xei_lang.check.touch import held
from xei_lang.diagnostics import Span
from xei_lang.ir.skill_plan import Fact, ObjectRef, PlaceRef, Step
from xei_lang.profiles.model import SkillSpec
from xei_lang.record import Shown, record
from xei_lang.world.places import place_text

_ROBOT = ("arm", "gripper", "base", "slide", "io", "person", "perception")
_BODY = ("_arm", "_gripper", "slide", "perception")


@record
class Use(Shown):
    """A step uses a `thing`; `words` name the thing, `verb` says what is done to it (`used`, `driven`)."""

    thing: tuple[str, str]
    words: str
    verb: str
    exclusive: bool
    span: Span
    step: Step


@dataclass(slots=True, eq=False)
class Uses:
    """The uses so far, by thing: enough of them to find one of another branch."""

    _seen: dict[tuple[str, str], list[tuple[int, Use]]] = field(
        default_factory=dict[tuple[str, str], list[tuple[int, Use]]]
    )

    def add(self, branch: int, use: Use) -> Use | None:
        """Keep a use, and return one of another branch that it cannot overlap with."""
        known = self._seen.setdefault(use.thing, [])
        for other, before in known:
            if other != branch and (use.exclusive or before.exclusive):
                return before
        if not any(other == branch and before.exclusive >= use.exclusive for other, before in known):
            # Shared uses by ever more branches all clash with the same exclusive one; two of them suffice.
            shared = [item for item in known if not item[1].exclusive]
            if use.exclusive or len(shared) < 2:
                known.append((branch, use))
        return None


def uses_of(step: Step, registry: Registry) -> Iterator[Use]:
    """Everything that a step uses, in the order of its arguments."""
    skill = registry.skills.get(step.skill)
    moved, kept = _moved(step, registry), _kept(step, skill)
    for argument in step.args:
        span = argument.span if argument.source == "call" else step.span
        match argument.value:
            case ObjectRef(name=name):
                yield Use(("object", name), f"`{name}`", "used", True, span, step)
                if name in kept:
                    yield Use(("under", name), f"`{name}`", "held", True, span, step)
                if name in moved:
                    yield Use(("under", name), f"`{name}`", "moved", True, span, step)
                for below in _below(name, step.state_before):
                    yield Use(("under", below), f"`{below}`", f"needed under `{name}`", False, span, step)
            case PlaceRef() as place:
                if place.kind != "surface":
                    text = place_text(place)
                    yield Use(("place", text), f"`{text}`", "used", True, span, step)
                yield Use(("under", place.object), f"`{place.object}`", "needed", False, span, step)
            case str(side) if argument.type == "Arm" and side in registry.arms:
                yield Use(("arm", side), f"the {side} arm", "asked for", True, span, step)
            case str(text) if argument.type == "Step":
                yield Use(("work", text), f"the work of `{text}`", "ended or paused", True, span, step)
            case str(text) if skill is not None and skill.owner == "io" and argument.type == "String":
                yield Use(("output", text), f'the output "{text}"', "set", True, span, step)
            case _:
                pass
    yield from _of_the_body(step)
    if skill is not None and skill.owner not in _ROBOT and not _has_device(step, registry):
        yield Use(
            ("instrument", skill.name), f"the instrument of `{skill.name}`", "used", True, step.span, step
        )


def _of_the_body(step: Step) -> Iterator[Use]:
    if "base" in step.resources:
        yield Use(("base", ""), "the base", "driven", True, step.span, step)
    elif any(part.endswith(_BODY) for part in step.resources):
        yield Use(("base", ""), "the base", "needed where it is", False, step.span, step)
    if step.resources == ("slide",):
        yield Use(("slide", ""), "the slide", "moved", True, step.span, step)


def _moved(step: Step, registry: Registry) -> frozenset[str]:
    skill = registry.skills.get(step.skill)
    if skill is None:
        return frozenset()
    effects = effects_of(skill)
    named = {subject for subject, _ in moves(effects)}
    values = (step.arg(name) for name in sorted(named))
    return frozenset(value.name for value in values if isinstance(value, ObjectRef))


def _kept(step: Step, skill: SkillSpec | None) -> tuple[str, ...]:
    """What an instrument holds while it carries out the step, and nothing else may touch."""
    if skill is None or skill.owner != "instrument" or skill.touchable:
        return ()
    return held(skill, {item.name: item.value for item in step.args})


def _below(name: str, facts: Iterable[Fact]) -> Iterator[str]:
    """What the object stands in, what that stands on, and so on."""
    at = {fact.subject: fact.value for fact in facts if fact.variable == "at"}
    seen = {name}
    while isinstance(place := at.get(name), PlaceRef) and place.object not in seen:
        name = place.object
        seen.add(name)
        yield name


def _has_device(step: Step, registry: Registry) -> bool:
    things = (
        registry.objects.get(item.value.name) for item in step.args if isinstance(item.value, ObjectRef)
    )
    return any(thing is not None and "movable" not in thing.roles for thing in things)
