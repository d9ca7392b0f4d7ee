"""Single sides of the verifier: its evaluator, its kinematics, its bounds, what it forgives, and what it
says."""

from __future__ import annotations

from dataclasses import replace
from random import Random

import coal
import numpy as np
import pinocchio as pin
import pytest

from tests.motion.verify import maker
from tests.motion.verify.fault_bench import Bench
from tests.motion.verify.fault_paths import bump, resampled
from tests.motion.verify.faults_motion import velocity_limit
from tests.motion.verify.faults_touch import object_in_path
from tests.motion.verify.scene import arm_of, limits, pick_and_place, robot, tour
from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolPose, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import TimedPlan
from xei_lang.motion.verify import VerifyOptions, to_diagnostics, verify_timed
from xei_lang.motion.verify.bodies import Bodies
from xei_lang.motion.verify.context import pose_error
from xei_lang.motion.verify.evaluate import Motion, grid
from xei_lang.motion.verify.reach import expected_tools
from xei_lang.motion.verify.robot import Robot
from xei_lang.profiles.model import PlanningLimit

NOWHERE = Span("calibration_profile.yaml", 0, 0)


@pytest.fixture(scope="module")
def model() -> Robot:
    return Robot(robot().urdf_text)


def _random(model: Robot, count: int, seed: int) -> np.ndarray:
    pin_model = model.model
    rng = np.random.default_rng(seed)
    return rng.uniform(pin_model.lowerPositionLimit, pin_model.upperPositionLimit, (count, model.size))


def test_evaluator_agrees_with_a_scalar_reading_and_with_differences() -> None:
    plan = pick_and_place()[0]
    for goal in plan.goals:
        if goal.knots is None:
            continue
        motion = Motion.of(goal.knots)
        times = grid(0.0, motion.duration_s, 97.0)[1:-1]
        q, v, a = motion.at(times)
        for k, t in enumerate(times):
            for mine, other in zip((q, v, a), maker.evaluate(goal.knots, float(t)), strict=True):
                np.testing.assert_allclose(mine[k], other, atol=1e-9)
        h = 1e-6
        np.testing.assert_allclose(
            (motion.at(times + h)[0] - motion.at(times - h)[0]) / (2 * h), v, atol=1e-4
        )


def test_kinematics_agree_with_pinocchio(model: Robot) -> None:
    data, q = model.model.createData(), _random(model, 40, 0)
    frames = model.frames(q, model.links)
    for k, row in enumerate(q):
        pin.framesForwardKinematics(model.model, data, row)
        for link in model.links:
            frame = data.oMf[model.model.getFrameId(link)]
            np.testing.assert_allclose(frames[link][0][k], frame.rotation, atol=1e-12)
            np.testing.assert_allclose(frames[link][1][k], frame.translation, atol=1e-12)


def test_no_point_moves_farther_than_its_lever_allows(model: Robot) -> None:
    before, step = _random(model, 200, 1), np.random.default_rng(2).normal(0.0, 0.1, (200, model.size))
    for link in model.links:
        for offset in np.random.default_rng(3).normal(0.0, 0.1, (3, 3)):
            lever = model.lever(link, float(np.linalg.norm(offset)))
            points = [
                frames[link][0] @ offset + frames[link][1]
                for frames in (model.frames(q, (link,)) for q in (before, before + step))
            ]
            moved = np.linalg.norm(points[1] - points[0], axis=1)
            assert (moved <= np.abs(step) @ lever + 1e-12).all()


def test_bounding_spheres_hold_every_shape(model: Robot) -> None:
    _, _, world, about = pick_and_place()
    bodies = Bodies(model, about, world)
    for body in bodies.bodies.values():
        for index in body.shapes:
            shape = bodies.geometry.geometryObjects[index]
            ball = coal.Sphere(1e-6)
            local = bodies._local[index]
            for direction in np.random.default_rng(4).normal(size=(40, 3)):
                far = body.center + direction / np.linalg.norm(direction) * (body.radius + 1e-4)
                distance = coal.distance(
                    shape.geometry, coal.Transform3s(local.rotation, local.translation),
                    ball, coal.Transform3s(np.eye(3), far), coal.DistanceRequest(), coal.DistanceResult(),
                )  # fmt: skip
                assert distance > 0.0


def test_advancement_finds_what_a_look_at_every_instant_finds() -> None:
    """A thin plate that the hand brushes for a few milliseconds only, wherever along its way it is put."""
    plan, graph, world, about = pick_and_place()
    case = Bench(plan, graph, world, about, arm_of(about.urdf_text), Random(0))
    found = sum(
        any(f.kind == "collision" for f in verify_timed(fault.plan, graph, fault.world, about).findings)
        for fault in (object_in_path(replace(case, random=Random(seed))) for seed in range(20))
        if fault is not None
    )
    assert found == 20


def test_small_errors_are_forgiven() -> None:
    plan, graph, world, about = pick_and_place()
    first = next(goal for goal in plan.goals if goal.kind == "open_gripper")
    assert first.knots is not None
    nudged = resampled(first, bump(first.knots, 0, 1e-6))
    goals = tuple(nudged if goal.id == first.id else goal for goal in plan.goals)
    assert verify_timed(replace(plan, goals=goals), graph, world, about).ok


def _with_limits(**changes: float) -> tuple[PlanningLimit, ...]:
    return tuple(
        PlanningLimit(x.joint, x.lower, x.upper, x.velocity * changes.get("velocity", 1.0), x.acceleration,
                      x.torque, "test", NOWHERE)
        for x in limits()
    )  # fmt: skip


def test_the_profile_has_the_last_word_on_limits() -> None:
    plan, graph, world, about = tour()
    assert verify_timed(plan, graph, world, about, _with_limits()).ok
    kinds = {f.kind for f in verify_timed(plan, graph, world, about, _with_limits(velocity=0.5)).findings}
    assert kinds == {"limits", "velocity"}


def test_a_symmetric_reference_may_be_turned_and_another_may_not() -> None:
    member = ToolPose("side", Pose.from_rpy((0.02, 0.01, 0.05), (0.3, 1.2, -0.4)))
    base = Pose.from_rpy((0.4, -0.2, 0.9), (0.0, 0.0, 0.7))
    offsets = {"offset_base_m": (0.0, 0.0, 0.1), "offset_tool_m": (0.0, 0.0, -0.05)}
    turned = base @ Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, 2.1))
    tool = Pose((0.0, 0.0, 0.1)) @ turned @ member.T_reference_tool @ Pose((0.0, 0.0, -0.05))
    for symmetric, turn, fits in ((True, True, True), (True, False, False), (False, True, False)):
        family = Family("f", "tube", (member,), symmetric)
        target = ToolTarget("f", base, turn_reference=turn, **offsets)
        ((_, pose),) = expected_tools(family, target, tool)
        assert (max(pose_error(pose, tool)) < 1e-9) == fits


def test_a_held_object_that_tilts_is_found_where_a_bound_is_given() -> None:
    plan, graph, world, about = pick_and_place()
    goals = tuple(
        replace(goal, action=replace(goal.action, keep_upright=True)) if goal.kind == "move_to" else goal
        for goal in graph.goals
    )
    upright = replace(graph, goals=goals)
    options = VerifyOptions(upright_tilt_rad=0.02)
    assert verify_timed(plan, upright, world, about, options=options).ok
    carry = next(goal for goal in plan.goals if goal.id == "g07")
    assert carry.knots is not None
    bent = resampled(carry, bump(carry.knots, 5, 0.1))
    case = Bench(plan, upright, world, about, arm_of(about.urdf_text), Random(0))
    kinds = {
        f.kind for f in verify_timed(case.with_goal(bent), upright, world, about, options=options).findings
    }
    assert "tilt" in kinds


def test_findings_become_diagnostics_at_the_step() -> None:
    plan, graph, world, about = pick_and_place()
    case = Bench(plan, graph, world, about, arm_of(about.urdf_text), Random(1))
    fault = velocity_limit(case)
    assert fault is not None
    report = verify_timed(fault.plan, graph, fault.world, about)
    said = next(d for d in to_diagnostics(report, graph) if d.code == "XEI0855")
    finding = next(f for f in report.findings if f.kind == "velocity")
    goal = next(goal for goal in graph.goals if goal.id == finding.goal_id)
    assert said.span == goal.span
    assert finding.subject in said.message
    assert f"{finding.limit:.6g}" in said.label
    assert f"goal `{goal.id}` at" in said.notes[0]


def test_an_empty_plan_lacks_every_goal() -> None:
    plan, graph, world, about = tour()
    empty: TimedPlan = replace(plan, goals=(), duration_s=0.0)
    report = verify_timed(empty, graph, world, about)
    assert [f.kind for f in report.findings] == ["goals"] * len(graph.goals)
