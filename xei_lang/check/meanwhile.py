"""While instruments work: no step may touch what they hold or use them, and each work must be ended.

The same of plans from elsewhere is in `plan_file/meanwhile`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xei_lang.check import work_errors
from xei_lang.check.touch import touches
from xei_lang.ir.skill_plan import Step
from xei_lang.profiles.instruments import OWNER, instrument_of
from xei_lang.profiles.model import SkillSpec

if TYPE_CHECKING:
    from xei_lang.check.expand import Expander


def watch(expander: Expander, step: Step) -> None:
    """Report a step, just added, that touches what a work holds or that uses its instrument.

    A skill that asks the same instrument for a value touches nothing.
    """
    context = expander.context
    skill = context.registry.skills.get(step.skill)
    if skill is None:
        return
    for work in expander.state.works:
        if work.step_id == step.step_id or work.told:
            continue
        if skill.owner == OWNER and work.instrument == _instrument(step, skill):
            if step.kind == "skill" and skill.returns is None:
                work_errors.already(context.reporter, work, work.instrument, step.span)
            continue
        touched = None if work.skill.touchable or work.paused else touches(step, work, context.registry)
        if touched is not None:
            work_errors.touched(context.reporter, work, touched)


def _instrument(step: Step, skill: SkillSpec) -> str:
    return instrument_of(skill, {item.name: item.value for item in step.args}) or skill.name


def all_ended(expander: Expander) -> None:
    """Report what was started and is never ended, once all steps are known."""
    reporter, begun = expander.context.reporter, expander.begun
    for work in expander.state.works:
        if work.told or work.left or expander.plan.full:
            continue
        if work.torn:
            work_errors.torn(reporter, work, begun.ends.get(work.step_id), None)
        elif not begun.lost:
            work_errors.never_ended(reporter, work)
