"""Started work becomes goals of its instrument."""

from __future__ import annotations

from functools import lru_cache

import pytest

from tests.check.checking import BENCH, check
from tests.lower.plans import bench
from xei_lang.ir.goals import Instrument, MotionGoal, MotionGoalGraph, Wait
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower

WARM = "start warm: heat(block=heater_block, to=37 degC, for=2 min)\n"


@lru_cache
def goals(body: str) -> MotionGoalGraph:
    plan, found = check(f'protocol p {{\n  profile "openarm_bench"\n{body}\n}}\n', BENCH)
    assert plan is not None, found
    profile, world = bench()
    graph, problems = lower(plan, profile, world)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def commands(body: str) -> list[tuple[str, str | None]]:
    actions = [goal.action for goal in goals(body).goals if goal.step_id != "scene_origin"]
    return [(item.command, item.event) for item in actions if isinstance(item, Instrument)]


def of_step(body: str, step_id: str) -> list[MotionGoal]:
    return [goal for goal in goals(body).goals if goal.step_id == step_id]


def test_a_start_gives_its_command_with_the_arguments_and_an_await_the_rest() -> None:
    body = WARM + "wait 1 s\n await warm"
    assert commands(body) == [("heat", "start"), ("await", "await")]
    (begun,) = of_step(body, "warm")
    assert begun.action == Instrument("heater_block", "heat", "warm", "start", 120.0)
    assert [(item.name, item.value) for item in begun.parameters] == [("to", "37 degC"), ("for", "2 min")]
    assert begun.resources == ("heater_block",)
    (end,) = of_step(body, "await#1")
    assert end.action == Instrument("heater_block", "await", "warm", "await", 120.0)
    assert ("wait#1/1", end.id) in goals(body).edges


@pytest.mark.parametrize(
    ("rest", "expected"),
    [
        ("stop warm", [("stop", "stop")]),
        ("leave warm", []),
        ("pause warm { wait 1 s }\n stop warm", [("pause", "pause"), ("resume", "resume"), ("stop", "stop")]),
    ],
)
def test_other_ends(rest: str, expected: list[tuple[str, str]]) -> None:
    assert commands(WARM + rest) == [("heat", "start"), *expected]


def test_what_follows_a_step_without_goals_follows_what_that_follows() -> None:
    assert ("warm/1", "wait#1/1") in goals(WARM + "leave warm\n wait 1 s").edges


def test_called_without_start_it_waits_for_its_end() -> None:
    found = of_step("heat(block=heater_block, to=37 degC, for=2 min)", "heat#1")
    assert [goal.action for goal in found] == [Instrument("heater_block", "heat"), Wait(120.0)]


def test_work_of_unknown_length_gets_the_longest_time() -> None:
    found = of_step('incubate(device=incubator, program="overnight")', "incubate#1")
    run = ("incubator", "incubate#1", 7200.0)
    actions = [goal.action for goal in found]
    assert [item.event for item in actions if isinstance(item, Instrument)] == ["start", "await"]
    assert all(
        (item.instrument, item.run, item.work_s) == run for item in actions if isinstance(item, Instrument)
    )
