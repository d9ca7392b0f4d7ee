"""Lowering: a SkillPlan becomes a MotionGoalGraph. The plan must have been checked against this profile."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from xei_lang.diagnostics import Diagnostic, Diagnostics, has_errors
from xei_lang.ir.goals import Action, Confirm, Instrument, MotionGoalGraph, Wait
from xei_lang.ir.skill_plan import ObjectRef, PoseIn, Side, SkillPlan, Step, Value
from xei_lang.ir.world import World
from xei_lang.lower import instruments
from xei_lang.lower.arms import arms_of, choose, destinations
from xei_lang.lower.assemble import Assembly
from xei_lang.lower.decided_later import decided_when_it_runs
from xei_lang.lower.draft import Draft, contacts
from xei_lang.lower.refusal import Refusal, refuse
from xei_lang.lower.scene_origin import STEP_ID, arrival, scene_origin
from xei_lang.lower.task import Task
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile, SceneOrigin, SkillSpec
from xei_lang.quantity import Quantity


def lower(
    plan: SkillPlan, profile: Profile, world: World, arms: Mapping[str, Side] = MappingProxyType({})
) -> tuple[MotionGoalGraph | None, Diagnostics]:
    """The goals of the plan in its partial order, after the scene origin motion; None where there are errors.

    Each mistake is reported once: after a step that cannot be lowered, later steps about the same objects are
    passed over. `arms` gives steps, by id, another arm than the plan or this room chose: motion planning asks
    for that where the first one cannot. The same arguments give the same graph, byte for byte.
    """
    undecided = decided_when_it_runs(plan)
    if undecided:
        return None, undecided
    scene = Scene.of(world, profile)
    assembly = Assembly(epochs=[scene.epoch])
    problems: list[Diagnostic] = []
    scene, forgotten = _start(assembly, scene, world, profile, problems), frozenset[str]()
    for index, step in enumerate(plan.steps):
        if forgotten.intersection(_objects(step)):
            continue
        try:
            scene = _lower_step(assembly, plan, index, scene, profile, arms.get(step.step_id))
        except Refusal as refusal:
            problems.append(refusal.diagnostic)
            forgotten = forgotten.union(_movable(step, profile))
            scene = scene.forget(_movable(step, profile))
    return (None if has_errors(tuple(problems)) else assembly.graph()), tuple(problems)


def _start(
    assembly: Assembly, scene: Scene, world: World, profile: Profile, problems: list[Diagnostic]
) -> Scene:
    station = _station(profile, world.robot.station)
    if station is None:
        problems.append(
            Diagnostic("XEI0715", f"the robot starts at `{world.robot.station}`, which is no station")
        )
        return scene
    try:
        drafts = scene_origin(scene, world, profile, station)
    except Refusal as refusal:
        problems.append(refusal.diagnostic)
        return scene
    assembly.add(STEP_ID, station.span, after=(), before=scene, drafts=drafts)
    return scene


def _station(profile: Profile, name: str) -> SceneOrigin | None:
    return next((item for item in profile.calibration.stations if item.name == name), None)


def _lower_step(
    assembly: Assembly, plan: SkillPlan, index: int, scene: Scene, profile: Profile, arm: Side | None
) -> Scene:
    step = plan.steps[index]
    after = step.after or (STEP_ID,)
    if step.kind in instruments.ENDS:
        return _lower_end(assembly, plan, index, scene, profile)
    spec = profile.bank.skill(step.skill) if step.kind in ("skill", "start") else None
    if spec is None:
        drafts = (_statement(step, scene),)
        assembly.add(step.step_id, step.span, after=after, before=scene, drafts=drafts)
        return scene
    _refuse_poses(step)
    task = _task(plan, index, spec, scene, profile, arm)
    drafts = instruments.start(task) if step.kind == "start" else instruments.whole(task)
    if task.scene.epoch.index > scene.epoch.index:
        drafts += _arrive(task)
    assembly.families.extend(task.families)
    assembly.add(step.step_id, step.span, after=after, before=scene, drafts=drafts)
    return task.scene


def _lower_end(assembly: Assembly, plan: SkillPlan, index: int, scene: Scene, profile: Profile) -> Scene:
    """A step that ends, pauses or resumes the work of an instrument; no goal where the start has none."""
    step, later = plan.steps[index], scene
    drafts: tuple[Draft, ...] = ()
    name = step.arg("step")
    begun = next((k for k in range(index - 1, -1, -1) if plan.steps[k].step_id == name), index)
    run = next((run for goal in reversed(assembly.goals) if (run := _run(goal.action, name))), None)
    spec = profile.bank.skill(plan.steps[begun].skill)
    if spec is not None and run is not None:
        task = _task(plan, begun, spec, scene, profile, None)
        drafts, later = instruments.end(step.kind, task, run), task.scene
    assembly.add(step.step_id, step.span, after=step.after or (STEP_ID,), before=scene, drafts=drafts)
    return later


def _run(action: Action, name: Value | None) -> Instrument | None:
    if isinstance(action, Instrument) and action.event == "start" and action.run == name:
        return action
    return None


def _refuse_poses(step: Step) -> None:
    """No line of a template can go to a pose that a call gives, so what it asks for would not happen."""
    for argument in step.args:
        values = argument.value if isinstance(argument.value, tuple) else (argument.value,)
        if any(isinstance(value, PoseIn) for value in values):
            what = f"`{argument.name}` of `{step.skill}`, a pose,"
            refuse(
                "XEI0105",
                f"{what} is not compiled to motion yet",
                argument.span,
                "no template goes to a pose",
                help=("give a place, such as a slot or a spot",),
            )


def _arrive(task: Task) -> tuple[Draft, ...]:
    station = _station(task.profile, task.scene.epoch.station)
    return arrival(task.scene, task.profile, station, task.spec.template) if station else ()


def _task(
    plan: SkillPlan, index: int, spec: SkillSpec, scene: Scene, profile: Profile, arm: Side | None
) -> Task:
    step = plan.steps[index]
    movable = _movable(step, profile)
    name = next((item for item in movable if scene.holder(item)), movable[0] if movable else "")
    ahead = destinations(plan, index, name, scene, profile) if name else ()
    about = name or next(iter(_objects(step)), "")
    arms = arms_of(step, spec, scene, arm, lambda: choose(about, ahead, scene, profile))
    return Task(profile, step, spec, scene, arms, name, ahead)


def _statement(step: Step, scene: Scene) -> Draft:
    """The goal of a statement of the language: `wait` and `confirm`; others are refused as not yet
    compiled.
    """
    allowed = contacts(scene, scene)
    if step.kind == "wait":
        duration = step.arg("duration")
        seconds = duration.si if isinstance(duration, Quantity) else step.duration_s[0]
        return Draft("wait", Wait(seconds), (), scene, (), allowed, seconds, seconds)
    if step.kind == "confirm":
        return Draft("confirm", Confirm(str(step.arg("text") or "")), ("person",), scene, (), allowed)
    what = f"the skill `{step.skill}`" if step.kind == "skill" else f"`{step.kind}`"
    return refuse(
        "XEI0105", f"{what} is not compiled to motion yet", step.span, "nothing here says how to move"
    )


def _objects(step: Step) -> tuple[str, ...]:
    return tuple(item.value.name for item in step.args if isinstance(item.value, ObjectRef))


def _movable(step: Step, profile: Profile) -> tuple[str, ...]:
    """The movable objects that a step is about, in the order of its arguments."""
    found = ((name, profile.object(name)) for name in _objects(step))
    return tuple(name for name, known in found if known is not None and "movable" in known.roles)
