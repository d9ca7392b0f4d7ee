"""`xei calibrate`: a recording to lines of the profile, or into it."""

from __future__ import annotations

import json
import math
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from tests.cli.xei import PROFILES, ROOT, xei
from tests.world.calibration.recorded import CAMERA_TRUTH, recorded
from tests.world.perception.test_cameras import recorded_below
from tests.world.perception.two_cameras import write_two_cameras
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
    assert camera.tolerance_as == "std"
    assert math.hypot(*apart.position_m) < 3 * camera.position_tolerance_m < 0.005
    assert 2 * math.hypot(*apart.quaternion[:3]) < 3 * camera.rotation_tolerance_rad < 0.01
    assert camera.residual.endswith(" px")
    assert camera.covariance[0] > 0.0
    [before] = camera.history
    assert before.status == "placeholder" and before.tolerance_as == "bound"
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


def test_motions_that_fix_nothing_are_refused_with_the_reason(lab: Path) -> None:
    document = recorded(1, 12, form="poses")
    only = {}
    for name, moved in (("slid", {"slide_joint"}), ("turned", {"slide_joint", "openarm_left_joint1"})):
        samples = json.loads(json.dumps(document["samples"]))
        for index, sample in enumerate(samples):
            joints = {**samples[0]["joints"], "slide_joint": 0.02 * index}
            if "openarm_left_joint1" in moved:
                joints["openarm_left_joint1"] = -0.5 + 0.1 * index
            sample["joints"] = joints
        only[name] = {**document, "samples": samples}
    for name, reason in (("slid", "hardly turn"), ("turned", "turn about one axis only")):
        (lab / f"{name}.json").write_text(json.dumps(only[name]), encoding="utf-8")
        ran = xei("calibrate", f"{name}.json", "--write", cwd=lab)
        assert ran.code == 1
        assert "error[XEI0685]" in ran.err and reason in ran.err
    nothing = {**document, "target": "slide"}
    (lab / "nothing.json").write_text(json.dumps(nothing), encoding="utf-8")
    ran = xei("calibrate", "nothing.json", cwd=lab)
    assert ran.code == 1
    assert "no joint moves `slide` against `camera`" in ran.err


def test_a_camera_in_the_room_is_known_no_better_than_the_base(tmp_path: Path) -> None:
    folder = write_two_cameras(tmp_path)
    (tmp_path / "room.json").write_text(json.dumps(recorded_below(two(folder), 12)), encoding="utf-8")
    ran = xei("calibrate", "room.json", "--write", cwd=tmp_path)
    assert ran.code == 0, ran.err
    ceiling = next(frame for frame in two(folder).calibration.frames if frame.name == "ceiling")
    assert (ceiling.status, ceiling.parent, ceiling.tolerance_as) == ("measured", "world", "bound")
    # Docking is good to 80 mm and 0.15 rad, and the camera is almost 2 m away from the base's origin.
    assert 0.08 + 0.15 * 1.9 < ceiling.position_tolerance_m < 0.08 + 0.15 * 2.1
    assert 0.15 <= ceiling.rotation_tolerance_rad < 0.151
    assert "the base's place at bench_a" in ceiling.method


def two(folder: Path):
    profile, said = load_profile(folder, None)
    assert profile is not None, said
    return profile


def test_what_it_was_goes_to_the_history_and_a_jump_is_told(lab: Path) -> None:
    assert xei("calibrate", "hand_eye.json", "--write", cwd=lab).code == 0
    again = xei("calibrate", "hand_eye.json", "--write", cwd=lab)
    assert (again.code, len(camera_of(lab).history)) == (0, 1)
    assert "stands there" in again.err
    moved = json.loads(json.dumps(recorded(2, 20, noise_px=0.2)))
    moved["recorded_on"] = "2026-12-24"
    for sample in moved["samples"]:
        sample["joints"]["slide_joint"] -= 0.002
    (lab / "moved.json").write_text(json.dumps(moved), encoding="utf-8")
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    before = camera_of(lab)
    ran = xei("calibrate", "moved.json", "--write", cwd=lab)
    assert ran.code == 0
    after = camera_of(lab)
    assert [(one.status, one.measured_on) for one in after.history] == [
        ("measured", "2026-11-20"),
        ("placeholder", ""),
    ]
    first = after.history[0]
    assert (first.T_parent_frame, first.residual) == (before.T_parent_frame, before.residual)
    shown = xei("world", "where", "camera", "--history", cwd=lab)
    assert "measured on 2026-12-24" in shown.out and "measured on 2026-11-20" in shown.out
    # The slide moves hand and camera alike, so that this is the same place again: no jump.
    assert "XEI0669" not in ran.err
    text = file.read_text(encoding="utf-8")
    x_m = after.T_parent_frame.position_m[0]
    assert text.count(f"[{x_m:.6f} m") == 1
    file.write_text(text.replace(f"[{x_m:.6f} m", f"[{x_m + 0.004:.6f} m"), encoding="utf-8")
    later = {**json.loads((lab / "hand_eye.json").read_text()), "recorded_on": "2026-12-25"}
    (lab / "later.json").write_text(json.dumps(later), encoding="utf-8")
    assert "XEI0687" in xei("calibrate", "hand_eye.json", "--write", cwd=lab).err, "it is of November"
    ran = xei("calibrate", "later.json", "--write", cwd=lab)
    assert ran.code == 0
    assert re.search(r"warning\[XEI0669\]: `camera` moved by (3\.9|4\.0)\d mm", ran.err)
    told = xei("doctor", cwd=lab)
    assert "warning[XEI0669]" in told.err
    assert "more than both tolerances allow" in xei("world", "where", "camera", "--history", cwd=lab).out


def limited_disk() -> None:
    """No file of this process may become larger than what a calibration profile takes."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def test_a_full_disk_loses_nothing(lab: Path) -> None:
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    before = file.read_bytes()
    assert xei("world", "where", "camera", cwd=lab).code == 0, "a warm cache"
    program = "from xei_lang.cli.main import run; run()"
    process = subprocess.run(
        [sys.executable, "-c", program, "calibrate", "hand_eye.json", "--write"],
        cwd=lab, env={**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(lab / ".cache")},
        preexec_fn=limited_disk, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert process.returncode == 2, process.stderr
    assert "XEI0101" in process.stderr and "too large" in process.stderr
    assert file.read_bytes() == before
    assert [one.name for one in file.parent.iterdir() if one.name.startswith(".calibration")] == []


DYING = """
import os, signal
from pathlib import Path
replace = Path.replace
def die(self, target):
    if Path(target).name != "calibration_profile.yaml":
        return replace(self, target)
    if {after}:
        replace(self, target)
    os.kill(os.getpid(), signal.SIGKILL)
Path.replace = die
from xei_lang.cli.main import run
run()
"""


@pytest.mark.parametrize("after", [False, True])
def test_a_killed_process_leaves_the_old_profile_or_the_new_one(lab: Path, after: bool) -> None:
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    before = file.read_bytes()
    process = subprocess.run(
        [sys.executable, "-c", DYING.format(after=after), "calibrate", "hand_eye.json", "--write"],
        cwd=lab, env={**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(lab / ".cache")},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert process.returncode == -signal.SIGKILL
    assert (file.read_bytes() == before) is not after
    assert camera_of(lab).status == ("measured" if after else "placeholder")
    assert xei("calibrate", "hand_eye.json", "--write", cwd=lab).code == 0
    assert camera_of(lab).status == "measured"


def xei_slipped(lab: Path, document) -> str:
    (lab / "bad.json").write_text(json.dumps(document), encoding="utf-8")
    return xei("calibrate", "bad.json", cwd=lab).err
