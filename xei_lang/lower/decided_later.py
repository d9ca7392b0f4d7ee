"""What a plan leaves to its run: readings, choices on them, and conditions to be looked at.

Motion is planned before anything runs, and there is one motion for one order of steps. Such a plan is
therefore refused here as a whole, by name, rather than planned as if one of its ways were taken.
"""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Diagnostics, Span
from xei_lang.ir.skill_plan import RunValue, SkillPlan, Step

_HELP = (
    "check it with `xei check`, and write its plan with `xei compile --emit plan`; "
    "motion for what is decided while it runs is not planned by this version",
)


def decided_when_it_runs(plan: SkillPlan) -> Diagnostics:
    """One diagnostic for each place in the text that leaves something to the run; conditions come first, and
    a reading is told only where nothing depends on it.
    """
    told: dict[Span, Diagnostic] = {}
    for step in plan.steps:
        for diagnostic in (*_conditions(step), *_values(step)):
            assert diagnostic.span is not None
            told.setdefault(diagnostic.span, diagnostic)
    used = {name for step in plan.steps for name in step.needs}
    for step in plan.steps:
        if step.kind == "measure" and step.step_id not in used:
            told.setdefault(
                step.span, _refused(f"`{step.skill}` is read only when it runs", step.span, "measured")
            )
        if step.kind == "stop" and step.arg("message") is not None and not step.when:
            told.setdefault(step.span, _refused("the run is stopped here", step.span, "ends the run"))
    return tuple(told[span] for span in sorted(told))


def _conditions(step: Step) -> Iterator[Diagnostic]:
    for condition in step.when:
        yield _refused(
            f"`{condition.text}` is decided only when it runs",
            condition.span,
            f"decided by {_listed(condition.needs)}"
            if condition.needs
            else "not decided when it is compiled",
        )
    for condition in step.keep:
        yield _refused(
            f"`{condition.text}` can be looked at only when it runs",
            condition.span,
            "not known when it is compiled",
        )


def _values(step: Step) -> Iterator[Diagnostic]:
    if step.kind == "require":
        text, at = step.arg("condition"), step.args[0].span
        yield _refused(f"`{text}` can be looked at only when it runs", at, "not known when it is compiled")
    for argument in step.args:
        if isinstance(argument.value, RunValue):
            yield _refused(
                f"`{argument.name}` of `{step.skill or step.kind}` is known only when it runs",
                argument.span,
                f"comes from {_listed(argument.value.needs)}",
            )


def _listed(steps: tuple[str, ...]) -> str:
    return " and ".join(f"`{name}`" for name in steps)


def _refused(message: str, span: Span, label: str) -> Diagnostic:
    return Diagnostic("XEI0722", message, span, label, help=_HELP)
