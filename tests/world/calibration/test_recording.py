"""Recordings: what is read, what is refused, and that kinematics is the robot model's."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from tests.world.calibration.recorded import CAMERA_TRUTH, recorded
from tests.world.perception.views import bench
from xei_lang.diagnostics import Source
from xei_lang.motion.robot import load_robot
from xei_lang.profiles.open import robot_texts
from xei_lang.profiles.schema.recording import RecordingModel
from xei_lang.world.calibration.hand_eye import HandEye, solve_hand_eye
from xei_lang.world.calibration.recording import read_recording

ROOT = Path(__file__).parents[3]
SCHEMA = ROOT / "xei_lang" / "world" / "calibration" / "recording.schema.json"


def read(document):
    return read_recording(Source("hand_eye.json", json.dumps(document)), bench())


def test_the_schema_is_the_models(update_golden):
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **RecordingModel.model_json_schema(),
    }
    text = json.dumps(schema, indent=2) + "\n"
    if update_golden:
        SCHEMA.write_text(text, encoding="utf-8")
    assert SCHEMA.read_text(encoding="utf-8") == text
    jsonschema.Draft202012Validator(schema).validate(recorded(1, 6))


@pytest.mark.parametrize("form", ["tags", "poses"])
def test_a_recording_with_the_hand_before_the_head_camera_is_solved(form):
    recording, said = read(recorded(1, 15, form=form))
    assert recording is not None, said
    found = solve_hand_eye(recording.samples, recording.camera.fx)
    assert isinstance(found, HandEye), found
    apart = CAMERA_TRUTH.inverse() @ found.T_parent_camera
    assert np.linalg.norm(apart.position_m) < 1e-7
    assert np.linalg.norm(apart.quaternion[:3]) < 1e-7


def test_kinematics_is_that_of_the_robot_model():
    document = recorded(2, 6)
    recording, said = read(document)
    assert recording is not None, said
    robot = load_robot(*robot_texts(bench()))
    for sample, stated in zip(recording.samples, document["samples"], strict=True):
        q = np.zeros(robot.nq)
        for name, value in stated["joints"].items():
            q[robot.joint_names.index(name)] = value
        T_base_tool = robot.T_base_frame(q, "openarm_left_grasp")
        T_base_slide = robot.T_base_frame(q, "slide_carriage")
        assert np.abs(sample.A - np.linalg.inv(T_base_tool) @ T_base_slide).max() < 1e-12


def change(path, value):
    """The recording with a value at a path; `...` takes the key away."""
    document = copy.deepcopy(recorded(1, 6))
    *way, last = path
    place = document
    for step in way:
        place = place[step]
    if value is ...:
        del place[last]
    else:
        place[last] = value
    return document


@pytest.mark.parametrize(
    ("document", "message"),
    [
        (change(["version"], 2), "version 2"),
        (change(["camera"], "heed"), "`heed` is no camera of this profile"),
        (change(["target"], "table"), "`table` is no frame that the robot carries"),
        (change(["samples"], []), "`samples`"),
        (change(["samples", 2, "joints", "openarm_left_joint9"], 0.0), "no joint `openarm_left_joint9`"),
        (
            change(["samples", 2, "joints", "openarm_left_joint2"], ...),
            "has no position of `openarm_left_joint2`",
        ),
        (change(["samples", 2, "joints", "openarm_left_joint2"], 45.0), "cannot be at 45 rad"),
        (change(["samples", 2, "joints", "openarm_left_joint2"], "0.5"), "must be a number"),
        (change(["samples", 2, "tags"], []), "sample 3 must have either `tags` or a `pose`"),
        (change(["samples", 2, "tags", 0, "id"], 99), "tag 99 is not on the board"),
        (change(["samples", 2, "tags", 1, "id"], 100), "tag 100 stands twice in sample 3"),
        (change(["samples", 2, "tags", 0, "corners_px"], [[1, 1], [2, 2]]), "corners_px"),
        (change(["board"], []), "is not on the board"),
        (change(["board", 0, "size_m"], -1.0), "size_m"),
        (change(["stray"], 1), "`stray` is not a key"),
    ],
)
def test_what_is_wrong_is_said_at_its_place(document, message):
    recording, said = read(document)
    assert recording is None
    assert {one.code for one in said} == {"XEI0684"}
    assert any(message in one.message for one in said), [one.message for one in said]
    assert all(one.span is not None for one in said)


@pytest.mark.parametrize(
    "text", ["", "[", "1", "samples: [.nan]", '{"version": 1, "samples": [NaN]}', "a: &a [*a]"]
)
def test_no_text_brings_it_down(text):
    recording, said = read_recording(Source("hand_eye.yaml", text), bench())
    assert recording is None
    assert said


def test_nan_is_no_number():
    text = json.dumps(recorded(1, 6)).replace('"slide_joint": ', '"slide_joint": NaN, "unused": ', 1)
    recording, said = read_recording(Source("hand_eye.json", text), bench())
    assert recording is None
    assert any("NaN" in one.message for one in said), said


def test_a_quaternion_of_another_norm_and_both_kinds_are_refused():
    document = recorded(1, 6, form="poses")
    document["samples"][1]["pose"]["quaternion_xyzw"] = [0.0, 0.0, 0.0, 2.0]
    assert "norm 2" in read(document)[1][0].message
    document = recorded(1, 6, form="poses")
    document["samples"][1] = recorded(1, 6)["samples"][1]
    document["board"] = recorded(1, 6)["board"]
    assert "some samples have tags and some a pose" in read(document)[1][0].message
