"""Frames, poses and measurements that cannot be, as a user meets them: a code, a place, exit code 1.

Each is given to the commands that read it: a profile to `xei world show` and `xei doctor`, a scene to
`--world`, a recording to `xei calibrate`, scans to `xei map build`.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tests.cli.xei import PROFILES
from tests.profiles.changed import changed_profile
from tests.world.calibration.recorded import recorded
from tests.world.sources.scenes import scene
from xei_lang.cli.main import main

CALIBRATION = "calibration_profile.yaml"
TABLE = "table: {parent: world, position: [0.5 m, 0 m, 0.75 m]"
TOLERANCE = "tolerance: {position: 2 mm, rotation: 0.3 deg}"
CAMERA = "measured_on: 2026-03-01"
KNOWN = "status: estimated, method: m, tolerance: {position: 1 mm, rotation: 1 deg}"
CIRCLE = f"  a: {{parent: b, {KNOWN}}}\\n  b: {{parent: a, {KNOWN}}}\\n"


def said(folder: Path, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> Result:
    monkeypatch.chdir(folder)
    environment = {"XDG_CACHE_HOME": str(folder / ".cache"), "NO_COLOR": "1"}
    result = CliRunner().invoke(main, list(arguments), env=environment)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def matrix(*rows: str) -> str:
    return "[" + ", ".join(f"[{row}]" for row in rows) + "]"


NUMBERS = ", ".join("0" for _ in range(36))
PROFILE_FAULTS = {
    "a frame on a frame that is not there": (("parent: slide", "parent: neck"), "XEI0630", "`neck`"),
    "frames in a circle": (("  map: {", f"{CIRCLE}  map: {{"), "XEI0630", "`a` -> `b` -> `a`"),
    "a frame on itself": (("parent: slide", "parent: camera"), "XEI0630", "`camera` -> `camera`"),
    "a frame with two parents": (
        ("  camera: {parent: slide", "  slide: {parent: robot_base"), "XEI0630", "two parents",
    ),
    "a frame twice": (("  camera: {", "  table: {"), "XEI0606", "`table` stands twice"),
    "a position of NaN": ((TABLE, TABLE.replace("0.5 m", ".nan")), "XEI0604", "nan"),
    "an infinite position": ((TABLE, TABLE.replace("0.5 m", "1e999 m")), "XEI06", "1e999"),
    "a position without a unit": ((TABLE, TABLE.replace("0.5 m", "0.5")), "XEI0610", "`0.5`"),
    "a position of two numbers": ((TABLE, TABLE.replace("0.5 m, ", "")), "XEI0609", "position"),
    "an angle as a length": ((TABLE, f"{TABLE}, rpy: [1 m, 0 m, 0 m]"), "XEI0610", "`1 m`"),
    "a tolerance below zero": ((TOLERANCE, TOLERANCE.replace("2 mm", "-2 mm")), "XEI0610", "-2 mm"),
    "a tolerance of an unknown kind": (
        (TOLERANCE, TOLERANCE.replace("}", ", as: sigma}")), "XEI0609", "sigma",
    ),
    "a tolerance of a mistyped key": ((TOLERANCE, TOLERANCE.replace("}", ", is: std}")), "XEI0607", "`is`"),
    "a day that no calendar has": ((CAMERA, "measured_on: 2026-02-30"), "XEI0609", "2026-02-30"),
    "a day in words": ((CAMERA, "measured_on: yesterday"), "XEI0609", "yesterday"),
    "an age that is a length": (
        ("spill_tilt: 8 deg", "spill_tilt: 8 deg\\nmax_age: 90 mm"), "XEI0610", "90 mm",
    ),
    "an age of nothing": (("spill_tilt: 8 deg", "spill_tilt: 8 deg\\nmax_age: 0 d"), "XEI0610", "0 d"),
    "a covariance that is too short": (
        (CAMERA, f"{CAMERA}, covariance: [{NUMBERS[3:]}]"), "XEI0609", "covariance",
    ),
    "a covariance that is not symmetric": (
        (CAMERA, f"{CAMERA}, covariance: [1, 2, {NUMBERS[6:]}]"), "XEI0609", "symmetric",
    ),
    "a covariance of NaN": ((CAMERA, f"{CAMERA}, covariance: [.nan, {NUMBERS[3:]}]"), "XEI06", "nan"),
    "a history that says too little": (
        (CAMERA, f"{CAMERA}, history: [{{status: measured, method: m}}]"), "XEI0608", "tolerance",
    ),
    "a history that is no list": ((CAMERA, f"{CAMERA}, history: none"), "XEI0609", "history"),
}  # fmt: skip


@pytest.mark.parametrize(("change", "code", "words"), PROFILE_FAULTS.values(), ids=PROFILE_FAULTS.keys())
def test_a_profile_that_cannot_be_is_told_by_every_command(
    change: tuple[str, str], code: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "profiles").mkdir()
    changed_profile(tmp_path / "profiles", f"{CALIBRATION}\n- {change[0]}\n+ {change[1]}")
    shown = said(tmp_path, monkeypatch, "world", "show", "--profile", "lab")
    assert (shown.exit_code, shown.stdout) == (1, "")
    assert f"error[{code}" in shown.stderr and words in shown.stderr
    assert f"lab/{CALIBRATION}:" in shown.stderr
    doctor = said(tmp_path, monkeypatch, "doctor", "--profile", "lab", "--format", "json")
    assert doctor.exit_code == 1
    told = json.loads(doctor.stdout)
    assert told["readiness"][0]["ready"] is False
    assert any(item["code"].startswith(code) and item["blocks"] == "simulate" for item in told["blockers"])


SCENE_FAULTS = {
    "a matrix that scales": (
        matrix("2, 0, 0, 0", "0, 2, 0, 0", "0, 0, 2, 0", "0, 0, 0, 1"), "XEI0654", "not rigid",
    ),
    "a matrix that shears": (
        matrix("1, 0.3, 0, 0", "0, 1, 0, 0", "0, 0, 1, 0", "0, 0, 0, 1"), "XEI0654", "not rigid",
    ),
    "a matrix that mirrors": (
        matrix("1, 0, 0, 0", "0, 1, 0, 0", "0, 0, -1, 0", "0, 0, 0, 1"), "XEI0654", "mirrors",
    ),
    "a matrix with another last row": (
        matrix("1, 0, 0, 0", "0, 1, 0, 0", "0, 0, 1, 0", "0, 0, 1, 1"), "XEI0654", "row",
    ),
    "a matrix of three rows": (matrix("1, 0, 0, 0", "0, 1, 0, 0", "0, 0, 1, 0"), "XEI06", "matrix"),
    "a matrix of NaN": (matrix(".nan, 0, 0, 0", "0, 1, 0, 0", "0, 0, 1, 0", "0, 0, 0, 1"), "XEI06", "nan"),
}  # fmt: skip


@pytest.mark.parametrize(("value", "code", "words"), SCENE_FAULTS.values(), ids=SCENE_FAULTS.keys())
def test_a_scene_with_a_matrix_that_is_no_pose(
    value: str, code: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refused(f"wipe_1: {{frame: table, matrix: {value}, confidence: 0.9}}", code, words, tmp_path, monkeypatch)


POSE = "wipe_1: {frame: table, position: [0.3 m, 0.3 m, 0 m], confidence: 0.9"


@pytest.mark.parametrize(
    ("objects", "code", "words"),
    [
        (f"{POSE}, quaternion: [0, 0, 0.7, 0.1]}}", "XEI0654", "norm"),
        (f"{POSE}, quaternion: [0, 0, 0, 0]}}", "XEI0654", "norm"),
        (f"{POSE}, quaternion: [0, 0, .nan, 1]}}", "XEI06", "nan"),
        (POSE.replace("0.3 m, 0.3 m", ".inf, 0.3 m") + "}", "XEI0", "inf"),
        (POSE.replace("frame: table", "frame: tabel") + "}", "XEI0655", "tabel"),
        (f"{POSE}}}\n{POSE}}}", "XEI0652", "stands twice"),
        (POSE.replace("wipe_1", "wipe_11") + "}", "XEI0655", "wipe_11"),
        (POSE.replace("0.9", "1.9") + "}", "XEI0", "1.9"),
    ],
)
def test_a_scene_that_cannot_be(
    objects: str, code: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    refused(objects, code, words, tmp_path, monkeypatch)


def refused(objects: str, code: str, words: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "profiles").symlink_to(PROFILES)
    (folder / "bad.yaml").write_text(scene(objects), encoding="utf-8")
    result = said(folder, monkeypatch, "world", "where", "wipe_1", "--world", "bad.yaml")
    assert (result.exit_code, result.stdout) == (1, ""), result.output
    assert f"error[{code}" in result.stderr and words in result.stderr
    assert "bad.yaml:" in result.stderr


RECORDING_FAULTS = {
    "a quaternion of norm 2": (
        '"quaternion_xyzw": [', '"quaternion_xyzw": [2.0, 2.0, 2.0, 2.0], "x": [', "XEI0684",
    ),
    "a position of NaN": ('"position_m": [', '"position_m": [NaN, ', "XEI0684"),
    "an infinite joint": ('"slide_joint": 0.15', '"slide_joint": 1e999', "XEI0684"),
    "a day that no calendar has": ("2026-11-20", "2026-11-31", "XEI0684"),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "code"), RECORDING_FAULTS.values(), ids=RECORDING_FAULTS.keys())
def test_a_recording_that_cannot_be(
    old: str, new: str, code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "profiles").symlink_to(PROFILES)
    text = json.dumps(recorded(1, 6, form="poses"))
    assert old in text
    (tmp_path / "bad.json").write_text(text.replace(old, new, 1), encoding="utf-8")
    result = said(tmp_path, monkeypatch, "calibrate", "bad.json")
    assert (result.exit_code, result.stdout) == (1, ""), result.output
    assert f"error[{code}]" in result.stderr and "bad.json:" in result.stderr


HEAD = (
    '{"version": 1, "recorded_on": "2026-11-20", "lidar": "base", "angle_min_rad": -1.5, '
    '"angle_increment_rad": 0.5, "range_min_m": 0.1, "range_max_m": 12}\n'
)


@pytest.mark.parametrize("line", [
    '{"stamp_s": 0.0, "base": [NaN, 0, 0], "ranges_m": [1.0, 1.0, 1.0]}',
    '{"stamp_s": 0.0, "base": [0, 0], "ranges_m": [1.0, 1.0, 1.0]}',
    '{"stamp_s": 0.0, "base": [0, 0, 0], "ranges_m": [Infinity, 1.0, 1.0]}',
])  # fmt: skip
def test_scans_that_cannot_be(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "bad.jsonl").write_text(f"{HEAD}{line}\n", encoding="utf-8")
    result = said(tmp_path, monkeypatch, "map", "build", "bad.jsonl", "-o", "out")
    assert (result.exit_code, result.stdout) == (1, ""), result.output
    assert "error[XEI0667]" in result.stderr and "bad.jsonl:2" in result.stderr
    assert not (tmp_path / "out").exists()
