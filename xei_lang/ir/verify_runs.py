"""What must hold of the runs of instruments in every goal graph."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType

from xei_lang.ir.goals import Instrument, MotionGoal, MotionGoalGraph, RunEvent

_NEXT: Mapping[RunEvent, tuple[RunEvent, ...]] = MappingProxyType(
    {
        "start": ("pause", "await", "stop"),
        "pause": ("resume",),
        "resume": ("pause", "await", "stop"),
        "await": (),
        "stop": (),
    }
)


def run_problems(graph: MotionGoalGraph) -> Iterator[str]:
    """Each run starts first and once, on one instrument that no other run is on; its events follow in turn,
    and a pause is resumed.
    """
    last: dict[str, tuple[MotionGoal, Instrument]] = {}
    busy: dict[str, str] = {}
    for goal in graph.goals:
        action = goal.action
        if not isinstance(action, Instrument) or action.event is None:
            continue
        for problem in _event(action, last.get(action.run), busy):
            yield f"goal `{goal.id}`: {problem}"
        last[action.run] = goal, action
        if action.event in ("await", "stop"):
            busy.pop(action.instrument, None)
        else:
            busy[action.instrument] = action.run
    for run, (goal, action) in last.items():
        if action.event == "pause":
            yield f"goal `{goal.id}`: it pauses `{run}`, which is never resumed"


def _event(
    action: Instrument, before: tuple[MotionGoal, Instrument] | None, busy: dict[str, str]
) -> Iterator[str]:
    if not action.run:
        yield "it belongs to no run"
    if not (math.isfinite(action.work_s) and action.work_s >= 0.0):
        yield f"its working time {action.work_s:g} s is no duration"
    if before is None:
        if action.event != "start":
            yield f"it is the `{action.event}` of `{action.run}`, which has not started"
        elif action.instrument in busy:
            yield f"`{action.instrument}` still works on `{busy[action.instrument]}`"
        return
    earlier = before[1]
    if earlier.event is not None and action.event not in _NEXT[earlier.event]:
        yield f"it is the `{action.event}` of `{action.run}` after its `{earlier.event}`"
    if replace(action, command="", event=None) != replace(earlier, command="", event=None):
        yield f"it has another instrument or working time than `{before[0].id}`"
