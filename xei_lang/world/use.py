"""Whether what is known of the objects that a plan uses is known well enough to use them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, SkillPlan, Step, Value
from xei_lang.ir.world import World, WorldObject
from xei_lang.profiles.checks.leaning import lean_text, leans, turned_text
from xei_lang.profiles.grid import prior_chain
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.world.ground import is_prior
from xei_lang.world.sources.observation import Observation, Observations
from xei_lang.world.sources.turned import should_stand

MIN_CONFIDENCE = 0.5
"""An object that the grounding is less sure of than this is not handled; a plain prior gives 0.6. The one
default of all skills, at compilation and before a run.
"""

_HANDS_OFF = ("perceive", "slide_move", "nav_to_pose", "wait", "confirm")
"""Goals with which no hand comes near an object."""


@dataclass(frozen=True, slots=True)
class Use:
    """The first step that uses an object, and how surely the object's place must be known for all of them."""

    name: str
    step: Step
    needed: float


def needed_confidence(profile: Profile, skill: str) -> float:
    """How surely it must be known where the objects of a skill are."""
    found = profile.bank.skill(skill)
    asked = found.min_confidence if found is not None else None
    return MIN_CONFIDENCE if asked is None else asked


def uses(plan: SkillPlan, profile: Profile) -> tuple[Use, ...]:
    """Each object that arguments of the plan name, in the plan's order; a place uses what it belongs to.

    The step is the one that asks for the most, of several the first.
    """
    found: dict[str, Use] = {}
    for step in plan.steps:
        needed = needed_confidence(profile, step.skill)
        for argument in step.args:
            for name in _objects(argument.value):
                if name not in found or found[name].needed < needed:
                    found[name] = Use(name, step, needed)
    return tuple(found.values())


def check_use(
    plan: SkillPlan, profile: Profile, world: World, observed: tuple[Observations, ...], *, strict: bool
) -> Diagnostics:
    """An error for each object that a step uses and that is known too little: with too low a confidence, or
    in strict mode by a prior only.
    """
    found: list[Diagnostic] = []
    for use in uses(plan, profile):
        item = world.find(use.name)
        known = profile.object(use.name)
        if known is None:
            continue
        if item is None:
            found.extend(_absent(use, known, profile, observed))
            continue
        if item.confidence < use.needed:
            found.append(_unsure(use, item))
        elif strict and not known.system and is_prior(item):
            found.append(_unseen(use, item, observed))
    return (*found, *_leaning(plan, profile, world))


def _leaning(plan: SkillPlan, profile: Profile, world: World) -> Iterator[Diagnostic]:
    """An error for the first step in which arms handle an object that should stand and does not."""
    told: set[str] = set()
    for step in plan.steps:
        skill = profile.bank.skill(step.skill)
        if skill is None or all(line.kind in _HANDS_OFF for line in skill.template):
            continue
        for name in (name for argument in step.args for name in _objects(argument.value)):
            known = profile.object(name)
            if known is None or name in told or world.find(name) is None or not should_stand(known):
                continue
            pose = world.T_world_object(name)
            if leans(pose):
                told.add(name)
                yield _not_upright(step, name, pose)


def _not_upright(step: Step, name: str, pose: Pose) -> Diagnostic:
    return Diagnostic(
        "XEI0632",
        f"`{name}` {lean_text(pose)}, and `{step.skill}` takes it to stand",
        step.span,
        label="handles it",
        notes=(turned_text(pose), "grasps and places are those of a thing that stands"),
        help=("put it upright and look again, or correct how it is turned: quaternions are x, y, z, w",),
    )


def _absent(
    use: Use, known: LabObject, profile: Profile, observed: tuple[Observations, ...]
) -> Iterator[Diagnostic]:
    """An error where the last that a source says of an object, or of what its prior has it in, is that it is
    absent.
    """
    for holder in prior_chain(profile, known):
        found = _last(holder.name, observed)
        if found is None:
            continue
        source, one = found
        if one.is_absent:
            within = (f"its prior has it in `{holder.name}`",) if holder is not known else ()
            yield Diagnostic(
                "XEI0710",
                f"`{use.name}` is not there, and `{use.step.skill}` uses it",
                use.step.span,
                label="uses it",
                labels=(Label(one.span, f"`{holder.name}` is said to be absent here"),) if one.span else (),
                notes=(f"{source.source} says that `{holder.name}` is absent", *within),
                help=("put it back and record the scene again, or use another one",),
            )
        return


def _last(name: str, observed: tuple[Observations, ...]) -> tuple[Observations, Observation] | None:
    """What was said last of where an object is, or that it is absent, and by whom."""
    said = [(source, one) for source in observed for one in source.items if one.name == name]
    said = [(source, one) for source, one in said if one.is_absent or one.T_frame_object is not None]
    return said[-1] if said else None


def _unsure(use: Use, item: WorldObject) -> Diagnostic:
    return Diagnostic(
        "XEI0661",
        f"`{use.name}` is not known surely enough to be used",
        use.step.span,
        label=f"confidence {item.confidence:g}, and `{use.step.skill}` needs {use.needed:g}",
        notes=(f"its confidence is from {dict(item.provenance)['confidence']}",),
        help=("look for it again, and compile with what was seen: `--world`",),
    )


def _unseen(use: Use, item: WorldObject, observed: tuple[Observations, ...]) -> Diagnostic:
    asked = ", ".join(source.source for source in observed)
    notes = (
        f"its place is from {dict(item.provenance)['pose']}",
        f"not seen by {asked}" if asked else "nobody was asked who has looked: there is no `--world`",
    )
    return Diagnostic(
        "XEI0662",
        f"nobody has seen `{use.name}`",
        use.step.span,
        label="with `--strict`, nothing is taken from a prior",
        notes=notes,
        help=("record the scene or ask the pose service: `--world scene.yaml`, `--world http://...`",),
    )


def _objects(value: Value) -> Iterator[str]:
    if isinstance(value, ObjectRef):
        yield value.name
    elif isinstance(value, PlaceRef):
        yield value.object
    elif isinstance(value, tuple):
        for item in value:
            yield from _objects(item)
