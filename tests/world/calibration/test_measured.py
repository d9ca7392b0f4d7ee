"""A transform written into a profile: its values, and nothing else."""

from __future__ import annotations

import difflib
from dataclasses import replace

import pytest

from tests.world.perception.views import ROOT
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.yaml_edit import flow
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.world.calibration.measured import Measured, put_in

BENCH = (ROOT / "profiles" / "openarm_bench" / "calibration_profile.yaml").read_text(encoding="utf-8")
MEASURED = Measured(
    "camera", "slide", Pose.from_rpy((0.06421, -0.0031, 0.7968), (0.004, 0.71, -0.012)), "2026-11-20",
    'hand-eye "calibration"', 2.3e-4, 1e-4, "std", (("pixel", 0.21),),
    tuple(5.29e-8 if row == column else 0.0 for row in range(6) for column in range(6)),
)  # fmt: skip


def plain(text: str):
    root, said = read_yaml("calibration_profile.yaml", text)
    assert root is not None, said
    return root.plain()


def put(text: str) -> str:
    found = put_in(Source("calibration_profile.yaml", text), MEASURED)
    assert isinstance(found, str), found
    return found


def test_only_the_lines_of_the_transform_change():
    text = put(BENCH)
    changed = [line for line in difflib.ndiff(BENCH.splitlines(), text.splitlines()) if line[0] in "+-"]
    assert sorted(line.split(":")[0][2:].strip() for line in changed if line[0] == "-") == [
        "method", "position", "rpy", "status", "tolerance",
    ]  # fmt: skip
    added = "\n".join(line[2:] for line in changed if line[0] == "+")
    assert "measured_on" in added
    before, after = plain(BENCH), plain(text)
    frame = after["frames"].pop("camera")
    former = before["frames"].pop("camera")
    assert before == after
    [earlier] = frame.pop("history")
    assert frame == plain(MEASURED.snippet())["frames"]["camera"]
    assert {**earlier, "parent": "slide"} == former
    assert put(text) == text


def test_each_measurement_moves_the_one_before_it_to_the_head_of_the_history():
    second = replace(MEASURED, measured_on="2026-11-22", position_tolerance_m=1e-4)
    third = replace(second, measured_on="2026-12-24", covariance=tuple([0.0] * 36))
    text = BENCH
    for measured in (MEASURED, second, third):
        found = put_in(Source("calibration_profile.yaml", text), measured)
        assert isinstance(found, str)
        text = found
    history = plain(text)["frames"]["camera"]["history"]
    assert [one.get("measured_on") for one in history] == ["2026-11-22", "2026-11-20", None]
    assert [one["status"] for one in history] == ["measured", "measured", "placeholder"]
    assert history[1] == {
        key: value for key, value in plain(MEASURED.snippet())["frames"]["camera"].items() if key != "parent"
    }
    assert text.count("\n      - {") == 3, "each entry has a line of its own"


def test_an_older_recording_does_not_take_the_place_of_a_newer_one():
    newer = put(BENCH)
    older = put_in(Source("calibration_profile.yaml", newer), replace(MEASURED, measured_on="2026-11-19"))
    assert isinstance(older, Diagnostic)
    assert older.message == "the recording is of 2026-11-19, and `camera` was measured on 2026-11-20"


def test_a_frame_that_hangs_elsewhere_by_now_is_left():
    moved = BENCH.replace("    parent: slide\n", "    parent: world\n", 1)
    found = put_in(Source("calibration_profile.yaml", moved), MEASURED)
    assert isinstance(found, Diagnostic)
    assert "hangs on `world` by now" in found.message


FORMS = {
    "comments inside and behind": (
        "frames:\n  camera:   # the head\n    parent: slide\n    # once\n    position: [1 m, 2 m, 3 m]  # m\n"
        "    status: placeholder # nobody\n    method: >-\n      a long\n      story\n"
        "    tolerance: {position: 1 mm, rotation: 1 deg}  # guess\n# tail\nlimits: []\n"
    ),
    "one line": (
        "frames: {camera: {parent: slide, status: placeholder, method: x, tolerance: "
        "{position: 1 mm, rotation: 1 deg}}, table: {parent: world}}\n"
    ),
    "blocks for lists": (
        "frames:\n    camera:\n        parent: slide\n        tolerance:\n            position: 1 mm\n"
        "            rotation: 1 deg\n        position:\n        - 1 m\n        - 2 m\n        - 3 m\n"
        "        status: measured\n        method: m\n    table:\n        parent: world\n"
    ),
    "a history on one line": (
        "frames:\n  camera:\n    parent: slide # p\n    status: measured\n    history: [] # nothing yet\n"
        "    method: m\n"
    ),
    "a history of one line with an entry": (
        "frames: {camera: {parent: slide, status: measured, history: [{status: estimated}], method: m}}\n"
    ),
    "a history as a block": (
        "frames:\n  camera:\n    parent: slide\n    status: measured\n    history:  # newest first\n"
        "    # the first\n    - status: estimated\n      method: guess\n    - {status: placeholder}\n"
        "    method: m\n"
    ),
    "last in the file, without a line end": (
        "limits: []\nframes:\n  camera:\n    method: m\n    status: measured\n    parent: slide"
    ),
    "line ends of DOS": "frames:\r\n  camera:\r\n    parent: slide # here\r\n    method: m\r\nlimits: []\r\n",
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS.keys())
def test_every_way_of_writing_it_is_kept(text):
    before = plain(text)["frames"]["camera"]
    after = put(text)
    camera = plain(after)["frames"]["camera"]
    history = camera.pop("history", [])
    former = before.pop("history", [])
    assert camera == plain(MEASURED.snippet())["frames"]["camera"]
    if "status" in before:
        assert history == [{key: value for key, value in before.items() if key != "parent"}, *former]
    kept = [line.split("#", 1)[1] for line in text.splitlines() if "#" in line]
    assert [line.split("#", 1)[1] for line in after.splitlines() if "#" in line] == kept
    assert ("\r\n" in text) == ("\r\n" in after)
    assert after.count("\n") - after.count("\r\n") == (0 if "\r\n" in text else after.count("\n"))


@pytest.mark.parametrize(
    "text", ["frames: {}\n", "frames: {camera: 3}\n", "frames: [", "a: 1\n", "frames:\n  camera: {}\n"]
)
def test_what_cannot_be_replaced_is_left(text):
    found = put_in(Source("calibration_profile.yaml", text), MEASURED)
    assert isinstance(found, Diagnostic)
    assert found.code == "XEI0687"


def test_the_tolerance_is_rounded_up_and_says_what_it_is():
    frame = plain(MEASURED.snippet())["frames"]["camera"]
    assert frame["tolerance"] == {"position": "0.2300 mm", "rotation": "0.00573 deg", "as": "std"}
    assert frame["residual"] == {"pixel": 0.21}
    assert frame["covariance"][0] == 5.29e-8


@pytest.mark.parametrize(
    "value",
    [1e-7, -3.25e-12, 0.1 + 0.2, 1 / 3, "", "yes", "1:30", "2026-11-20", "0x1", "a # b", "\u00b5m",
     "\x7f", "- x",
     "{", "3 mm", [1, [2.5, "x"]], {"a": {"b": []}}, True, None],
)  # fmt: skip
def test_values_on_one_line_read_back_as_they_were(value):
    assert plain(f"key: {flow(value)}\n") == {"key": value}
