from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tests.runtime.small import SPAN, handoffs, samples_of, with_goal, with_timed
from xei_lang.ir.forms import trace_json
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Grip, MotionGoal, MoveTo, SetDo, SlideMove
from xei_lang.ir.skill_plan import UnmappedRequest
from xei_lang.ir.timed import Samples, TimedGoal
from xei_lang.ir.trace import RuntimeFeedback, TraceEvent
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.executors import Executor
from xei_lang.runtime.executors.dry_run import KINDS, DryRun
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.record import verify_chain
from xei_lang.runtime.run import RunResult, run
from xei_lang.runtime.state import initial_state

YES = Answers({"confirm#1": True})


def trace(
    given: Handoffs, executor: str | Executor = "dry-run", answers: Answers = YES, speed: float = 1.0
) -> tuple[RunResult, list[TraceEvent]]:
    events: list[TraceEvent] = []
    return run(given, executor, answers, events.append, speed), events


def lines(events: list[TraceEvent]) -> list[str]:
    return [trace_json.to_line(event) for event in events]


def test_a_sound_plan_runs_to_its_end_with_every_stage_in_the_trace() -> None:
    result, events = trace(handoffs())
    assert result == RunResult("succeeded", duration_s=18.0, goals_done=17)
    assert [event.stage for event in events[:3]] == ["scene_setup", "world_state", "planning"]
    for goal in handoffs().graph.goals:
        stages = [event.stage for event in events if event.goal_id == goal.id]
        assert stages == ["precheck", "execution", "feedback"], goal.id
    assert events[-1].stage == "end"
    assert [event.t for event in events] == sorted(event.t for event in events)
    assert verify_chain(lines(events)) == ()


def test_the_trace_is_the_golden_one(golden: Callable[[str, str], None]) -> None:
    text = "".join(f"{line}\n" for line in lines(trace(handoffs())[1]))
    golden("runtime/small_trace.jsonl", text)


def test_two_runs_write_the_same_bytes() -> None:
    assert lines(trace(handoffs())[1]) == lines(trace(handoffs())[1])


def test_every_line_follows_the_schema() -> None:
    path = Path(trace_json.__file__).with_name("trace.schema.json")
    validator = jsonschema.Draft202012Validator(json.loads(path.read_text()))
    good, bad = trace(handoffs())[1], trace(handoffs(), "ros2")[1]
    for line in lines(good) + lines(bad):
        validator.validate(json.loads(line))
    assert not validator.is_valid({**json.loads(lines(good)[0]), "status": "failed"})


def test_scene_setup_names_the_frames_and_bounds() -> None:
    scene = trace(handoffs())[1][0].representation
    assert scene["map_frame"] == "map"
    assert scene["table_frame"]["name"] == "table"
    assert [(one["name"], one["frame"]["parent"]) for one in scene["cameras"]] == [("head", "slide")]
    assert scene["workspace_bounds_m"] == {
        "frame": "robot_base",
        "lower": [0.2, -0.85, 0.0],
        "upper": [1.1, 0.85, 2.1],
    }


def test_half_speed_takes_twice_the_time() -> None:
    result, events = trace(handoffs(), speed=0.5)
    assert result.duration_s == 36.0
    assert next(event.t for event in events if event.goal_id == "lift") == 7.0


def test_a_goal_that_runs_on_is_fed_back_after_one_that_started_later() -> None:
    _, events = trace(handoffs())
    order = [(event.goal_id, event.stage) for event in events]
    assert order.index(("approach", "precheck")) < order.index(("aside", "feedback"))


def shifted(samples: Samples, by: float) -> Samples:
    return replace(samples, positions=tuple((row[0] + by,) for row in samples.positions))


def faster(samples: Samples, by: float) -> Samples:
    return replace(samples, velocities=tuple((row[0] * by,) for row in samples.velocities))


def broken_in_the_middle(samples: Samples) -> Samples:
    rows = list(samples.positions)
    rows[50] = (rows[50][0] + 0.02,)
    return replace(samples, positions=tuple(rows))


def at_station(given: Handoffs, station: str) -> Handoffs:
    return replace(given, world=replace(given.world, robot=replace(given.world.robot, station=station)))


def base_off(given: Handoffs) -> Handoffs:
    robot = replace(given.world.robot, T_world_base=Pose((0.3, 0.0, 0.0)))
    return replace(given, world=replace(given.world, robot=robot))


def tube(given: Handoffs, **changes: Any) -> Handoffs:
    objects = tuple(replace(item, **changes) for item in given.world.objects)
    return replace(given, world=replace(given.world, objects=objects))


def calibrated(given: Handoffs, **changes: Any) -> Handoffs:
    calibration = replace(given.profile.calibration, **changes)
    return replace(given, profile=replace(given.profile, calibration=calibration))


def without_skill(given: Handoffs, name: str) -> Handoffs:
    bank = given.profile.bank
    bank = replace(bank, skills=tuple(item for item in bank.skills if item.name != name))
    return replace(given, profile=replace(given.profile, bank=bank))


def without_timed(given: Handoffs, goal_id: str) -> Handoffs:
    goals = tuple(goal for goal in given.timed.goals if goal.id != goal_id)
    return replace(given, timed=replace(given.timed, goals=goals))


def left_joint(given: Handoffs, value: float) -> Handoffs:
    joints = tuple(
        (name, value if name == "openarm_left_joint4" else at) for name, at in given.world.robot.joints
    )
    return replace(given, world=replace(given.world, robot=replace(given.world.robot, joints=joints)))


def retimed(given: Handoffs, goal_id: str, change: Callable[[Samples], Samples]) -> Handoffs:
    return with_timed(given, goal_id, samples=change(samples_of(given, goal_id)))


def slow_motion(given: Handoffs) -> Handoffs:
    action = next(goal.action for goal in given.graph.goals if goal.id == "lift")
    assert isinstance(action, MoveTo)
    return with_goal(given, "lift", action=replace(action, speed_fraction=0.1))


def without_perception(given: Handoffs) -> Handoffs:
    goals = tuple(goal for goal in given.graph.goals if goal.id != "look")
    edges = tuple(edge for edge in given.graph.edges if "look" not in edge)
    return without_timed(replace(given, graph=replace(given.graph, goals=goals, edges=edges)), "look")


def narrow(given: Handoffs) -> Handoffs:
    return calibrated(given, workspace_bounds_m=((0.2, -0.85, 0.0), (1.1, 0.85, 1.05)))


FAULTS: list[tuple[str, Callable[[Handoffs], Handoffs], str, str, str]] = [
    ("an unknown station", lambda g: at_station(g, "bench_c"), "scene_origin", "XEI0901", ""),
    ("another station than the plan's", lambda g: at_station(g, "bench_b"), "scene_origin", "XEI0901", ""),
    ("a base that is off", base_off, "scene_origin", "XEI0901", ""),
    ("a missing object", lambda g: tube(g, name="tube_9"), "world_grounding", "XEI0902", ""),
    ("an unsure object", lambda g: tube(g, confidence=0.3), "world_grounding", "XEI0903", ""),
    ("an unknown frame", lambda g: tube(g, frame_id="shelf"), "world_grounding", "XEI0902", ""),
    ("a goal without a time", lambda g: without_timed(g, "rest"), "planner_validation", "XEI0904", ""),
    (
        "a goal too early",
        lambda g: with_timed(g, "take", start_s=3.0, end_s=3.0),
        "planner_validation",
        "XEI0904",
        "",
    ),
    (
        "a hand used twice",
        lambda g: with_timed(g, "aside", resources=("left_arm",)),
        "planner_validation",
        "XEI0904",
        "",
    ),
    (
        "a goal of another kind",
        lambda g: with_timed(g, "rest", kind="confirm"),
        "planner_validation",
        "XEI0904",
        "",
    ),
    (
        "a goal too short",
        lambda g: with_goal(g, "rest", min_duration_s=2.0),
        "planner_validation",
        "XEI0904",
        "",
    ),
    ("an unknown skill", lambda g: without_skill(g, "place"), "skill_coverage", "XEI0905", ""),
    (
        "a gap too wide",
        lambda g: with_goal(g, "open", action=Grip("left", 0.1)),
        "operation_parameters",
        "XEI0907",
        "",
    ),
    (
        "a height too high",
        lambda g: with_goal(g, "raise", action=SlideMove(0.7)),
        "operation_parameters",
        "XEI0907",
        "",
    ),
    (
        "no grasps",
        lambda g: replace(g, graph=replace(g.graph, families=())),
        "operation_parameters",
        "XEI0907",
        "",
    ),
    ("a start elsewhere", lambda g: left_joint(g, 1.3), "runtime_precheck", "XEI0910", "approach"),
    ("a start outside the limits", lambda g: left_joint(g, 2.6), "runtime_precheck", "XEI0910", "approach"),
    (
        "a gap in the plan",
        lambda g: retimed(g, "lower", lambda s: shifted(s, 0.01)),
        "runtime_precheck",
        "XEI0910",
        "lower",
    ),
    (
        "the wrong epoch",
        lambda g: with_timed(with_goal(g, "sink", epoch=0), "sink", epoch=0),
        "runtime_precheck",
        "XEI0910",
        "sink",
    ),
    (
        "open jaws",
        lambda g: with_timed(with_goal(g, "close", kind="open_gripper"), "close", kind="open_gripper"),
        "runtime_precheck",
        "XEI0911",
        "take",
    ),
    (
        "an object nobody holds",
        lambda g: with_timed(g, "approach", attached=g.timed.goals[5].attached),
        "runtime_precheck",
        "XEI0911",
        "approach",
    ),
    ("a load forgotten", lambda g: with_timed(g, "lift", attached=()), "runtime_precheck", "XEI0911", "lift"),
    ("a drive without a look", without_perception, "runtime_precheck", "XEI0912", "sink"),
    (
        "an unknown output",
        lambda g: with_goal(g, "light", action=SetDo("siren", True)),
        "runtime_precheck",
        "XEI0915",
        "light",
    ),
    (
        "a joint out of limits",
        lambda g: calibrated(
            g,
            limits=tuple(
                replace(limit, upper=1.9) if limit.joint == "openarm_left_joint4" else limit
                for limit in g.profile.calibration.limits
            ),
        ),
        "safety_validation",
        "XEI0920",
        "lift",
    ),
    (
        "a joint without limits",
        lambda g: calibrated(g, limits=g.profile.calibration.limits[1:]),
        "safety_validation",
        "XEI0920",
        "raise",
    ),
    (
        "a joint too fast",
        lambda g: retimed(g, "lift", lambda s: faster(s, 6.0)),
        "safety_validation",
        "XEI0921",
        "lift",
    ),
    ("a goal faster than asked", slow_motion, "safety_validation", "XEI0921", "lift"),
    ("a tool outside", narrow, "safety_validation", "XEI0922", "raise"),
    ("a heavy load", lambda g: tube(g, mass_kg=1.2), "safety_validation", "XEI0923", "take"),
    ("a jump", lambda g: retimed(g, "lift", broken_in_the_middle), "hardware_execution", "XEI0940", "lift"),
]


@pytest.mark.parametrize(
    ("what", "corrupt", "stage", "code", "goal_id"), FAULTS, ids=[row[0] for row in FAULTS]
)
def test_a_fault_is_named_by_its_handoff(
    what: str, corrupt: Callable[[Handoffs], Handoffs], stage: str, code: str, goal_id: str
) -> None:
    result, events = trace(corrupt(handoffs()))
    assert (result.status, result.failed_stage, result.goal_id) == ("failed", stage, goal_id), result
    assert [item.code for item in result.diagnostics] == [code]
    last = json.loads(lines(events)[-1])
    assert (last["status"], last["failed_stage"], last["goal_id"]) == ("failed", stage, goal_id)
    assert verify_chain(lines(events)) == ()


def test_nothing_starts_after_a_failure() -> None:
    _, events = trace(slow_motion(handoffs()))
    assert [event.stage for event in events if event.goal_id == "lift"] == ["precheck", "execution", "end"]
    assert not [event for event in events if event.goal_id == "raise"]


def test_a_failure_gives_up_what_is_still_running() -> None:
    given = left_joint(handoffs(), 1.3)
    _, events = trace(given)
    said = [
        event.representation["status"]
        for event in events
        if (event.goal_id, event.stage) == ("aside", "feedback")
    ]
    assert said == ["cancelled"]


@pytest.mark.parametrize(
    ("name", "code"), [("simulate", "XEI0930"), ("ros2", "XEI0930"), ("dry_run", "XEI0932")]
)
def test_an_executor_that_is_not_there_is_a_routing_failure(name: str, code: str) -> None:
    result, _ = trace(handoffs(), name)
    assert (result.failed_stage, result.diagnostics[0].code) == ("executor_routing", code)


def test_a_goal_that_the_executor_cannot_do_is_a_routing_failure() -> None:
    executor = DryRun.starting_at(initial_state(handoffs()))
    executor.kinds = tuple(kind for kind in KINDS if kind != "slide_move")
    result, _ = trace(handoffs(), executor)
    assert (result.failed_stage, result.diagnostics[0].code) == ("executor_routing", "XEI0931")


@pytest.mark.parametrize("speed", [0.0, -1.0, 1.5])
def test_a_run_is_never_faster_than_its_plan(speed: float) -> None:
    result, _ = trace(handoffs(), speed=speed)
    assert (result.failed_stage, result.diagnostics[0].code) == ("safety_validation", "XEI0921")


@dataclass
class Rig:
    """A robot that is real as far as a run can tell, and that fails or is interrupted at a goal."""

    fails: str = ""
    interrupts: str = ""
    stopped: bool = False
    name: str = "rig"
    virtual: bool = False
    kinds: Any = KINDS

    def execute(self, goal: MotionGoal, timed: TimedGoal) -> RuntimeFeedback:
        if goal.id == self.interrupts:
            raise KeyboardInterrupt
        failed = goal.id == self.fails
        return RuntimeFeedback(
            goal.id, "failed" if failed else "succeeded", "motor 4 is too hot" if failed else ""
        )

    def cancel(self, goal_id: str) -> RuntimeFeedback:
        return RuntimeFeedback(goal_id, "cancelled")

    def stop(self) -> None:
        self.stopped = True


def test_a_robot_that_fails_is_a_hardware_failure() -> None:
    rig = Rig(fails="raise")
    result, events = trace(handoffs(), rig)
    assert (result.failed_stage, result.goal_id, rig.stopped) == ("hardware_execution", "raise", True)
    assert "motor 4 is too hot" in result.diagnostics[0].message
    assert [event.stage for event in events[-2:]] == ["feedback", "end"]


def test_an_interrupt_stops_the_robot_and_closes_the_trace() -> None:
    rig, events = Rig(interrupts="approach"), list[TraceEvent]()
    with pytest.raises(KeyboardInterrupt):
        run(handoffs(), rig, YES, events.append)
    assert rig.stopped
    assert events[-1].representation["status"] == "cancelled"
    assert ("aside", "feedback") in [(event.goal_id, event.stage) for event in events]
    assert verify_chain(lines(events)) == ()


def test_a_request_without_a_skill_passes_the_dry_run_only() -> None:
    request = UnmappedRequest("centrifuge the tube", "no skill of the bank spins", None, SPAN)
    given = replace(handoffs(), plan=replace(handoffs().plan, unmapped_requests=(request,)))
    assert trace(given)[0].status == "succeeded"
    result, _ = trace(given, Rig())
    assert (result.failed_stage, result.diagnostics[0].code) == ("skill_coverage", "XEI0906")


def test_a_question_without_an_answer_stops_the_run() -> None:
    result, events = trace(handoffs(), answers=Answers())
    assert (result.status, result.failed_stage, result.goal_id) == ("failed", "runtime_precheck", "ask")
    assert result.diagnostics[0].code == "XEI0913"
    assert not [event for event in events if event.goal_id == "drive"]


def test_a_no_cancels_and_blames_nobody() -> None:
    result, events = trace(handoffs(), answers=Answers({"is the bench clear?": False}))
    assert (result.status, result.failed_stage, result.diagnostics[0].code) == ("cancelled", None, "XEI0914")
    assert "failed_stage" not in json.loads(lines(events)[-1])


def test_the_terminal_is_asked_only_where_nothing_is_written() -> None:
    asked: list[str] = []

    def ask(text: str) -> bool:
        asked.append(text)
        return True

    assert trace(handoffs(), answers=Answers({"confirm#1": True}, ask))[0].status == "succeeded"
    assert asked == []
    assert trace(handoffs(), answers=Answers({}, ask))[0].status == "succeeded"
    assert asked == ["is the bench clear?"]
