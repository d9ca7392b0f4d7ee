"""The tool's paths in closed form: lines are straight, arcs keep their axis, screws climb, rasters cover."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.motion.paths.tool_path import Array, StraightPath, SweepingPath, TurningPath, displacements

angles = st.floats(-math.pi, math.pi)
lengths = st.floats(-0.5, 0.5)


@st.composite
def turns(draw: st.DrawFn, lead: st.SearchStrategy[float]) -> Turn:
    axis = Pose.from_rpy((0.0, 0.0, 0.0), (draw(angles), draw(angles), 0.0)).axes()[2]
    angle = draw(st.floats(0.05, 12.0)) * draw(st.sampled_from([1.0, -1.0]))
    return Turn((draw(lengths), draw(lengths), draw(lengths)), axis, angle, draw(lead))


@st.composite
def rasters(draw: st.DrawFn) -> Raster:
    x, y, _ = Pose.from_rpy((0.0, 0.0, 0.0), (draw(angles), draw(angles), draw(angles))).axes()
    pitch = draw(st.floats(0.01, 0.06))
    length, width = draw(st.floats(0.07, 0.3)), draw(st.just(0.0) | st.floats(0.005, 0.3))
    along, across = scaled(x, length), scaled(y, width)
    return Raster((draw(lengths), draw(lengths), draw(lengths)), along, across, pitch)


def scaled(vector: Vec3, length: float) -> Vec3:
    return (vector[0] * length, vector[1] * length, vector[2] * length)


def matrix(pose: Pose) -> Array:
    return np.array(pose.matrix())


@given(angles, angles, angles)
def test_lines_run_straight_from_end_to_end(roll: float, pitch: float, yaw: float) -> None:
    start, end = Pose((0.1, 0.2, 0.3)), Pose.from_rpy((0.4, 0.2, 0.1), (roll, pitch, yaw))
    path = StraightPath(matrix(start), matrix(end))
    line = path.poses(path.shares(0.01, 0.07))
    assert np.allclose(line[0], matrix(start))
    assert np.allclose(line[-1], matrix(end), atol=1e-12)
    steps = np.diff(line[:, :3, 3], axis=0)
    assert np.linalg.norm(steps, axis=1).max() <= 0.01 + 1e-12
    assert np.allclose(steps, steps[0])
    turned = [float(np.trace(a[:3, :3].T @ b[:3, :3])) for a, b in pairwise(line)]
    assert np.ptp(turned) < 1e-6


@given(turns(st.just(0.0)), lengths, lengths)
def test_an_arc_keeps_its_axis_where_it_is_and_turns_the_rest_about_it(
    turn: Turn, x: float, along: float
) -> None:
    moved = displacements(turn, np.linspace(0.0, 1.0, 23))
    axis, lip = np.array(turn.direction), np.array(turn.point_m)
    on_axis = lip + along * axis
    assert np.abs(moved[:, :3, :3] @ on_axis + moved[:, :3, 3] - on_axis).max() < 1e-12
    point = lip + np.array([x, 0.1, -0.2])
    where = moved[:, :3, :3] @ point + moved[:, :3, 3]
    assert np.ptp(np.linalg.norm(where - lip, axis=1)) < 1e-12
    assert np.ptp((where - lip) @ axis) < 1e-12


@given(turns(st.floats(-0.02, 0.02)))
def test_a_screw_climbs_by_its_lead_for_every_turn(turn: Turn) -> None:
    share = np.linspace(0.0, 1.0, 40)
    moved = displacements(turn, share)
    axis, point = np.array(turn.direction), np.array(turn.point_m)
    climbed = (moved[:, :3, :3] @ point + moved[:, :3, 3] - point) @ axis
    assert np.allclose(climbed, turn.lead_m * share * turn.angle_rad / math.tau, atol=1e-12)
    across = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.9 else [0.0, 1.0, 0.0])
    across /= np.linalg.norm(across)
    now = moved[:, :3, :3] @ across
    angle = np.unwrap(np.arctan2(np.cross(across, now) @ axis, now @ across))
    assert np.allclose(angle, share * turn.angle_rad, atol=1e-9)


@given(turns(st.floats(-0.02, 0.02)), rasters(), angles)
def test_the_stated_end_is_where_the_path_ends(turn: Turn, raster: Raster, yaw: float) -> None:
    T_start = Pose.from_rpy((0.3, -0.2, 0.9), (0.1, yaw, -0.4))
    for path, stated in (
        (TurningPath(matrix(T_start), turn), turn),
        (SweepingPath(matrix(T_start), raster), raster),
    ):
        ends = path.poses(np.array([0.0, 1.0]))
        assert np.allclose(ends[0], matrix(T_start), atol=1e-12)
        assert np.allclose(ends[1], matrix(stated.end() @ T_start), atol=1e-9)


@given(rasters())
def test_a_raster_stays_in_its_rectangle_and_leaves_no_point_farther_than_its_pitch(raster: Raster) -> None:
    path = SweepingPath(np.eye(4), raster)
    points = path.poses(np.linspace(0.0, 1.0, 3000))[:, :3, 3]
    length, width = math.hypot(*raster.along_m), math.hypot(*raster.across_m)
    x = points @ np.array(raster.along_m) / length
    y = points @ np.array(raster.across_m) / max(width, 1e-12)
    assert x.min() > -1e-9
    assert x.max() < length + 1e-9
    assert y.min() > -1e-9
    assert y.max() < width + 1e-9
    assert raster.lane_distance_m <= raster.pitch_m + 1e-9
    grid = np.stack(np.meshgrid(np.linspace(0, length, 15), np.linspace(0, width, 15)), axis=-1)
    gaps = np.linalg.norm(grid.reshape(-1, 1, 2) - np.stack([x, y], axis=1)[None], axis=2).min(axis=1)
    assert gaps.max() <= 0.71 * raster.lane_distance_m + 0.003


@given(rasters())
def test_a_raster_is_one_smooth_line(raster: Raster) -> None:
    path = SweepingPath(np.eye(4), raster)
    points = path.poses(np.linspace(0.0, 1.0, 4001))[:, :3, 3]
    steps = np.diff(points, axis=0)
    assert np.ptp(np.linalg.norm(steps, axis=1)) < 0.01 * np.linalg.norm(steps, axis=1).max()
    sharpest = min(1.0, 2.5 * float(np.linalg.norm(steps[0])) / max(raster.lane_distance_m / 2, 1e-3))
    turned = np.einsum("ni,ni->n", steps[1:], steps[:-1]) / np.linalg.norm(steps[0]) ** 2
    assert turned.min() > math.cos(sharpest) - 1e-6


@given(turns(st.floats(-0.02, 0.02)), rasters())
def test_samples_are_as_close_as_asked(turn: Turn, raster: Raster) -> None:
    T_start = matrix(Pose((0.3, 0.2, 0.8)))
    for path in (TurningPath(T_start, turn), SweepingPath(T_start, raster)):
        share = path.shares(0.01, 0.07)
        assert share[0] == 0.0
        assert share[-1] == 1.0
        assert np.all(np.diff(share) > 0.0)
        poses = path.poses(share)
        assert np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1).max() <= 0.0125
        turned = np.trace(poses[:-1, :3, :3].transpose(0, 2, 1) @ poses[1:, :3, :3], axis1=1, axis2=2)
        assert np.arccos(np.clip((turned - 1.0) / 2.0, -1.0, 1.0)).max() <= 0.07 + 1e-6
