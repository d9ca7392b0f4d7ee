"""Looking at an object: the slide goes where OpenCV's own projection has the whole object in the picture."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, plan
from tests.motion.sequence.bench import moved
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.goals import Perceive, SlideMove
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.lower.look import best_view
from xei_lang.world.frames import T_base_link
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics

PROFILE, WORLD = bench()
CAMERA = PROFILE.calibration.cameras[0]
STRAIGHT = replace(CAMERA, distortion=(0.0,) * 5)
MARGIN = 0.05


def pixels(T_base_object: Pose, size_m: Vec3, height_m: float) -> np.ndarray:
    """Pixels of the corners of the object's box, (8, 2), by OpenCV; none for what is behind the camera."""
    mount = next(frame for frame in PROFILE.calibration.frames if frame.name == CAMERA.frame)
    T_base_slide = T_base_link(PROFILE.robot, "slide_carriage", {"slide_joint": height_m})
    T_optical_base = (T_base_slide @ mount.T_parent_frame @ T_CAMERA_OPTICAL).inverse()
    x, y, z = size_m
    corners = itertools.product((-x / 2, x / 2), (-y / 2, y / 2), (0.0, z))
    points = np.array([T_optical_base.apply(T_base_object.apply(corner)) for corner in corners])
    if points[:, 2].min() <= 0.0:
        return np.full((8, 2), np.nan)
    return Optics.of(STRAIGHT).project(points)[0]


def inside(pixel: np.ndarray, slack_px: float) -> bool:
    """Whether all corners keep the margin to the picture's border, give or take the slack."""
    low = np.array([CAMERA.width, CAMERA.height]) * MARGIN - slack_px
    high = np.array([CAMERA.width - 1, CAMERA.height - 1]) - low
    return bool(np.all(pixel >= low) and np.all(pixel <= high))


@settings(max_examples=60, deadline=None)
@given(
    st.floats(0.3, 1.6), st.floats(-0.9, 0.9), st.floats(0.4, 1.2), st.floats(-3.0, 3.0), st.floats(0.0, 0.6)
)
def test_the_whole_object_is_in_the_picture_from_there_and_from_nowhere_nearer(
    x: float, y: float, z: float, yaw: float, near_m: float
) -> None:
    size = (0.12, 0.08, 0.10)
    pose = Pose.from_rpy((x, y, z), (0.0, 0.0, yaw))
    view = best_view(PROFILE, pose, size, near_m, MARGIN)
    heights = [round(0.01 * k, 6) for k in range(61)]
    clearly = [h for h in heights if inside(pixels(pose, size, h), -1e-6)]
    if view is None:
        assert clearly == []
    else:
        assert inside(pixels(pose, size, view.height_m), 1e-6)
        assert 0.0 <= view.height_m <= 0.6
        assert all(abs(view.height_m - near_m) <= abs(h - near_m) + 1e-9 for h in clearly)


def test_the_slide_moves_there_and_the_bench_is_grounded_again() -> None:
    graph, problems = lower(plan(("look_at", {"target": obj("tube_5")})), PROFILE, WORLD)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    move, look = [goal for goal in graph.goals if goal.step_id == "look_at#1"]
    assert isinstance(move.action, SlideMove)
    assert isinstance(look.action, Perceive)
    assert look.action.frame == "table"
    tube = PROFILE.object("tube_5")
    assert tube is not None
    T_base_tube = WORLD.robot.T_world_base.inverse() @ WORLD.T_world_object("tube_5")
    assert inside(pixels(T_base_tube, tube.size_m, move.action.height_m), 1e-6)
    assert [item.name for item in move.parameters] == ["look_height", "camera", "look_margin"]


@pytest.mark.parametrize(
    "calls", [(("look_at", {"target": obj("beaker_3")}),), (("look_at", {"target": obj("reader")}),)]
)
def test_what_is_outside_the_picture_at_every_height_is_refused(calls) -> None:
    graph, problems = lower(plan(*calls), PROFILE, WORLD)
    assert graph is None
    assert [problem.code for problem in problems] == ["XEI0724"]


def test_a_held_object_is_not_looked_at() -> None:
    calls = (("pick", {"object": obj("tube_5"), "arm": "right"}), ("look_at", {"target": obj("tube_5")}))
    graph, problems = lower(plan(*calls), PROFILE, WORLD)
    assert graph is None
    assert [problem.code for problem in problems] == ["XEI0710"]


def test_moving_the_object_into_the_picture_helps() -> None:
    world = moved(WORLD, "beaker_3", 0.25, 0.1)
    graph, problems = lower(plan(("look_at", {"target": obj("beaker_3")})), PROFILE, world)
    assert graph is not None, problems
