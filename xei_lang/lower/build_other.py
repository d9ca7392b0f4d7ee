"""Goals of slide, base, perception, outputs and people from the lines of a template."""

from __future__ import annotations

import math
from dataclasses import replace

from xei_lang.ir.goals import Confirm, Instrument, NavToPose, Parameter, Perceive, SetDo, SlideMove, Wait
from xei_lang.ir.skill_plan import ObjectRef
from xei_lang.ir.tolerance import as_bound
from xei_lang.lower.draft import Builder, Draft, contacts
from xei_lang.lower.look import look_height
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task, refuse_template
from xei_lang.profiles.model import TemplateStep
from xei_lang.quantity.lengths import exact_mm

_WHOLE_ROBOT = ("base", "left_arm", "right_arm", "slide")
_BY_MAP = "the quickest way of straight legs and turns in place that the map leaves the base"


def _slide_move(task: Task, line: TemplateStep) -> Draft:
    name = str(line.field("height"))
    argument, _, attribute = name.partition(".")
    if attribute == "slide":
        action = SlideMove(task.station(argument, line).slide_m)
        return _draft(task, line, action, ("slide",))
    if attribute == "look_height":
        height, told = look_height(task, argument, line)
        draft = _draft(task, line, SlideMove(height.si("Length")), ("slide",))
        return replace(draft, parameters=told)
    setting = task.setting(name, None, line)
    height_m, joint = setting.si("Length"), task.profile.robot.joint("slide_joint")
    if joint is not None and not joint.lower - 1e-9 <= height_m <= joint.upper + 1e-9:
        refuse(
            "XEI0702",
            f"`{setting.name}` of {setting.text} is outside the slide's travel",
            setting.span or task.step.span,
            f"expected {exact_mm(joint.lower)} .. {exact_mm(joint.upper)}",
        )
    draft = _draft(task, line, SlideMove(height_m), ("slide",))
    return Draft(
        "slide_move", draft.action, draft.resources, draft.scene, (setting.provenance(),), draft.contacts
    )


def _nav_to_pose(task: Task, line: TemplateStep) -> Draft:
    station, calibration = task.station(str(line.field("station")), line), task.profile.calibration
    action = NavToPose(
        station.name,
        station.T_world_base,
        as_bound(calibration.docking_position_tolerance_m, calibration.docking_tolerance_as),
        as_bound(calibration.docking_rotation_tolerance_rad, calibration.docking_tolerance_as),
    )
    after = task.scene.drive(station.name, station.T_world_base)
    way, allowed = task.scene.way_to(station.name), contacts(task.scene, after)
    if way is None:
        return Draft("nav_to_pose", action, _WHOLE_ROBOT, after, (), allowed)
    drive_s = way.length_m / calibration.base_speed_m_s + way.turn_rad / calibration.base_turn_rad_s
    told = (
        Parameter("drive_length", f"{way.length_m:.2f} m", "computed", _BY_MAP),
        Parameter("drive_turn", f"{math.degrees(way.turn_rad):.0f} deg", "computed", _BY_MAP),
    )
    return Draft("nav_to_pose", action, _WHOLE_ROBOT, after, told, allowed, drive_s)


def _perceive(task: Task, line: TemplateStep) -> Draft:
    name = str(line.field("frame"))
    argument, _, attribute = name.partition(".")
    frame = _ground_frame(task, argument, line) if attribute == "ground_frame" else name
    after = task.scene.perceive()
    return Draft("perceive", Perceive(frame), ("perception",), after, (), contacts(task.scene, after))


def _ground_frame(task: Task, argument: str, line: TemplateStep) -> str:
    """The frame that a station grounds; of an object, that of the station where the base stands."""
    if not isinstance(task.argument(argument), ObjectRef):
        return task.station(argument, line).ground_frame
    stations = task.profile.calibration.stations
    return next(item.ground_frame for item in stations if item.name == task.scene.epoch.station)


def _set_do(task: Task, line: TemplateStep) -> Draft:
    output, value = _literal_or_argument(task, line, "output"), _literal_or_argument(task, line, "value")
    if not isinstance(output, str) or not isinstance(value, bool):
        refuse_template(
            line, "`set_do` needs an output's name and true or false", f"found `{output}` and `{value}`"
        )
    return _draft(task, line, SetDo(output, value), ("io",))


def _wait(task: Task, line: TemplateStep) -> Draft:
    setting = task.setting(str(line.field("for")), None, line)
    duration_s = setting.si("Time")
    allowed = contacts(task.scene, task.scene)
    provenance = (setting.provenance(),)
    return Draft("wait", Wait(duration_s), (), task.scene, provenance, allowed, duration_s, duration_s)


def _confirm(task: Task, line: TemplateStep) -> Draft:
    return _draft(task, line, Confirm(str(_literal_or_argument(task, line, "text"))), ("person",))


def _instrument(task: Task, line: TemplateStep) -> Draft:
    name, command = _literal_or_argument(task, line, "instrument"), str(line.field("command"))
    if not isinstance(name, ObjectRef):
        refuse_template(line, f"`{name}` is not an instrument", "expected an argument of type object")
    settings = tuple(setting.provenance() for setting in task.layers().call.values())
    draft = _draft(task, line, Instrument(name.name, command), (name.name,))
    return Draft(line.kind, draft.action, draft.resources, task.scene, settings, draft.contacts)


def _literal_or_argument(task: Task, line: TemplateStep, field: str) -> object:
    written = line.field(field)
    value = task.argument(written) if isinstance(written, str) else None
    return written if value is None else value


def _draft(
    task: Task,
    line: TemplateStep,
    action: SlideMove | SetDo | Confirm | Instrument,
    resources: tuple[str, ...],
) -> Draft:
    return Draft(line.kind, action, resources, task.scene, (), contacts(task.scene, task.scene))


SLIDE_MOVE = Builder(("height",), (), _slide_move)
NAV_TO_POSE = Builder(("station",), (), _nav_to_pose)
PERCEIVE = Builder(("frame",), (), _perceive)
SET_DO = Builder(("output", "value"), (), _set_do)
WAIT = Builder(("for",), (), _wait)
CONFIRM = Builder(("text",), (), _confirm)
INSTRUMENT = Builder(("instrument", "command"), (), _instrument)
