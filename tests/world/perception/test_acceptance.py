"""What is believed of an answer: poses beside a picture that MuJoCo rendered, right ones and wrong ones."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.world.perception.pictures import STAMP_NS, rendered
from xei_lang.ir.geometry import Pose
from xei_lang.world.ground import ground
from xei_lang.world.perception.acceptance import Criteria, Evidence, accept
from xei_lang.world.perception.observe import Seen, judge, roll_pitch_yaw
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics
from xei_lang.world.perception.pictures import depth_image, encode_mask
from xei_lang.world.perception.pose_request import ObjectPose, PoseResponse
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.service_fault import PoseRefused, ServiceFault
from xei_lang.world.perception.silhouette import silhouette

mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
_MISSING = mujoco_bench.egl_missing()
pytestmark = pytest.mark.skipif(_MISSING is not None, reason=_MISSING or "")

SEEN = ("table", "rack_1", "rack_2", "bottle_1", "pipette_1", "tube_1", "tube_2", "incubator", "heater_block")


def said(name: str, T: Pose | np.ndarray, **changes) -> ObjectPose:
    known = registry_of(rendered().lab).find(name)
    assert known is not None
    rows = T.matrix() if isinstance(T, Pose) else tuple(tuple(float(v) for v in row) for row in T)
    given = ObjectPose(name, "world", "ok", rows, 0.9, None, known.roles, known.skills, known.mesh)
    return replace(given, **changes)


def true(name: str) -> Pose:
    return rendered().truth.T_world_object(name)


def judged(*items: ObjectPose, now_ns: int = STAMP_NS, stamp_ns: int = STAMP_NS, masks=None):
    scene = rendered()
    request = scene.request(*(item.name for item in items))
    queries = tuple(replace(query, mask_png=(masks or {}).get(query.object_id)) for query in request.queries)
    answer = PoseResponse("r1", stamp_ns, items, "test", 1.0)
    found = judge("http://x", scene.lab, replace(request, queries=queries), answer, now_ns=now_ns)
    assert isinstance(found, Seen)
    return found


def reason(item: ObjectPose, **how) -> str:
    found = judged(item, **how)
    assert [one.name for one in found.refused] == [item.name], found
    assert found.observations.items == ()
    return found.refused[0].reason


def optics() -> Optics:
    return Optics.of_intrinsics(rendered().picture.intrinsics)


def depth() -> np.ndarray:
    picture = rendered().picture
    found = depth_image(picture.depth_png16, optics().size_px, picture.depth_scale_m)
    assert not isinstance(found, str)
    return found


@pytest.mark.parametrize("name", SEEN)
def test_the_truth_is_believed(name):
    found = judged(said(name, true(name)))
    assert found.refused == ()
    (item,) = found.observations.items
    assert (item.name, item.frame_id, item.stamp_ns) == (name, "world", STAMP_NS)
    assert math.dist(item.T_frame_object.position_m, true(name).position_m) < 1e-9
    assert float(dict(item.metadata)["pose_service.agreeing"]) > 0.85


@pytest.mark.parametrize("name", SEEN)
def test_expected_depths_are_those_that_are_rendered(name):
    scene = rendered()
    geometry = scene.lab.object(name).geometry
    seen = silhouette(geometry, scene.picture.T_output_camera.inverse() @ true(name), optics())
    assert seen is not None
    off = depth()[seen.pixels[:, 0], seen.pixels[:, 1]] - seen.depths_m
    shown = np.abs(off) < 0.02
    assert shown.mean() > 0.3
    assert abs(np.median(off[shown])) < 0.0005


@pytest.mark.parametrize(("name", "size_m"), [("bottle_1", 0.01), ("tube_1", 0.01), ("bottle_1", 0.03),
                                              ("tube_1", 0.03), ("heater_block", 0.03)])  # fmt: skip
@pytest.mark.parametrize("way", [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)])
def test_a_pose_that_is_a_centimetre_off_is_not(name, size_m, way):
    """The near side of the heater block stands behind a rack, so that one is seen to two centimetres only."""
    shifted = Pose(tuple(size_m * value for value in way)) @ true(name)
    assert reason(said(name, shifted)) in {"depth_residual", "hidden"}


@pytest.mark.parametrize("way", [(1, 0, 0), (0, 1, 0), (0, 0, 1)])
def test_a_large_thing_that_slid_along_its_own_top_is_noticed_at_its_edge(way):
    """The picture cuts it off at its near side, and another rack stands at its right: not these ways."""
    shifted = Pose(tuple(0.02 * value for value in way)) @ true("rack_2")
    assert reason(said("rack_2", shifted)) == "depth_residual"


def test_a_pose_sunk_into_the_table_is_left_to_grounding_where_the_picture_does_not_refuse_it():
    found = judged(said("bottle_1", Pose((0.0, 0.0, -0.03)) @ true("bottle_1")))
    if not found.refused:
        world, told = ground(rendered().lab, (found.observations,))
        assert world is None, told


@pytest.mark.parametrize("name", ["bottle_1", "rack_2"])
def test_a_pose_that_lies_on_its_side_is_not(name):
    assert (
        reason(said(name, true(name) @ Pose.from_rpy((0, 0, 0.05), (math.pi / 2, 0, 0)))) == "depth_residual"
    )


def test_what_is_no_pose_is_told_as_such():
    good = np.array(true("bottle_1").matrix())
    scaled, mirrored, sheared, row = good.copy(), good.copy(), good.copy(), good.copy()
    scaled[:3, :3] *= 1.01
    mirrored[:3, 0] *= -1
    sheared[0, 1] += 0.01
    row[3] = (0, 0, 0, 2)
    far = good.copy()
    far[:3, 3] *= 1000
    for matrix in (scaled, mirrored, sheared, row, far, good[:3], np.full((4, 4), np.nan)):
        assert reason(said("bottle_1", matrix)) == "not_rigid"


def test_a_pose_outside_of_the_workspace_is_told():
    far = Pose((-2.0, 0.0, 0.0)) @ true("bottle_1")
    found = judged(said("bottle_1", far))
    assert [item.reason for item in found.refused] == ["outside_workspace"]
    (told,) = found.diagnostics
    assert (told.code, "outside of the workspace" in told.message) == ("XEI0697", True)
    assert found.refused[0].feedback("g7").failed_stage == "world_grounding"


def test_a_pose_beside_the_picture_cannot_be_held_against_it():
    found = judged(said("bottle_1", Pose((0.4, 0.8, 0.75))))
    assert [item.reason for item in found.refused] == ["out_of_view"]
    assert found.diagnostics[0].code == "XEI0699"


def test_a_pose_behind_something_is_called_hidden():
    behind = Pose((0.0, 0.0, -0.15)) @ true("heater_block")
    assert reason(said("heater_block", behind)) == "hidden"


@pytest.mark.parametrize(
    ("stamp_ns", "now_ns", "expected"),
    [
        (STAMP_NS, STAMP_NS + 2_100_000_000, "stale"),
        (STAMP_NS - 3_000_000_000, STAMP_NS, "stale"),
        (0, STAMP_NS, "stale"),
        (STAMP_NS + 60_000_000, STAMP_NS, "from_the_future"),
    ],
)
def test_a_picture_of_another_time_is_refused(stamp_ns, now_ns, expected):
    assert reason(said("bottle_1", true("bottle_1")), stamp_ns=stamp_ns, now_ns=now_ns) == expected


def test_masks_are_held_against_the_silhouette():
    scene = rendered()
    geometry = scene.lab.object("bottle_1").geometry
    seen = silhouette(geometry, scene.picture.T_output_camera.inverse() @ true("bottle_1"), optics())
    right = np.zeros(depth().shape, dtype=bool)
    right[seen.pixels[:, 0], seen.pixels[:, 1]] = True
    item = said("bottle_1", true("bottle_1"))
    found = judged(item, masks={"bottle_1": encode_mask(right)})
    assert float(dict(found.observations.items[0].metadata)["pose_service.mask_overlap"]) > 0.9
    assert reason(item, masks={"bottle_1": encode_mask(np.roll(right, 60, axis=1))}) == "mask_overlap"
    assert reason(item, masks={"bottle_1": encode_mask(np.ones_like(right))}) == "mask_overlap"


@pytest.mark.parametrize("status", ["no_object", "low_quality", "error"])
def test_what_the_service_does_not_find_stays_unknown(status):
    item = replace(said("bottle_1", true("bottle_1")), status=status, T_output_object=None)
    expected = "service_error" if status == "error" else status
    assert reason(item) == expected


def test_answers_about_other_things_frames_and_silence_are_told():
    scene = rendered()
    request = scene.request("bottle_1", "rack_1", "tube_1")
    items = (said("pipette_1", true("pipette_1")), said("rack_1", true("rack_1"), frame_id="table"),
             said("tube_1", true("tube_1")), said("tube_1", true("tube_1")))  # fmt: skip
    found = judge(
        "http://x", scene.lab, request, PoseResponse("r1", STAMP_NS, items, "t", 1.0), now_ns=STAMP_NS
    )
    assert isinstance(found, Seen)
    assert [(item.name, item.reason) for item in found.refused] == [
        ("pipette_1", "not_asked"), ("rack_1", "other_frame"), ("tube_1", "not_asked"),
        ("bottle_1", "missing"),
    ]  # fmt: skip
    assert [item.name for item in found.observations.items] == ["tube_1"]
    assert found.observations.looked_for == ("bottle_1", "rack_1", "tube_1")


def test_a_depth_image_of_no_use_is_told():
    scene = rendered()
    request = scene.request("bottle_1")
    request = replace(request, picture=replace(scene.picture, depth_png16=scene.picture.rgb_png))
    answer = PoseResponse("r1", STAMP_NS, (said("bottle_1", true("bottle_1")),), "t", 1.0)
    found = judge("http://x", scene.lab, request, answer, now_ns=STAMP_NS)
    assert isinstance(found, ServiceFault)
    assert found.reason == "no_picture"


def test_without_depth_nothing_is_believed():
    scene = rendered()
    blind = np.full(depth().shape, np.nan)
    bounds = scene.lab.calibration.workspace_bounds_m
    evidence = Evidence(scene.picture, optics(), blind, None, bounds, Pose())
    found = accept(
        said("bottle_1", true("bottle_1")), scene.lab.object("bottle_1").geometry, evidence, Criteria()
    )
    assert isinstance(found, PoseRefused)
    assert found.reason == "hidden"


def test_a_covariance_in_the_objects_axes_becomes_one_of_roll_pitch_and_yaw():
    pose = Pose.from_rpy((0.3, -0.1, 0.2), (0.4, -0.3, 0.9))
    random = np.random.default_rng(1)
    spread = random.normal(size=(6, 6)) * 1e-4
    covariance = spread @ spread.T
    rows = tuple(tuple(float(value) for value in row) for row in covariance)
    found = np.array(roll_pitch_yaw(rows, pose)).reshape(6, 6)
    drawn = random.multivariate_normal(np.zeros(6), covariance, 20_000)
    samples = []
    for motion in drawn:
        # A small rotation's vector is twice the vector part of its quaternion.
        half = 0.5 * motion[3:]
        w = math.sqrt(1.0 - float(half @ half))
        moved = pose @ Pose(tuple(motion[:3]), (*half, w))
        R = np.array(moved.matrix())[:3, :3]
        angles = (math.atan2(R[2, 1], R[2, 2]), math.asin(-R[2, 0]), math.atan2(R[1, 0], R[0, 0]))
        samples.append((*moved.position_m, *angles))
    assert np.allclose(np.cov(np.array(samples).T), found, rtol=0.05, atol=0.03 * np.abs(found).max())
    assert roll_pitch_yaw(None, pose) == ()
    assert roll_pitch_yaw(rows, Pose.from_rpy((0, 0, 0), (0, math.pi / 2, 0))) == ()
    assert T_CAMERA_OPTICAL.quaternion[0] == -0.5
