"""How a line of a template says which way the tool goes and how fast: `path` with `axis`, `angle`, `lead`,
`area`, `pitch`, and `speed`.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.goals import Parameter, PathKind
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.tool_paths import Raster, ToolPath, Turn
from xei_lang.lower.operations import Operation, Planned, operation_of_area, operation_of_axis
from xei_lang.lower.parameters import Setting
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task, refuse_template
from xei_lang.profiles.model import TemplateStep
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import ANGULAR_SPEED, SPEED

PATH_FIELDS = ("axis", "angle", "lead", "area", "pitch")
_FIELDS: dict[PathKind, tuple[str, ...]] = {
    "arc": ("axis", "angle"),
    "screw": ("axis", "angle", "lead"),
    "raster": ("area", "pitch"),
}


@dataclass(frozen=True, slots=True)
class Way:
    """A stated path, or None, and the parameters that shaped it."""

    path: ToolPath | None = None
    told: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Speed:
    """How fast a move may be: a share of full speed, or a bound on the tool itself (m/s or rad/s)."""

    fraction: float = 1.0
    tool_speed_m_s: float | None = None
    tool_turn_rad_s: float | None = None
    told: tuple[Parameter, ...] = ()


def speed_of(task: Task, line: TemplateStep, arm: Side | None) -> Speed:
    """What `speed` names: a fraction (`20 %`), a speed (`50 mm/s`) or an angular speed (`15 deg/s`)."""
    name = line.field("speed")
    if name is None:
        return Speed()
    setting = task.setting(str(name), arm, line)
    told = (setting.provenance(),)
    dimension = setting.value.dimension if isinstance(setting.value, Quantity) else None
    if dimension == SPEED:
        return Speed(tool_speed_m_s=_positive(task, setting, "Speed"), told=told)
    if dimension == ANGULAR_SPEED:
        return Speed(tool_turn_rad_s=_positive(task, setting, "AngularSpeed"), told=told)
    fraction = setting.si("Fraction")
    if not 0.0 < fraction <= 1.0:
        refuse(
            "XEI0702",
            f"`{setting.name}` of {setting.text} is not a fraction of full speed",
            setting.span or task.step.span,
            "expected more than 0 % and at most 100 %",
        )
    return Speed(fraction, told=told)


def _positive(task: Task, setting: Setting, type_name: str) -> float:
    value = setting.si(type_name)
    if value <= 0.0:
        refuse(
            "XEI0702",
            f"`{setting.name}` of {setting.text} is no speed",
            setting.span or task.step.span,
            "expected more than 0",
        )
    return value


def way_of(task: Task, line: TemplateStep, path: PathKind, arm: Side) -> Way:
    """The path that a line states; refuses a line whose fields do not fit its kind of path (XEI0701)."""
    wanted = _FIELDS.get(path, ())
    for name in PATH_FIELDS:
        if (line.field(name) is not None) != (name in wanted):
            found = "states" if line.field(name) is not None else "lacks"
            refuse_template(line, f"`path: {path}` {found} `{name}`", f"expected {_listed(wanted)}")
    if path == "raster":
        return _raster(task, line, arm)
    return _turn(task, line, path, arm) if wanted else Way()


def _listed(fields: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in fields) or "none of `axis`, `angle`, `lead`, `area`, `pitch`"


def _turn(task: Task, line: TemplateStep, path: PathKind, arm: Side) -> Way:
    planned, name = _planned(task, line, "axis", arm)
    axis = planned.axes[name]
    angle, sign = _signed(task, line, "angle", arm)
    lead = task.setting(str(line.field("lead")), arm, line) if path == "screw" else None
    lead_m = lead.si("Length") if lead is not None else 0.0
    told = (angle.provenance(), *((lead.provenance(),) if lead is not None else ()))
    return Way(Turn(axis.point_m, axis.direction, sign * angle.si("Angle"), lead_m), told)


def _raster(task: Task, line: TemplateStep, arm: Side) -> Way:
    planned, name = _planned(task, line, "area", arm)
    area, pitch = planned.areas[name], task.setting(str(line.field("pitch")), arm, line)
    pitch_m = pitch.si("Length")
    if pitch_m <= 0.0:
        refuse(
            "XEI0702",
            f"`{pitch.name}` of {pitch.text} is no distance between lanes",
            pitch.span or task.step.span,
            "expected more than 0 mm",
        )
    return Way(Raster(area.corner_m, area.along_m, area.across_m, pitch_m), (pitch.provenance(),))


def _signed(task: Task, line: TemplateStep, field: str, arm: Side) -> tuple[Setting, float]:
    """A parameter, and -1 where the template writes it with a minus before."""
    text = str(line.field(field))
    return task.setting(text.removeprefix("-"), arm, line), -1.0 if text.startswith("-") else 1.0


def _planned(task: Task, line: TemplateStep, field: str, arm: Side) -> tuple[Planned, str]:
    argument, _, name = str(line.field(field)).rpartition(".")
    operation: Operation | None = operation_of_axis(name) if field == "axis" else operation_of_area(name)
    if operation is None:
        refuse_template(
            line,
            f"`{line.field(field)}` is not an {field} of an operation",
            f"expected `{field}: <argument>.<{field}>`",
        )
    return task.planned(operation, argument, arm, line), name
