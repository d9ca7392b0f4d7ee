"""Work of instruments that goes on while other goals happen: its goals, by the template of its skill.

The template's lines before its first `wait` begin the work, those after its last one end it
(`profiles/instruments.py`). The waits become the duration of an `await`.
"""

from __future__ import annotations

from dataclasses import replace

from xei_lang.ir.goals import Instrument, RunEvent
from xei_lang.ir.skill_plan import StepKind
from xei_lang.lower.draft import Draft, contacts
from xei_lang.lower.refusal import refuse
from xei_lang.lower.task import Task
from xei_lang.lower.templates import expand
from xei_lang.profiles.instruments import OWNER, parts, work_duration_s

ENDS: tuple[StepKind, ...] = ("await", "stop", "leave", "pause", "resume")
"""Kinds of steps that are about a step of kind `start`, which their argument `step` names."""


def start(task: Task) -> tuple[Draft, ...]:
    """The goals of a start: what begins the work; its last command to an instrument begins the run."""
    drafts = list(expand(task, parts(task.spec.template)[0]))
    found = [index for index, draft in enumerate(drafts) if isinstance(draft.action, Instrument)]
    if not found:
        refuse(
            "XEI0701",
            f"`{task.spec.name}` cannot be started, as its template gives no instrument a command",
            task.spec.span,
            "expected a line `instrument: {instrument: ..., command: ...}` before the first `wait`",
        )
    draft = drafts[found[-1]]
    assert isinstance(draft.action, Instrument)
    action = replace(draft.action, run=task.step.step_id, event="start", work_s=_work_s(task))
    drafts[found[-1]] = replace(draft, action=action)
    return tuple(drafts)


def whole(task: Task) -> tuple[Draft, ...]:
    """The goals of a skill that is called and not started: where no line of its template waits for the end of
    the work, a last goal does.
    """
    spec = task.spec
    waits = any(line.kind == "wait" for line in spec.template)
    commands = any(line.kind == "instrument" for line in spec.template)
    if spec.owner != OWNER or spec.returns is not None or waits or not commands:
        return expand(task)
    begun = start(task)
    run = next(draft.action for draft in begun if isinstance(draft.action, Instrument) and draft.action.event)
    return (*begun, _command(task, run, "await"))


def end(kind: StepKind, started: Task, run: Instrument) -> tuple[Draft, ...]:
    """The goals of a step that is about the start `started`, whose run began with `run`; none where the work
    is left to itself.
    """
    closing = parts(started.spec.template)[1]
    match kind:
        case "await" | "stop":
            return (_command(started, run, kind), *expand(started, closing))
        case "pause" | "resume":
            return (_command(started, run, kind),)
        case _:
            return ()


def _command(task: Task, run: Instrument, event: RunEvent) -> Draft:
    scene, action = task.scene, replace(run, command=event, event=event)
    return Draft("instrument", action, (run.instrument,), scene, (), contacts(scene, scene))


def _work_s(task: Task) -> float:
    return work_duration_s(task.spec, {item.name: item.value for item in task.step.args})[1]
