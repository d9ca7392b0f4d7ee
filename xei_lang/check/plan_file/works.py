"""What a plan from elsewhere starts and ends: each start is ended, once on any way, and only starts are."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.check.report import Reporter
from xei_lang.diagnostics import Label, Span
from xei_lang.ir.forms.json_tree import JsonNode
from xei_lang.ir.skill_plan import Step
from xei_lang.ir.verify_works import ABOUT, ENDS

_MOST_ENDS = 100
"""Of so many ends of one start it is looked whether two of them can happen."""


def check_works(steps: Sequence[Step], root: JsonNode, reporter: Reporter) -> None:
    """Report starts without an end or with two, and ends and pauses of what is no start.

    A step that the plan does not have is told of elsewhere.
    """
    nodes = root.items["skill_calls"].elements
    ids = [node.items["step_id"].span for node in nodes]
    first = {step.step_id: index for index, step in reversed(list(enumerate(steps)))}
    ends: dict[str, list[int]] = {step.step_id: [] for step in steps if step.kind == "start"}
    for index, step in enumerate(steps):
        named = step.arg("step")
        if step.kind not in ABOUT or not isinstance(named, str) or named not in first:
            continue
        if named not in ends:
            _no_start(step, named, ids[index], ids[first[named]], reporter)
        elif step.kind in ENDS:
            ends[named].append(index)
    for name, found in ends.items():
        if not found:
            help_ = ("add a step `await`, `stop` or `leave` with this id as `step`",)
            message, label = f"`{name[:80]}` is started and never ended", "started here"
            reporter.report("XEI0340", message, ids[first[name]], label, help=help_)
        for place, other in enumerate(found[1:_MOST_ENDS], start=1):
            before = next((index for index in found[:place] if _on_one_way(steps[index], steps[other])), None)
            if before is not None:
                labels = (Label(ids[before], "ended here before"), Label(ids[first[name]], "started here"))
                message = f"`{name[:80]}` is ended more than once"
                reporter.report("XEI0341", message, ids[other], "ended again here", labels=labels)
                break


def _no_start(step: Step, named: str, span: Span, other: Span, reporter: Reporter) -> None:
    reporter.report(
        "XEI0343",
        f"`{step.kind}` names `{named[:80]}`, which is no `start`",
        span,
        "expected a step of the kind `start`",
        labels=(Label(other, "this step is done when it ends"),),
    )


def _on_one_way(one: Step, other: Step) -> bool:
    """Whether both may happen in one run: one's conditions begin the other's."""
    shared = min(len(one.when), len(other.when))
    return [item.text for item in one.when[:shared]] == [item.text for item in other.when[:shared]]
