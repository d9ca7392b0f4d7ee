"""A goal before it has its id and its place in the graph, and the scene that it leaves behind."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from xei_lang.ir.goals import Action, GoalKind, Parameter
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.hand import hand_bodies
from xei_lang.lower.task import Task
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import TemplateStep

Contact = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Draft:
    """What a line of a template becomes."""

    kind: GoalKind
    action: Action
    resources: tuple[str, ...]
    scene: Scene
    parameters: tuple[Parameter, ...] = ()
    contacts: tuple[Contact, ...] = ()
    min_duration_s: float = 0.0
    max_duration_s: float = math.inf


@dataclass(frozen=True, slots=True)
class Builder:
    """How a goal kind is written in templates (its fields) and what makes the draft of it, or the drafts."""

    required: tuple[str, ...]
    optional: tuple[str, ...]
    build: Callable[[Task, TemplateStep], Draft | tuple[Draft, ...]]


def contacts(before: Scene, after: Scene, flying: Side | None = None) -> tuple[Contact, ...]:
    """The pairs that may touch between two scenes, sorted: what a hand holds or closes on with that hand,
    and what is held with the support that it has not left yet or comes to rest on, and with what it goes
    into or comes out of. A hand that flies freely touches no support.
    """
    pairs: list[Contact] = []
    for side, name in after.reached.items():
        pairs.extend((name, body) for body in hand_bodies(side))
    for scene in (before, after):
        for side, held in scene.held.items():
            pairs.extend((held.object, body) for body in hand_bodies(side))
            if side != flying:
                others = (*((held.touching,) if held.touching else ()), *held.entered)
                pairs.extend((held.object, other) for other in others)
    return tuple(sorted(dict.fromkeys(pairs)))
