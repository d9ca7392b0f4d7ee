"""What each step of a timed plan takes, against the `duration` of its skill in the skill bank."""

from __future__ import annotations

import math

from xei_lang.diagnostics import Diagnostic, Diagnostics, Label, Span
from xei_lang.ir.goals import Instrument, MotionGoalGraph
from xei_lang.ir.skill_plan import SkillPlan, Step
from xei_lang.ir.timed import TimedPlan
from xei_lang.profiles.model import SkillBank, SkillSpec
from xei_lang.record import Record, record

_SLACK_S = 1e-6
"""The clock of a plan is a sum of many times: less than this is no difference."""


@record
class _Excess(Record):
    """A step that takes `took_s`, and by how much that is outside of its skill's bounds."""

    step: Step
    skill: SkillSpec
    took_s: float
    begins_s: float
    is_long: bool
    by_s: float


def check_durations(
    plan: SkillPlan, graph: MotionGoalGraph, timed: TimedPlan, bank: SkillBank
) -> Diagnostics:
    """Calls that take longer or less than their skill says (XEI0810): of each the step that is furthest off.

    A step lasts from the start of its first goal to the end of its last one, its waits included. Work that a
    `start` begins lasts as long as the instrument works, however long the protocol lets it be. The shortest
    time is not asked of steps in which a reading or a person's answer takes a time that no plan knows.
    """
    told: dict[tuple[str, Span, bool], list[_Excess]] = {}
    open_ended = {goal.step_id for goal in graph.goals if goal.kind == "confirm"}
    times = _times(graph, timed)
    for step in plan.steps:
        skill = bank.skill(step.skill) if step.kind in ("skill", "start") else None
        if skill is None or step.step_id not in times:
            continue
        begins_s, took_s = times[step.step_id]
        shortest_s, longest_s = skill.duration_s
        if took_s > longest_s + _SLACK_S:
            found = _Excess(step, skill, took_s, begins_s, True, took_s - longest_s)
        elif took_s < shortest_s - _SLACK_S and not (skill.returns or step.step_id in open_ended):
            found = _Excess(step, skill, took_s, begins_s, False, shortest_s - took_s)
        else:
            continue
        told.setdefault((skill.name, step.span, found.is_long), []).append(found)
    return tuple(_diagnostic(found) for found in told.values())


def _times(graph: MotionGoalGraph, timed: TimedPlan) -> dict[str, tuple[float, float]]:
    """When each step begins and how long it takes (s)."""
    ends: dict[str, tuple[float, float]] = {}
    for goal in timed.goals:
        first, last = ends.get(goal.step_id, (goal.start_s, goal.end_s))
        ends[goal.step_id] = min(first, goal.start_s), max(last, goal.end_s)
    times = {step: (first, last - first) for step, (first, last) in ends.items()}
    for step, work_s in _left_working(graph).items():
        if step in times:
            times[step] = times[step][0], work_s
    return times


def _left_working(graph: MotionGoalGraph) -> dict[str, float]:
    """The working times (s) of the steps that begin work and do not wait for its end themselves."""
    events = [(goal.step_id, goal.action) for goal in graph.goals if isinstance(goal.action, Instrument)]
    waited = {step for step, action in events if action.event == "await" and action.run == step}
    return {step: action.work_s for step, action in events if action.event == "start" and step not in waited}


def _diagnostic(found: list[_Excess]) -> Diagnostic:
    worst = max(found, key=lambda one: one.by_s)
    name, (shortest_s, longest_s) = worst.skill.name, worst.skill.duration_s
    took = _rounded(worst.took_s, up=worst.is_long)
    bound = f"at most {longest_s:g} s" if worst.is_long else f"at least {shortest_s:g} s"
    where = f"step `{worst.step.step_id}`, from {worst.begins_s:.2f} s of the plan on"
    others = len(found) - 1
    more = (f"so {'do' if others > 1 else 'does'} {others} more of this call, by less",) if others else ()
    stated = worst.skill.duration_span
    may = f"`{name}` may take {shortest_s:g} s .. {longest_s:g} s"
    return Diagnostic(
        "XEI0810",
        f"`{name}` takes {'longer' if worst.is_long else 'less'} than its `duration`",
        worst.step.span,
        f"takes {took:g} s, expected {bound}",
        labels=(Label(stated, may),) if stated else (),
        notes=(where, *more),
        help=(_way_out(worst),),
    )


def _rounded(seconds: float, *, up: bool) -> float:
    """To hundredths, away from the bound that it passes."""
    hundredths = round(seconds * 100, 6)
    return (math.ceil(hundredths) if up else math.floor(hundredths)) / 100


def _way_out(worst: _Excess) -> str:
    if worst.is_long:
        widen = f"write {math.ceil(worst.took_s - _SLACK_S)} s or more as its longest time"
    else:
        widen = f"write {math.floor(worst.took_s + _SLACK_S)} s or less as its shortest time"
    names = _depends_on(worst.skill)
    return f"{widen}, or change what it depends on: {', '.join(f'`{n}`' for n in names)}" if names else widen


def _depends_on(skill: SkillSpec) -> tuple[str, ...]:
    """The arguments and parameters of a skill that say how fast and how long its template moves or waits."""
    known = {*(item.name for item in skill.args), *(item.name for item in skill.parameters)}
    named = [line.field(field) for line in skill.template for field in ("for", "speed")]
    named += [line.repeat.times for line in skill.template if line.repeat]
    return tuple(dict.fromkeys(str(name) for name in named if name in known))
