"""Several cameras: which one is meant, what a camera in the room sees, and how its place is solved."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from tests.world.calibration.recorded import BOARD, T_TOOL_BOARD, recorded, seen_by
from tests.world.perception.pictures import STAMP_NS
from tests.world.perception.render import render
from tests.world.perception.serving import served
from tests.world.perception.two_cameras import CEILING, two_cameras
from tests.world.perception.views import bench
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Camera, Profile
from xei_lang.world.calibration.carriers import carried, joints_between
from xei_lang.world.calibration.hand_eye import HandEye, solve_hand_eye
from xei_lang.world.calibration.recording import read_recording
from xei_lang.world.ground import ground
from xei_lang.world.perception.cameras import camera_at, camera_named, is_carried
from xei_lang.world.perception.client import PoseClient
from xei_lang.world.perception.findings import findings, to_text
from xei_lang.world.perception.look import look
from xei_lang.world.perception.observe import Seen, ask_for, observe
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics, matrix_of
from xei_lang.world.perception.registry import registry_of
from xei_lang.world.perception.service.apriltag import AprilTagBackend
from xei_lang.world.perception.service.handle import Desk


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Profile:
    return two_cameras(tmp_path_factory.mktemp("lab"))


def the(lab: Profile, name: str) -> Camera:
    found = camera_named(lab, name)
    assert isinstance(found, Camera)
    return found


def test_the_only_camera_is_meant_where_none_is_named(lab: Profile) -> None:
    assert camera_named(bench(), None) == bench().calibration.cameras[0]
    unsaid = camera_named(lab, None)
    assert isinstance(unsaid, Diagnostic) and unsaid.code == "XEI0680"
    assert unsaid.help == ("name one of `head`, `ceiling` with `--camera`",)
    wrong = camera_named(lab, "cieling")
    assert isinstance(wrong, Diagnostic) and wrong.help == ("did you mean `ceiling`?",)
    none = camera_named(replace(lab, calibration=replace(lab.calibration, cameras=())), None)
    assert isinstance(none, Diagnostic) and none.message == "the profile has no camera"


def test_a_camera_is_known_by_what_it_hangs_on(lab: Profile) -> None:
    assert [(one.name, is_carried(lab, one)) for one in lab.calibration.cameras] == [
        ("head", True),
        ("ceiling", False),
    ]
    assert [camera_at(lab, name) for name in ("camera", "ceiling", "slide")] == ["head", "ceiling", "slide"]


@pytest.mark.parametrize(("moved", "within"), [(Pose(), True), (Pose((0.02, -0.01, 0.0)), False)])
def test_a_camera_in_the_room_verifies_a_table_wherever_the_base_stands(
    lab: Profile, moved: Pose, within: bool
) -> None:
    camera = the(lab, "ceiling")
    T_optical_table = (CEILING @ T_CAMERA_OPTICAL).inverse() @ Pose((0.5, 0.0, 0.75)) @ moved
    tags = [tag for tag in lab.calibration.apriltags.tags if tag.frame == "table"]
    image = render(tags, matrix_of(T_optical_table), Optics.of(camera), seed=2)
    found = findings(look(image, lab.calibration.apriltags, camera, "table"), lab, camera)
    (table,) = found.frames
    assert table.verified is not None and table.verified.deviation.within is within
    there = (Pose((0.5, 0.0, 0.75)) @ moved).position_m
    assert np.allclose(table.verified.T_parent_found.position_m, there, atol=1e-3)
    assert "by a camera that stands still" in to_text(found)
    assert "bench_a" not in "".join(str(item) for item in found.diagnostics)


def test_what_it_sees_is_told_with_its_name(lab: Profile) -> None:
    mujoco_bench = pytest.importorskip("tests.world.perception.mujoco_bench")
    if (missing := mujoco_bench.egl_missing()) is not None:
        pytest.skip(missing)
    world, said = ground(lab)
    assert world is not None, said
    picture = mujoco_bench.take_picture(lab, world, the(lab, "ceiling"), stamp_ns=STAMP_NS)
    request = ask_for(picture, registry_of(lab), ("rack_1", "rack_2"), request_id="r", session_id="s")
    with served(Desk(lab, AprilTagBackend(lab))) as url:
        seen = observe(PoseClient(url), lab, request, now_ns=STAMP_NS)
    assert isinstance(seen, Seen) and seen.refused == (), seen
    for item in seen.observations.items:
        assert dict(item.metadata)["pose_service.camera"] == "ceiling"
        assert item.T_frame_object is not None
        apart = world.T_world_object(item.name).inverse() @ item.T_frame_object
        assert np.linalg.norm(apart.position_m) < 1e-3
    again, said = ground(lab, (seen.observations,))
    assert again is not None, said
    rack = again.find("rack_1")
    assert rack is not None and dict(rack.metadata)["pose_service.camera"] == "ceiling"


def recorded_below(lab: Profile, count: int) -> dict[str, object]:
    """A recording of a board in the left hand, below the camera, with the base at the first bench."""
    truth = CEILING @ Pose.from_rpy((0.013, -0.021, 0.008), (0.01, -0.02, 0.03))
    tool = carried(lab, "left_tool")
    assert tool is not None
    moving = joints_between(lab.robot, lab.robot.root, tool.link)
    random = np.random.default_rng(5)
    samples: list[object] = []
    while len(samples) < count:
        joints = {one.name: round(float(random.uniform(one.lower, one.upper)), 6) for one in moving}
        T_base_board = tool.T_base_frame(lab.robot, joints) @ T_TOOL_BOARD
        seen = seen_by((truth @ T_CAMERA_OPTICAL).inverse() @ T_base_board, random, 0.0)
        if seen is not None:
            samples.append({"joints": joints, "tags": seen})
    return {"version": 1, "recorded_on": "2026-11-20", "camera": "ceiling", "target": "left_tool",
            "station": "bench_a", "board": BOARD, "samples": samples}  # fmt: skip


def test_a_camera_in_the_room_is_calibrated_by_a_hand_at_a_station(lab: Profile) -> None:
    document = recorded_below(lab, 12)
    recording, said = read_recording(Source("x.json", json.dumps(document)), lab)
    assert recording is not None, said
    assert recording.frame.parent == "world"
    assert recording.standing is not None and recording.standing.robot.station == "bench_a"
    found = solve_hand_eye(recording.samples, recording.camera.fx)
    assert isinstance(found, HandEye), found
    truth = CEILING @ Pose.from_rpy((0.013, -0.021, 0.008), (0.01, -0.02, 0.03))
    apart = truth.inverse() @ found.T_parent_camera
    assert np.linalg.norm(apart.position_m) < 1e-6
    assert np.linalg.norm(apart.quaternion[:3]) < 1e-6


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"station": None}, "nothing says where the robot stood"),
        ({"station": "bench_c"}, "`bench_c` is no station"),
    ],
)
def test_where_the_base_stood_must_be_said(lab: Profile, changes: dict[str, object], message: str) -> None:
    document = {**recorded_below(lab, 1), **changes}
    recording, said = read_recording(Source("x.json", json.dumps(document)), lab)
    assert recording is None
    assert [item.code for item in said] == ["XEI0684"] and message in said[0].message


def test_a_station_is_nothing_to_a_camera_that_the_robot_carries() -> None:
    plain, _ = read_recording(Source("x.json", json.dumps(recorded(1, 6))), bench())
    said, _ = read_recording(Source("x.json", json.dumps({**recorded(1, 6), "station": "bench_b"})), bench())
    assert plain is not None and said is not None
    assert [one.A.tolist() for one in plain.samples] == [one.A.tolist() for one in said.samples]
    assert said.standing is None
