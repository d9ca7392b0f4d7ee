"""The work of single operations, ready to be planned: steps and scenes by hand, without a template."""

from __future__ import annotations

from dataclasses import replace

from tests.lower.plans import bench, plan
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.skill_plan import Fact, ObjectRef, PlaceRef, Side, Step, Value
from xei_lang.lower.operations import Work
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.parameters import layers_of
from xei_lang.lower.walk import Held, Scene
from xei_lang.profiles.model import Profile

SPAN = Span("test.xei", 0, 1)
Args = dict[str, Value]


def step_of(skill: str, args: Args, *known: Fact) -> Step:
    """A step that calls a skill, with what is known when it starts."""
    return replace(plan((skill, args)).steps[0], state_before=known)


def work_of(
    step: Step,
    subject: ObjectRef | PlaceRef,
    about: str,
    scene: Scene,
    arm: Side = "left",
    profile: Profile | None = None,
    destinations: tuple[PlaceRef, ...] = (),
) -> Work:
    """The work of an operation on `subject` in a step that is about the object `about`."""
    profile = profile or bench()[0]
    spec = profile.bank.skill(step.skill)
    assert spec is not None
    named = subject.name if isinstance(subject, ObjectRef) else about
    layers = layers_of(step, spec, profile.object(named))
    return Work(profile, scene, step, layers, subject, SPAN, arm, about, destinations, "family")


def grasp_of(
    name: str,
    scene: Scene,
    arm: Side = "left",
    profile: Profile | None = None,
    destinations: tuple[PlaceRef, ...] = (),
) -> Work:
    """The work of grasping an object that stands in the scene."""
    step = step_of("pick", {"object": ObjectRef(name), "arm": arm})
    return work_of(step, ObjectRef(name), name, scene, arm, profile, destinations)


def holding(
    name: str,
    scene: Scene,
    arm: Side = "left",
    profile: Profile | None = None,
    destinations: tuple[PlaceRef, ...] = (),
) -> Scene:
    """The scene after a hand has grasped an object where it stands."""
    work = grasp_of(name, scene, arm, profile, destinations)
    planned, standing = GRASP.plan(work), scene.standing[name]
    assert planned.family is not None
    held = Held(
        name,
        replace(planned.family, id="held"),
        standing.T_world_object,
        scene.T_base_object(name),
        planned.settings["standoff"].si("Length"),
        planned.settings["grasp_width"].si("Length"),
        planned.floor_m,
        standing.support,
        Label(SPAN, f"`{name}` is picked up here"),
    )
    return scene.attach(arm, held)
