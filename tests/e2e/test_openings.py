"""What goes into a vessel or a slot meets neither wall nor bottom; where a fault makes it, the verifier says
so.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import pytest

from tests.e2e.made import PROTOCOLS, compiled
from tests.motion.sequence.bench import DESCRIPTION, bench, goals, obj, plan, slot
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.motion.plan import plan_motion
from xei_lang.motion.verify import Finding, RobotDescription, to_diagnostics, verify_timed
from xei_lang.pipeline import Handoffs
from xei_lang.profiles.open import robot_texts

SIDEWAYS = Pose((0.0, 0.005, 0.0))
TUBE_TOP = Pose((0.0, 0.0, 0.118))
TILTED = TUBE_TOP @ Pose.from_rpy((0.0, 0.0, 0.0), (math.radians(20.0), 0.0, 0.0)) @ TUBE_TOP.inverse()
ROBOT = RobotDescription(DESCRIPTION.urdf_text, DESCRIPTION.srdf_text)


@lru_cache
def pipetted() -> Handoffs:
    _, outcome = compiled(next(path for path in PROTOCOLS if path.stem == "pipette_sample"))
    assert outcome.stopped_at is None, outcome.diagnostics
    return outcome.made


def moved(world: World, name: str, T_object_new: Pose) -> World:
    """The world with an object moved against where the plan has it."""
    changed = (
        replace(item, T_frame_object=item.T_frame_object @ T_object_new) if item.name == name else item
        for item in world.objects
    )
    return replace(world, objects=tuple(changed))


def in_pipetting(vessel: str, shift: Pose) -> list[Finding]:
    made = pipetted()
    assert made.profile and made.timed and made.graph and made.world
    robot = RobotDescription(*robot_texts(made.profile))
    world = moved(made.world, vessel, shift)
    report = verify_timed(made.timed, made.graph, world, robot, made.profile.calibration.limits)
    return [item for item in report.findings if item.kind == "opening"]


@pytest.mark.parametrize(
    ("vessel", "shift", "words"),
    [
        ("tube_4", SIDEWAYS, "`pipette_1` meets the wall of `tube_4`"),
        ("tube_4", TILTED, "`pipette_1` meets the wall of `tube_4`"),
        ("tube_4", Pose((0.0, 0.0, 0.112)), "`pipette_1` meets the bottom of `tube_4`"),
        ("beaker_3", Pose((0.0, 0.035, 0.0)), "`pipette_1` meets the wall of `beaker_3`"),
        ("beaker_3", Pose((0.0, 0.0, 0.05)), "`pipette_1` meets the bottom of `beaker_3`"),
        ("tip_box_1", Pose((0.0045, 0.0, 0.0)), "`pipette_1` meets the wall of `tip_box_1`"),
    ],
)
def test_a_vessel_that_is_not_where_the_tip_goes_is_found(vessel: str, shift: Pose, words: str) -> None:
    found = in_pipetting(vessel, shift)
    assert found
    assert found[0].message.startswith(words)
    assert "mm under its mouth" in found[0].message
    made = pipetted()
    assert made.timed is not None
    goal = next(item for item in made.timed.goals if item.id == found[0].goal_id)
    assert goal.start_s <= found[0].time_s <= goal.end_s
    assert found[0].value > found[0].limit - 1e-4


def test_the_plan_as_it_is_keeps_clear() -> None:
    assert in_pipetting("tube_4", Pose()) == []


INSERT = plan(
    ("pick", {"object": obj("tube_1"), "arm": "right"}),
    ("insert", {"object": obj("tube_1"), "into": slot("rack_1", "B2"), "arm": "right"}),
)


def into(graph: MotionGoalGraph, shift: Pose) -> MotionGoalGraph:
    """The goals of the insertion, their aim moved in the tube's own frame."""

    def aimed(goal: MotionGoal) -> MotionGoal:
        move = goal.action
        if goal.step_id != "insert#1" or not isinstance(move, MoveTo):
            return goal
        if not isinstance(move.target, ToolTarget):
            return goal
        there = replace(move.target, T_base_reference=move.target.T_base_reference @ shift)
        return replace(goal, action=replace(move, target=there))

    return replace(graph, goals=tuple(aimed(goal) for goal in graph.goals))


def inserted(shift: Pose) -> tuple[TimedPlan, MotionGoalGraph]:
    profile, world = bench()
    graph = into(goals(INSERT, profile, world), shift)
    timed, problems = plan_motion(graph, world, profile, DESCRIPTION, 1)
    assert timed is not None, problems
    return timed, graph


@pytest.mark.parametrize(
    ("shift", "words"),
    [
        (SIDEWAYS, "`tube_1` meets the wall of `rack_1`"),
        (
            Pose.from_rpy((0.0, 0.0, 0.0), (0.0, math.radians(4.0), 0.0)),
            "`tube_1` meets the wall of `rack_1`",
        ),
        (Pose((0.0, 0.0, -0.002)), "`tube_1` meets the bottom of `rack_1`"),
    ],
)
def test_a_tube_that_is_aimed_beside_its_bore_or_too_deep_is_found(shift: Pose, words: str) -> None:
    profile, world = bench()
    timed, graph = inserted(shift)
    report = verify_timed(timed, graph, world, ROBOT, profile.calibration.limits)
    found = [item for item in report.findings if item.kind == "opening"]
    assert found
    assert found[0].message.startswith(words)
    assert found[0].step_id == "insert#1"
    said = next(item for item in to_diagnostics(report, graph) if item.code == "XEI0870")
    assert said.span == INSERT.steps[1].span


def test_a_tube_that_goes_where_it_should_is_not() -> None:
    profile, world = bench()
    timed, graph = inserted(Pose())
    assert verify_timed(timed, graph, world, ROBOT, profile.calibration.limits).findings == ()


def test_a_tube_that_stood_a_little_off_its_slot_from_the_start_may_be_lifted() -> None:
    profile, world = bench()
    timed, graph = inserted(Pose())
    off = moved(world, "rack_1", Pose((0.0007, 0.0, 0.0)))
    report = verify_timed(timed, graph, off, ROBOT, profile.calibration.limits)
    found = [item for item in report.findings if item.kind == "opening"]
    assert {item.step_id for item in found} == {"insert#1"}
