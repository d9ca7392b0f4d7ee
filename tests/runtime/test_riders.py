"""What rides on a held object is in the hand too: the run knows it, asks the plan for it, and weighs it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.runtime.small import handoffs, with_timed
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach
from xei_lang.ir.timed import Attachment
from xei_lang.ir.trace import TraceEvent
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.run import RunResult, run
from xei_lang.runtime.state import RunState, after, initial_state

TUBE, CAP = "tube_1", "tube_1_cap"


def capped(mass_kg: float = 0.002) -> Handoffs:
    """The small run with a cap on its tube, which the plan knows."""
    given = handoffs()
    (tube,) = given.world.objects
    cap = replace(tube, name=CAP, mass_kg=mass_kg, place='tube_1.spot("mouth")', fastened_to=TUBE)
    given = replace(given, world=replace(given.world, objects=(tube, cap)))
    for goal in given.timed.goals:
        if goal.attached:
            on = Attachment(
                CAP, goal.attached[0].link, goal.attached[0].T_link_object @ Pose((0.0, 0.0, 0.1))
            )
            given = with_timed(given, goal.id, attached=(*goal.attached, on))
    return given


def ran(given: Handoffs) -> tuple[RunResult, list[TraceEvent]]:
    events: list[TraceEvent] = []
    return run(given, "dry-run", Answers({"confirm#1": True}), events.append, 1.0), events


def stopped(given: Handoffs) -> tuple[str, str, str]:
    """Code and message of what ended a run, and the goal that it ended at."""
    result, _ = ran(given)
    (said,) = result.diagnostics
    return said.code, result.goal_id, said.message


def test_a_closed_tube_is_carried_to_the_end() -> None:
    result, events = ran(capped())
    assert result.status == "succeeded"
    told = {event.goal_id: event.representation for event in events if event.stage == "execution"}
    assert told["lift"]["attached"] == [TUBE, CAP]
    assert told["lift"]["safety"]["payload_kg"] == pytest.approx(0.0085)


def test_a_plan_without_the_cap_is_stopped_before_the_tube_moves() -> None:
    given = with_timed(capped(), "lift", attached=handoffs().timed.goals[5].attached)
    code, goal_id, message = stopped(given)
    assert (code, goal_id) == ("XEI0911", "lift")
    assert f"without `{CAP}`, which rides on `{TUBE}`" in message


def test_a_cap_that_rides_on_nothing_is_in_no_hand() -> None:
    given = capped()
    loose = tuple(replace(item, fastened_to="") for item in given.world.objects)
    code, _, message = stopped(replace(given, world=replace(given.world, objects=loose)))
    assert code == "XEI0911"
    assert f"`{CAP}`" in message


def test_a_cap_counts_towards_what_a_hand_may_carry() -> None:
    allowed_kg = handoffs().profile.calibration.payload_kg
    code, goal_id, message = stopped(capped(mass_kg=allowed_kg))
    assert (code, goal_id) == ("XEI0923", "take")
    assert f"`{TUBE}` with `{CAP}` weighs" in message


def test_a_cap_that_is_taken_rides_no_more_until_it_is_screwed_on() -> None:
    given = capped()
    state = initial_state(given)
    assert dict(state.riding) == {CAP: TUBE}
    take = next(goal for goal in given.graph.goals if isinstance(goal.action, Attach))
    leave = next(goal for goal in given.graph.goals if isinstance(goal.action, Detach))
    timed = {goal.id: goal for goal in given.timed.goals}
    screwed = replace(take, action=Attach(CAP, "right", "f"))
    off = after(state, screwed, timed[take.id])
    assert (dict(off.riding), off.carried()) == ({}, {CAP: CAP})
    on = Detach(CAP, "right", 'tube_1.spot("mouth")', Pose(), TUBE)
    assert dict(after(off, replace(leave, action=on), timed[leave.id]).riding) == {CAP: TUBE}
    elsewhere = Detach(CAP, "right", 'table.spot("cap")', Pose())
    assert dict(after(off, replace(leave, action=elsewhere), timed[leave.id]).riding) == {}


def test_what_rides_on_a_rider_is_carried_too() -> None:
    state = RunState({}, {"left": "bottle"}, riding={"cap": "bottle", "ring": "cap", "lid": "jar"})
    assert state.carried() == {"bottle": "bottle", "cap": "bottle", "ring": "bottle"}
