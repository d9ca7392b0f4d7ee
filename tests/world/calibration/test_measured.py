"""A transform written into a profile: its values, and nothing else."""

from __future__ import annotations

import difflib

import pytest

from tests.world.perception.views import ROOT
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.world.calibration.measured import Measured, put_in

BENCH = (ROOT / "profiles" / "openarm_bench" / "calibration_profile.yaml").read_text(encoding="utf-8")
MEASURED = Measured(
    "camera", "slide", Pose.from_rpy((0.06421, -0.0031, 0.7968), (0.004, 0.71, -0.012)), "2026-11-20",
    'hand-eye "calibration"', 2.3e-4, 1e-4,
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
    before["frames"].pop("camera")
    assert before == after
    assert frame == plain(MEASURED.snippet())["frames"]["camera"]
    assert put(text) == text


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
    "last in the file, without a line end": (
        "limits: []\nframes:\n  camera:\n    method: m\n    status: measured\n    parent: slide"
    ),
    "line ends of DOS": "frames:\r\n  camera:\r\n    parent: slide # here\r\n    method: m\r\nlimits: []\r\n",
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS.keys())
def test_every_way_of_writing_it_is_kept(text):
    after = put(text)
    assert plain(after)["frames"]["camera"] == plain(MEASURED.snippet())["frames"]["camera"]
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


def test_the_tolerance_is_three_deviations_rounded_up():
    frame = plain(MEASURED.snippet())["frames"]["camera"]
    assert frame["tolerance"] == {"position": "0.690 mm", "rotation": "0.0172 deg"}
