"""What an operation planner gets and gives: one contract for grasp, lift, place and whatever comes next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Side, Step
from xei_lang.lower.parameters import Layers, Setting
from xei_lang.lower.walk import Scene, Standing
from xei_lang.profiles.model import Profile
from xei_lang.record import Record, record


@record
class Work(Record):
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


@record
class Aim(Record):
    """A point of an operation: where the tool goes, and which parameters made it so.

    `support` is what the held object may touch once it is there; `around` is the object that the open jaws
    then enclose; `fingertips` is what the fingers themselves may touch on the way there or away; `entered`
    is what the held object goes into there, and may touch until it has come out again. With `slide_stays` the
    other arm, which rides on the slide too, is not moved. `T_world_held` is where the held object then is,
    where something is worked on it there.
    """

    target: ToolTarget
    uses: tuple[str, ...]
    support: str = ""
    around: str = ""
    fingertips: str = ""
    entered: tuple[str, ...] = ()
    slide_stays: bool = False
    T_world_held: Pose | None = None


@record
class Axis(Record):
    """A line in the base frame that an `arc` or `screw` turns about; `direction` is a unit vector."""

    point_m: Vec3
    direction: Vec3


@record
class Area(Record):
    """A rectangle in the base frame that a template's `raster` covers with the family's reference, from
    `corner_m` on.
    """

    corner_m: Vec3
    along_m: Vec3
    across_m: Vec3


@record
class Planned(Record):
    """The outcome: resolved settings and aims by name; the family of a grasp; for a place, where the object
    ends; axes and areas by name.

    `floor_m` is how deep the object stands in what carries it (from its bottom); `stood` is how it stood
    before it was taken, to be set down there again. `wide_m` is how wide what is grasped is between the jaws,
    which may squeeze it.
    """

    settings: Mapping[str, Setting]
    aims: Mapping[str, Aim]
    family: Family | None = None
    T_world_placed: Pose | None = None
    floor_m: float = 0.0
    axes: Mapping[str, Axis] = field(default_factory=dict[str, Axis])
    areas: Mapping[str, Area] = field(default_factory=dict[str, Area])
    stood: Standing | None = None
    wide_m: float = 0.0


@record
class Operation(Record):
    """A deterministic planner with the points and parameters that templates may name of it, and the axes and
    areas of its stated paths. A `fresh` one plans anew, from the scene by then, wherever it is named.

    `of` is what it works on: an object, an object's cap, or a place. It computes none of what it `needs`,
    which the call, the object or the skill's `parameters` give, nor of what only a call gives (`called`).
    """

    name: str
    points: tuple[str, ...]
    parameters: tuple[str, ...]
    plan: Callable[[Work], Planned]
    axes: tuple[str, ...] = ()
    areas: tuple[str, ...] = ()
    fresh: bool = False
    of: Literal["object", "cap", "Place"] = "object"
    needs: tuple[str, ...] = ()
    called: tuple[str, ...] = ()
