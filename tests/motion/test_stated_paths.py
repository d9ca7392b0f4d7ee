"""Arcs, screws and rasters planned on the bench: where the tool goes is measured with pinocchio's kinematics,
and the verifier, which shares no code with the planner, agrees.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.motion.sequence.bench import SRDF, URDF
from tests.motion.stated_paths import Planned, checked, pour, screw, wipe
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import MoveTo
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.motion.paths.tool_path import Array
from xei_lang.motion.robot import load_robot

ROBOT = load_robot(URDF, SRDF)


def tools(made: Planned, goal: TimedGoal) -> Array:
    """`T_base_tool` (m, 4, 4) at the samples of a goal."""
    assert goal.samples is not None
    assert goal.arm is not None
    q = np.zeros(ROBOT.nq)
    for item in made.timed.start:
        q[ROBOT.joint_names.index(item[0])] = item[1]
    for item in made.timed.goals[: made.timed.goals.index(goal)]:
        for joint, value in zip(item.joints, item.samples.positions[-1] if item.samples else (), strict=True):
            q[ROBOT.joint_names.index(joint)] = value
    rows: list[Array] = []
    for row in goal.samples.positions:
        q[[ROBOT.joint_names.index(joint) for joint in goal.joints]] = row
        rows.append(ROBOT.T_base_frame(q, ROBOT.arm(goal.arm).tool_frame))
    return np.stack(rows)


def stated(made: Planned, path: str) -> tuple[MoveTo, TimedGoal, Array]:
    goal, timed = made.stated(path)
    assert isinstance(goal.action, MoveTo)
    return goal.action, timed, tools(made, timed)


@pytest.mark.parametrize("made", [pour, wipe, lambda: screw(180.0)])
def test_the_verifier_accepts_what_was_planned(made) -> None:
    report = checked(made().graph, made().timed)
    assert report.ok, report.findings[:3]
    margins = {margin.name: margin.value for margin in report.margins}
    assert margins["tool_path"] < 1.0
    assert margins["tool_path_turn"] < 1.0


def test_a_pour_keeps_the_vessels_lip_where_it_is() -> None:
    move, _, tool = stated(pour(), "arc")
    assert isinstance(move.along, Turn)
    lip = np.array([*move.along.point_m, 1.0])
    in_tool = np.linalg.inv(tool[0]) @ lip
    assert np.linalg.norm((tool @ in_tool - lip)[:, :3], axis=1).max() < 0.5e-3
    turned = math.acos((np.trace(tool[0, :3, :3].T @ tool[-1, :3, :3]) - 1.0) / 2.0)
    assert turned == pytest.approx(abs(move.along.angle_rad), abs=1e-4)


def test_a_screw_turns_farther_than_one_wrist_joint_and_climbs_by_its_lead() -> None:
    move, timed, tool = stated(screw(180.0), "screw")
    assert isinstance(move.along, Turn)
    axis = np.array(move.along.direction)
    from_start = tool[:, :3, :3] @ tool[0, :3, :3].T
    sine = (from_start[:, 1, 0] - from_start[:, 0, 1]) / 2.0
    cosine = (from_start[:, 0, 0] + from_start[:, 1, 1]) / 2.0
    angle = np.unwrap(np.arctan2(sine, cosine))
    assert angle[-1] == pytest.approx(math.pi, abs=1e-4)
    climbed = (tool[:, :3, 3] - tool[0, :3, 3]) @ axis
    assert np.allclose(climbed, 0.003 * angle / math.tau, atol=2e-4)
    assert timed.samples is not None
    moved = dict(zip(timed.joints, np.ptp(np.array(timed.samples.positions), axis=0), strict=True))
    assert max(moved.values()) < math.pi, "the joints share the turn"
    assert sum(value > 0.3 for value in moved.values()) >= 3


def test_a_raster_covers_its_area_with_the_tool_upright() -> None:
    move, _, tool = stated(wipe(), "raster")
    assert isinstance(move.along, Raster)
    assert isinstance(move.target, ToolTarget)
    moved = tool[:, :3, 3] - tool[0, :3, 3]
    length, width = math.hypot(*move.along.along_m), math.hypot(*move.along.across_m)
    x, y = moved @ np.array(move.along.along_m) / length, moved @ np.array(move.along.across_m) / width
    grid = np.stack(np.meshgrid(np.linspace(0, length, 30), np.linspace(0, width, 30)), axis=-1)
    gaps = np.linalg.norm(grid.reshape(-1, 1, 2) - np.stack([x, y], axis=1)[None], axis=2).min(axis=1)
    assert gaps.max() < move.along.pitch_m
    assert np.abs(moved[:, 2]).max() < 0.5e-3
    assert np.abs(tool[:, :3, :3] - tool[0, :3, :3]).max() < 2e-3


@pytest.mark.parametrize(("made", "path"), [(pour, "arc"), (wipe, "raster")])
def test_the_tool_is_as_fast_as_it_may_be_and_no_faster(made, path: str) -> None:
    move, timed, tool = stated(made(), path)
    assert timed.samples is not None
    steps = np.diff(timed.samples.times_s)
    if move.tool_speed_m_s is not None:
        speed, bound = np.linalg.norm(np.diff(tool[:, :3, 3], axis=0), axis=1) / steps, move.tool_speed_m_s
    else:
        assert move.tool_turn_rad_s is not None
        trace = np.einsum("nij,nij->n", tool[:-1, :3, :3], tool[1:, :3, :3])
        speed, bound = np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0)) / steps, move.tool_turn_rad_s
    assert speed.max() <= 1.005 * bound
    assert speed.max() > 0.9 * bound
