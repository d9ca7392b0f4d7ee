"""What an operation planner gets and gives: one contract for grasp, lift, place and whatever comes next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Family, ToolTarget
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Side, Step
from xei_lang.lower.parameters import Layers, Setting
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile


@dataclass(frozen=True, slots=True)
class Work:
    """What an operation plans for: its subject (the argument before the point), the arm, and the scene at
    that moment.

    `span` is the user's words for the subject. `object` names the object that the step is about, and
    `destinations` the places where the plan sets it down next. `family_id` is free for a new family.
    """

    profile: Profile
    scene: Scene
    step: Step
    layers: Layers
    subject: ObjectRef | PlaceRef
    span: Span
    arm: Side
    object: str
    destinations: tuple[PlaceRef, ...]
    family_id: str


@dataclass(frozen=True, slots=True)
class Aim:
    """A point of an operation: where the tool goes, and which parameters made it so.

    `support` is what the held object may touch once it is there; `around` is the object that the open jaws
    then enclose.
    """

    target: ToolTarget
    uses: tuple[str, ...]
    support: str = ""
    around: str = ""


@dataclass(frozen=True, slots=True)
class Planned:
    """The outcome: resolved settings and aims by name; the family of a grasp; for a place, where the object
    ends.

    `floor_m` is how deep the object stands in what carries it (from its bottom).
    """

    settings: Mapping[str, Setting]
    aims: Mapping[str, Aim]
    family: Family | None = None
    T_world_placed: Pose | None = None
    floor_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Operation:
    """A deterministic planner with the points and parameters that templates may name of it."""

    name: str
    points: tuple[str, ...]
    parameters: tuple[str, ...]
    plan: Callable[[Work], Planned]
