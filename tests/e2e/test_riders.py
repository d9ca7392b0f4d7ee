"""A closed bottle from the plan to the run: picked, lifted and set down elsewhere, its cap with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest

from tests.lower.capped import BOTTLE, CAP, capped
from tests.lower.plans import surface
from tests.motion.capped import cap_of, changed, findings
from tests.motion.sequence.bench import URDF, goals, obj, plan, planned
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.trace import TraceEvent
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.run import RunResult, run

STEPS = plan(
    ("pick", {"object": obj(BOTTLE), "arm": "either"}),
    ("place", {"object": obj(BOTTLE), "on": surface("table"), "arm": "either"}),
)


@cache
def given() -> Handoffs:
    profile, world = capped()
    timed, problems = planned(STEPS, profile, world)
    assert timed is not None, problems
    hashes = dict.fromkeys(("plan.json", "goals.json", "timed.json"), "0" * 64)
    return Handoffs(STEPS, goals(STEPS, profile, world), timed, world, profile, URDF, hashes)


def ran(handoffs: Handoffs) -> tuple[RunResult, list[TraceEvent]]:
    events: list[TraceEvent] = []
    return run(handoffs, "dry-run", Answers({}), events.append, 1.0), events


def without_cap(timed: TimedPlan) -> TimedPlan:
    """The plan in which one goal forgets the cap."""
    goal = next(goal for goal in timed.goals if goal.attached and goal.joints)
    return changed(timed, replace(goal, attached=tuple(item for item in goal.attached if item.object != CAP)))


def lost_cap(timed: TimedPlan) -> TimedPlan:
    """The plan in which the cap is carried and then left nowhere."""
    goal = next(goal for goal in timed.goals if goal.placed)
    return changed(timed, replace(goal, placed=tuple(item for item in goal.placed if item.object != CAP)))


def test_it_is_planned_verified_and_run() -> None:
    found = given()
    assert findings(found.timed, found.graph, found.world) == ()
    result, events = ran(found)
    assert result.status == "succeeded", result.diagnostics
    carrying = [goal.id for goal in found.timed.goals if goal.attached]
    told = {event.goal_id: event.representation for event in events if event.stage == "execution"}
    assert carrying
    assert all({BOTTLE, CAP} == set(told[name]["attached"]) for name in carrying)
    before = found.world.T_world_object(CAP).position_m
    left = next(item for goal in found.timed.goals for item in goal.placed if item.object == CAP)
    now = (found.graph.epochs[0].T_world_base @ left.T_base_object).position_m
    assert abs(now[0] - before[0]) + abs(now[1] - before[1]) > 0.05
    assert now[2] == pytest.approx(before[2], abs=2e-3)


@pytest.mark.parametrize("fault", [without_cap, lost_cap], ids=lambda fault: fault.__name__)
def test_a_cap_that_does_not_come_along_is_found(fault: Callable[[TimedPlan], TimedPlan]) -> None:
    found = given()
    (said,) = findings(fault(found.timed), found.graph, found.world)
    assert said.subject == CAP


def test_a_run_does_not_begin_to_move_a_bottle_whose_cap_was_forgotten() -> None:
    found = given()
    forgotten = without_cap(found.timed)
    result, _ = ran(replace(found, timed=forgotten))
    bare = next(goal for goal in forgotten.goals if goal.attached and goal.joints)
    assert (result.goal_id, [item.code for item in result.diagnostics]) == (bare.id, ["XEI0911"])
    assert cap_of(next(goal for goal in found.timed.goals if goal.id == bare.id)).object == CAP
