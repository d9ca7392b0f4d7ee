"""`xei calibrate`: a recording to lines of the profile, or into it."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path

import pytest
import yaml

from tests.cli.xei import PROFILES, xei
from tests.world.calibration.recorded import CAMERA_TRUTH, recorded
from xei_lang.profiles.load import load_profile


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    shutil.copytree(PROFILES, tmp_path / "profiles")
    (tmp_path / "hand_eye.json").write_text(json.dumps(recorded(1, 20, noise_px=0.2)), encoding="utf-8")
    return tmp_path


def camera_of(folder: Path):
    profile, said = load_profile(folder / "profiles" / "openarm_bench", None)
    assert profile is not None, said
    return next(frame for frame in profile.calibration.frames if frame.name == "camera")


def test_lines_of_the_profile_are_printed_and_nothing_is_written(lab: Path) -> None:
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    before = file.read_bytes()
    ran = xei("calibrate", "hand_eye.json", cwd=lab)
    assert ran.code == 0, ran.err
    frame = yaml.safe_load(ran.out)["frames"]["camera"]
    assert (frame["status"], frame["measured_on"], frame["parent"]) == ("measured", "2026-11-20", "slide")
    assert "20 samples" in frame["method"]
    assert "standard deviation" in ran.err
    assert file.read_bytes() == before
    assert xei("calibrate", "hand_eye.json", cwd=lab).out == ran.out


def test_the_profile_takes_it_in_place(lab: Path) -> None:
    ran = xei("calibrate", "hand_eye.json", "--write", cwd=lab)
    assert ran.code == 0, ran.err
    assert ran.out == ""
    camera = camera_of(lab)
    apart = CAMERA_TRUTH.inverse() @ camera.T_parent_frame
    assert camera.status == "measured"
    assert math.hypot(*apart.position_m) < camera.position_tolerance_m < 0.005
    assert 2 * math.hypot(*apart.quaternion[:3]) < camera.rotation_tolerance_rad < 0.01
    text = (lab / "profiles" / "openarm_bench" / "calibration_profile.yaml").read_text(encoding="utf-8")
    comments = [line for line in text.splitlines() if line.lstrip().startswith("#")]
    bench = (PROFILES / "openarm_bench" / "calibration_profile.yaml").read_text(encoding="utf-8")
    assert comments == [line for line in bench.splitlines() if line.lstrip().startswith("#")]


def test_lines_go_to_a_file(lab: Path) -> None:
    ran = xei("calibrate", "hand_eye.json", "-o", "camera.yaml", "--quiet", cwd=lab)
    assert (ran.code, ran.out, ran.err) == (0, "", "")
    assert "camera:" in (lab / "camera.yaml").read_text(encoding="utf-8")
    assert xei("calibrate", "hand_eye.json", "-o", "x", "--write", cwd=lab).code == 2


def test_refusals_have_a_code_and_write_nothing(lab: Path) -> None:
    before = camera_of(lab)
    document = recorded(1, 20, noise_px=0.2)
    few = {**document, "samples": document["samples"][:3]}
    still = {**document, "samples": document["samples"][:1] * 9}
    slipped = json.loads(json.dumps(document))
    slipped["samples"][4]["tags"] = document["samples"][5]["tags"]
    for bad, code in ((few, "XEI0685"), (still, "XEI0685"), (slipped, "XEI0686"), ({}, "XEI0684")):
        (lab / "bad.json").write_text(json.dumps(bad), encoding="utf-8")
        ran = xei("calibrate", "bad.json", "--write", cwd=lab)
        assert ran.code == 1
        assert f"error[{code}]" in ran.err
    assert "sample 5 contradicts" in xei_slipped(lab, slipped)
    assert camera_of(lab).T_parent_frame == before.T_parent_frame
    assert xei("calibrate", "absent.json", cwd=lab).code == 2


def xei_slipped(lab: Path, document) -> str:
    (lab / "bad.json").write_text(json.dumps(document), encoding="utf-8")
    return xei("calibrate", "bad.json", cwd=lab).err
