"""What the template of an instrument's skill says: which instrument works, for how long, and what begins and
ends it.

The lines before the first `wait` begin the work and those after the last one end it; the waits are the work.
"""

from __future__ import annotations

from collections.abc import Mapping

from xei_lang.ir.skill_plan import ObjectRef, RunValue, Value
from xei_lang.profiles.model import SkillSpec, TemplateStep
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import TIME

OWNER = "instrument"


def startable(skill: SkillSpec) -> bool:
    """Whether a protocol may `start` it: an instrument does it, and it gives nothing back."""
    return skill.owner == OWNER and skill.exposed and skill.returns is None


def instrument_of(skill: SkillSpec, args: Mapping[str, Value]) -> str:
    """The object that does the work; empty where no line of the template names one."""
    for line in skill.template:
        if line.kind == "instrument":
            name = str(line.field("instrument"))
            value = args.get(name, name)
            return value.name if isinstance(value, ObjectRef) else str(value)
    return ""


def work_duration_s(skill: SkillSpec, args: Mapping[str, Value]) -> tuple[float, float]:
    """Shortest and longest time that the work takes: the waits of its template where they say it, else what
    the skill declares.
    """
    waits = [_seconds(line, skill, args) for line in skill.template if line.kind == "wait"]
    known = [bounds for bounds in waits if bounds is not None]
    if not waits or len(known) < len(waits):
        return skill.duration_s
    return sum(low for low, _ in known), sum(high for _, high in known)


def parts(template: tuple[TemplateStep, ...]) -> tuple[tuple[TemplateStep, ...], tuple[TemplateStep, ...]]:
    """The lines that begin the work and those that end it; without a wait all of them begin it."""
    waits = [index for index, line in enumerate(template) if line.kind == "wait"]
    if not waits:
        return template, ()
    return template[: waits[0]], template[waits[-1] + 1 :]


def _seconds(line: TemplateStep, skill: SkillSpec, args: Mapping[str, Value]) -> tuple[float, float] | None:
    name = line.field("for")
    parameter = next((item.value for item in skill.parameters if item.name == name), None)
    value = args.get(str(name), parameter)
    low, high = (value.lower, value.upper) if isinstance(value, RunValue) else (value, value)
    if not isinstance(low, Quantity) or not isinstance(high, Quantity) or low.dimension != TIME:
        return None
    return low.si, high.si
