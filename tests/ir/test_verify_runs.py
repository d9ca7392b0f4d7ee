"""The verifier of goal graphs finds every fault of an instrument's run that is put into a sound graph."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import pytest

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Epoch, Instrument, MotionGoal, MotionGoalGraph, RunEvent
from xei_lang.ir.verify_goals import verify_goals

EVENTS: tuple[RunEvent, ...] = ("start", "pause", "resume", "await")


def goal(index: int, event: RunEvent | None, run: str = "warm", instrument: str = "block") -> MotionGoal:
    action = Instrument(instrument, "do", run if event else "", event, 60.0 if event else 0.0)
    return MotionGoal(str(index), "s", "instrument", action, 0, (instrument,), Span("a.xei", 0, 1))


def graph(*goals: MotionGoal) -> MotionGoalGraph:
    edges = tuple((before.id, after.id) for before, after in pairwise(goals))
    return MotionGoalGraph(goals, edges, (), (Epoch(0, "a", Pose()),))


def course(*events: RunEvent) -> MotionGoalGraph:
    return graph(*(goal(index, event) for index, event in enumerate(events)))


def changed(index: int, **fields: Any) -> MotionGoalGraph:
    goals = list(course(*EVENTS).goals)
    action: Any = goals[index].action
    goals[index] = replace(goals[index], action=replace(action, **fields))
    return graph(*goals)


@pytest.mark.parametrize(
    "sound",
    [
        course(*EVENTS),
        course("start", "stop"),
        course("start"),
        course("start", "pause", "resume", "pause", "resume", "stop"),
        graph(goal(0, "start"), goal(1, "await"), goal(2, "start", "again"), goal(3, None)),
        graph(
            goal(0, "start"), goal(1, "start", "b", "bath"), goal(2, "stop"), goal(3, "await", "b", "bath")
        ),
    ],
)
def test_a_sound_run_has_no_problem(sound: MotionGoalGraph) -> None:
    assert verify_goals(sound) == ()


@pytest.mark.parametrize(
    ("faulty", "words"),
    [
        (course("await"), "the `await` of `warm`, which has not started"),
        (course("start", "start"), "the `start` of `warm` after its `start`"),
        (course("start", "resume", "stop"), "the `resume` of `warm` after its `start`"),
        (course("start", "pause", "await"), "the `await` of `warm` after its `pause`"),
        (course("start", "await", "stop"), "the `stop` of `warm` after its `await`"),
        (course("start", "pause"), "never resumed"),
        (graph(goal(0, "start"), goal(1, "start", "again")), "`block` still works on `warm`"),
        (changed(3, instrument="bath"), "another instrument or working time"),
        (changed(3, work_s=1.0), "another instrument or working time"),
        (changed(0, work_s=math.nan), "is no duration"),
        (changed(0, run=""), "belongs to no run"),
    ],
)
def test_a_fault_is_found(faulty: MotionGoalGraph, words: str) -> None:
    assert any(words in problem for problem in verify_goals(faulty)), verify_goals(faulty)
