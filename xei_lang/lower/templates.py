"""Declarative templates: each line of a skill's template becomes one goal (a named configuration one for each
hand that holds something, and one for the rest), repeated lines one each time. A new skill is
a few lines of the skill bank.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from types import MappingProxyType

from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.goals import GoalKind
from xei_lang.lower import build_arm, build_other
from xei_lang.lower.draft import Builder, Draft
from xei_lang.lower.refusal import refuse, told_at
from xei_lang.lower.task import Task, refuse_template
from xei_lang.lower.threads import refuse_half_turned
from xei_lang.profiles.model import MOST_TIMES, Repeat, TemplateStep

BUILDERS: Mapping[GoalKind, Builder] = MappingProxyType(
    {
        "move_to": build_arm.MOVE_TO,
        "open_gripper": build_arm.OPEN_GRIPPER,
        "close_gripper": build_arm.CLOSE_GRIPPER,
        "attach": build_arm.ATTACH,
        "detach": build_arm.DETACH,
        "slide_move": build_other.SLIDE_MOVE,
        "nav_to_pose": build_other.NAV_TO_POSE,
        "perceive": build_other.PERCEIVE,
        "set_do": build_other.SET_DO,
        "wait": build_other.WAIT,
        "confirm": build_other.CONFIRM,
        "instrument": build_other.INSTRUMENT,
    }
)


def expand(task: Task, lines: tuple[TemplateStep, ...] | None = None) -> tuple[Draft, ...]:
    """The drafts of a step's template, or of some of its lines, in order; `task.scene` is left as the step
    leaves it.

    Raises Refusal: XEI0701 at the profile's line for a template that names what does not exist, or leaves a
    cap half turned, else the diagnostic of the operation that cannot be planned.
    """
    drafts: list[Draft] = []
    before = task.scene
    for repeat, group in groupby(task.spec.template if lines is None else lines, lambda line: line.repeat):
        block = tuple(group)
        for line in block * (1 if repeat is None else times(task, repeat, block[0])):
            with told_at(line.span):
                built = _builder(line).build(task, line)
            drafts.extend(built if isinstance(built, tuple) else (built,))
            task.scene = drafts[-1].scene if drafts else task.scene
    refuse_half_turned(task, before, drafts)
    return tuple(drafts)


def times(task: Task, repeat: Repeat, line: TemplateStep) -> int:
    """How often the lines of a repeat are gone through: stated in the template, by the call, or computed by
    an operation that the lines before it, or its only arm, work with. Refuses what is no such number
    (XEI0702).
    """
    if isinstance(repeat.times, int):
        return repeat.times
    arms = tuple(task.arms.values())
    setting = task.setting(repeat.times, arms[0].arm if len(arms) == 1 else None, line)
    with told_at(repeat.span):
        value = setting.si("Fraction")
    least = 0 if setting.source == "computed" else 1
    if value != round(value) or not least <= value <= MOST_TIMES:
        refuse(
            "XEI0702",
            f"`{setting.name}` of {setting.text} is no number of times",
            setting.span or task.step.span,
            f"expected a whole number, 1 .. {MOST_TIMES}",
        )
    return round(value)


def _builder(line: TemplateStep) -> Builder:
    builder = BUILDERS.get(line.kind)
    if builder is None:
        refuse_template(
            line, f"a template cannot use `{line.kind}` yet", "not a kind of goal that is lowered"
        )
    known = (*builder.required, *builder.optional)
    written = tuple(name for name, _ in line.fields)
    for name in written:
        if name not in known:
            nearest = did_you_mean(name, known)
            hint = f"; did you mean `{nearest[0]}`" if nearest else ""
            refuse_template(
                line, f"`{line.kind}` has no field `{name}`", f"expected {', '.join(known)}{hint}"
            )
    for name in builder.required:
        if name not in written:
            refuse_template(
                line, f"`{line.kind}` needs the field `{name}`", f"found {', '.join(written) or 'none'}"
            )
    return builder
