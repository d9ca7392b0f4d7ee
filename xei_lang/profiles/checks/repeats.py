"""Lines of a template that are gone through several times: how often, and by whom."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.checks.operations import computed_for_times
from xei_lang.profiles.checks.template_values import check_times
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.instruments import OWNER
from xei_lang.profiles.model import MOST_TIMES, SkillSpec
from xei_lang.profiles.trees import Trees


def check_repeats(skill: SkillSpec, trees: Trees) -> Iterator[Diagnostic]:
    """How often each repeat of the template is gone through: a number from 1 on, or the name of one."""
    for repeat in dict.fromkeys(step.repeat for step in skill.template):
        if repeat is None:
            continue
        span = trees.of_skill(skill.name, "template", repeat.number, "repeat", "times")
        if skill.owner == OWNER:
            yield Diagnostic(
                "XEI0623",
                f"the template of `{skill.name}` repeats lines, and an instrument performs it",
                repeat.span,
                label="expected each goal once: its waits are how long the work takes",
            )
        if isinstance(repeat.times, int):
            if not 1 <= repeat.times <= MOST_TIMES:
                message = f"`{skill.name}` cannot repeat its lines {repeat.times} times"
                yield Diagnostic("XEI0623", message, span, label=f"expected 1 .. {MOST_TIMES}")
            continue
        first = next(step for step in skill.template if step.repeat is repeat)
        numbers = [arg.name for arg in skill.args if arg.type == "Int"]
        known = [*numbers, *computed_for_times(skill, first), *(item.name for item in skill.parameters)]
        if repeat.times not in known:
            what = f"a `times` for the template of `{skill.name}`"
            yield unknown(what, repeat.times, known, span, "XEI0623")
        else:
            yield from check_times(skill, repeat, trees)
