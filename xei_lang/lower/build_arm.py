"""Goals of arms and grippers from the lines of a template."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

from xei_lang.diagnostics import Label
from xei_lang.ir.goals import Attach, Detach, Grip, MoveTo, Parameter, PathKind, in_hand
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef, Side
from xei_lang.lower.build_leave import LEAVING, leave
from xei_lang.lower.build_path import PATH_FIELDS, Speed, Way, speed_of, way_of
from xei_lang.lower.carry import states_of, to_carry_poses, to_configuration
from xei_lang.lower.draft import Builder, Draft, contacts
from xei_lang.lower.hand import fingers, hand_of
from xei_lang.lower.operations import Aim, Planned, operation_of_point
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.operations.handover import TAKE
from xei_lang.lower.operations.place import PLACE
from xei_lang.lower.operations.steady import STEADY
from xei_lang.lower.operations.twist import CAP
from xei_lang.lower.parameters import ROUNDING_M
from xei_lang.lower.payload import refuse_heavy
from xei_lang.lower.reach_bound import refuse_too_far
from xei_lang.lower.refusal import refuse
from xei_lang.lower.seats import place_text
from xei_lang.lower.task import Task, refuse_template
from xei_lang.lower.walk import Held, Standing
from xei_lang.profiles.model import TemplateStep
from xei_lang.quantity.lengths import exact_mm

_TAKING = (GRASP, TAKE, STEADY, CAP)
_PATHS: tuple[PathKind, ...] = get_args(PathKind)


def _move_to(task: Task, line: TemplateStep) -> Draft | tuple[Draft, ...]:
    path = line.field("path") or "free"
    if path not in _PATHS:
        refuse_template(line, f"`{path}` is not a path", f"expected one of {', '.join(_PATHS)}")
    if line.field("keep") not in (None, "upright"):
        refuse_template(line, f"`{line.field('keep')}` cannot be kept", "expected `upright`")
    speed = speed_of(task, line, _maybe_arm(task, line))
    if line.field("configuration") is not None:
        return _move_to_configuration(task, line, path, speed)
    return _move_to_point(task, line, path, speed)


def _move_to_configuration(task: Task, line: TemplateStep, path: PathKind, speed: Speed) -> tuple[Draft, ...]:
    """Arms that hold something go to their carry poses first, then the others to the configuration."""
    name, side = str(line.field("configuration")), _maybe_arm(task, line)
    states = states_of(task.profile, name, side)
    if not states:
        refuse_template(
            line,
            f"the robot's description has no configuration `{name}`",
            "expected a named state of the SRDF",
            f"rule: {task.profile.bank.srdf}",
        )
    upright, fraction = line.field("keep") == "upright", speed.fraction
    drafts = (
        *to_carry_poses(states, task.scene, task.profile, task.step.span, fraction),
        *to_configuration(states, task.scene, task.profile, side, path, upright, fraction),
    )
    return tuple(replace(draft, parameters=(*draft.parameters, *speed.told)) for draft in drafts)


def _move_to_point(task: Task, line: TemplateStep, path: PathKind, speed: Speed) -> Draft:
    at = str(line.field("at") or "")
    argument, _, point = at.rpartition(".")
    operation = operation_of_point(point)
    if operation is None or line.field("tool") is None:
        refuse_template(
            line,
            f"`{at}` is not a point of an operation",
            "expected `at: <argument>.<point>` with `tool`, or `configuration`",
        )
    arm = task.arm(line.field("tool"), line)
    planned = task.planned(operation, argument, arm, line)
    aim, way = planned.aims[point], way_of(task, line, path, arm)
    refuse_too_far(task, aim, planned)
    before = task.scene
    after = before.touch(arm, aim.support, aim.entered).reach(arm, aim.around)
    after = after.hold_at(arm, aim.T_world_held)
    uses = tuple(planned.settings[name].provenance() for name in aim.uses if name in planned.settings)
    allowed = contacts(before.reach(arm, ""), after.reach(arm, ""), arm if path == "free" else None)
    if aim.fingertips and path != "free":
        allowed = tuple(sorted({*allowed, *((aim.fingertips, body) for body in fingers(arm))}))
    parameters = _once((*task.why_arm(line.field("tool")), *uses, *way.told, *speed.told))
    action = _action(aim, arm, path, line, way, speed)
    resources = (f"{arm}_arm",) if aim.slide_stays else (f"{arm}_arm", "slide")
    return Draft("move_to", action, resources, after, parameters, allowed)


def _action(aim: Aim, arm: Side, path: PathKind, line: TemplateStep, way: Way, speed: Speed) -> MoveTo:
    return MoveTo(
        aim.target,
        arm,
        path,
        line.field("keep") == "upright",
        speed.fraction,
        way.path,
        speed.tool_speed_m_s,
        speed.tool_turn_rad_s,
    )


def _once(parameters: tuple[Parameter, ...]) -> tuple[Parameter, ...]:
    """The parameters without those that a later part names again."""
    return tuple(dict.fromkeys(parameters))


def _maybe_arm(task: Task, line: TemplateStep) -> Side | None:
    return task.arm(line.field("tool"), line) if line.field("tool") is not None else None


def _open_gripper(task: Task, line: TemplateStep) -> Draft:
    arm = task.arm(line.field("arm"), line)
    draft = _grip(task, line, arm)
    held = task.scene.held.get(arm)
    if held is not None and not held.touching and len(task.scene.holders(held.object)) == 1:
        _refuse_moving_jaws(task, arm, held, "would let it fall")
    return draft


def _close_gripper(task: Task, line: TemplateStep) -> Draft:
    arm = task.arm(line.field("arm"), line)
    draft = _grip(task, line, arm)
    held = task.scene.held.get(arm)
    if held is not None:
        _refuse_moving_jaws(task, arm, held, "would squeeze it")
    return draft


def _refuse_moving_jaws(task: Task, arm: Side, held: Held, what: str) -> None:
    refuse(
        "XEI0709",
        f"the {arm} gripper moves while it holds `{held.object}`, which {what}",
        task.step.span,
        f"expected an empty {arm} hand",
        (held.since,),
        help=(f"set `{held.object}` down first",),
    )


def _grip(task: Task, line: TemplateStep, arm: Side) -> Draft:
    width = task.setting(str(line.field("width")), arm, line)
    opening_m, most_m = width.si("Length"), hand_of(task.profile).max_gap_m
    if not 0.0 <= opening_m <= most_m + ROUNDING_M:
        refuse(
            "XEI0702",
            f"`{width.name}` of {width.text} is not a gap of this gripper",
            width.span or task.step.span,
            f"expected 0 mm .. {exact_mm(most_m)}",
        )
    parameters = (*task.why_arm(line.field("arm")), width.provenance())
    action = Grip(arm, min(opening_m, most_m))
    allowed = contacts(task.scene, task.scene)
    return Draft(line.kind, action, (f"{arm}_gripper",), task.scene, parameters, allowed)


def _attach(task: Task, line: TemplateStep) -> Draft:
    arm, argument = task.arm(line.field("arm"), line), str(line.field("object"))
    subject = task.argument(argument)
    planned = next(
        (plan for taking in _TAKING if (plan := task.plans.get((taking.name, argument, arm)))), None
    )
    if not isinstance(subject, ObjectRef) or planned is None or planned.family is None:
        refuse_template(
            line, f"`{argument}` was not grasped before `attach`", "expected `move_to` its grasp first"
        )
    refuse_heavy(task, subject.name, task.span_of(argument))
    standing, carrier = task.scene.standing.get(subject.name), task.scene.carrier_of(subject.name)
    known = standing is not None or carrier != ""
    T_world_object = task.scene.T_world_of(subject.name) if known else planned.T_world_placed
    assert T_world_object is not None
    held = Held(
        subject.name,
        planned.family,
        T_world_object,
        task.scene.in_base(T_world_object),
        planned.settings["standoff"].si("Length"),
        max(planned.wide_m, planned.settings["grasp_width"].si("Length")),
        planned.floor_m,
        standing.support if standing else carrier,
        Label(task.step.span, f"`{subject.name}` is picked up here"),
    )
    after = task.scene.attach(arm, held)
    action = Attach(subject.name, arm, planned.family.id)
    return Draft("attach", action, (f"{arm}_gripper",), after, (), contacts(task.scene, after))


def _detach(task: Task, line: TemplateStep) -> Draft:
    arm, argument = task.arm(line.field("arm"), line), str(line.field("at"))
    if argument in task.arms:
        return _hand_over(task, line, arm, task.arm(argument, line))
    if argument.partition(".")[2] in LEAVING:
        return leave(task, line, arm, argument)
    ref, planned = task.argument(argument), _place_plan(task, line, argument, arm)
    if not isinstance(ref, PlaceRef) or planned.T_world_placed is None:
        refuse_template(line, f"`{argument}` is not a place", "expected an argument of type Place")
    held = task.scene.held[arm]
    place = "" if ref.kind == "surface" else place_text(ref)
    since = Label(task.step.span, f"`{held.object}` is set down here")
    standing = Standing(held.object, planned.T_world_placed, place, ref.object, since)
    after = task.scene.detach(arm, standing)
    action = Detach(held.object, arm, place_text(ref), task.scene.in_base(planned.T_world_placed))
    return Draft("detach", action, (f"{arm}_gripper",), after, (), contacts(task.scene, after))


def _hand_over(task: Task, line: TemplateStep, giver: Side, taker: Side) -> Draft:
    """The giver leaves the object to the taker, which holds it where it was taken."""
    given, taken = task.scene.held.get(giver), task.scene.held.get(taker)
    if given is None or taken is None or given.object != taken.object:
        refuse_template(
            line, f"the {taker} hand does not hold what is left to it", "expected `attach` with it first"
        )
    after = task.scene.let_go(giver)
    action = Detach(given.object, giver, in_hand(taker), taken.T_base_grasped)
    return Draft("detach", action, (f"{giver}_gripper",), after, (), contacts(task.scene, after))


def _place_plan(task: Task, line: TemplateStep, argument: str, arm: Side) -> Planned:
    return task.planned(PLACE, argument, arm, line)


MOVE_TO = Builder((), ("tool", "at", "configuration", "path", "keep", "speed", *PATH_FIELDS), _move_to)
OPEN_GRIPPER = Builder(("arm", "width"), (), _open_gripper)
CLOSE_GRIPPER = Builder(("arm", "width"), (), _close_gripper)
ATTACH = Builder(("object", "arm"), (), _attach)
DETACH = Builder(("object", "arm", "at"), (), _detach)
