"""The bench with a second camera: it hangs over the first table, and does not move."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.world.perception.views import ROOT
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile

CEILING = Pose.from_rpy((0.78, 0.02, 1.80), (0.0, 1.5707963267948966, 0.0))
"""Where it is in the world: 1.05 m above the table, and looking straight down."""

_FRAME = """  ceiling:
    parent: world
    position: [0.78 m, 0.02 m, 1.80 m]
    rpy: [0 deg, 90 deg, 0 deg]
    method: "where it was hung; to be solved from a board in the hand"
    status: placeholder
    tolerance: {position: 2 mm, rotation: 0.3 deg}
"""
_CAMERA = """  ceiling:
    frame: ceiling
    status: placeholder
    intrinsics: {fx: 920, fy: 920, cx: 640, cy: 360, width: 1280, height: 720, distortion: [0, 0, 0, 0, 0]}
    topics: {rgb: /ceiling/rgb, depth: /ceiling/depth, info: /ceiling/info}
"""


def write_two_cameras(folder: Path) -> Path:
    """Copy the bench's profile to `folder`/profiles, with the camera `ceiling` added."""
    target = folder / "profiles" / "openarm_bench"
    shutil.copytree(ROOT / "profiles" / "openarm_bench", target, ignore=shutil.ignore_patterns("*.py"))
    file = target / "calibration_profile.yaml"
    text = file.read_text(encoding="utf-8")
    for before, added in (("\n  lidar:\n    parent", _FRAME), ("\nlidars:\n", _CAMERA)):
        assert text.count(before) == 1
        text = text.replace(before, f"\n{added.rstrip()}{before}")
    file.write_text(text, encoding="utf-8")
    return target


def two_cameras(folder: Path) -> Profile:
    profile, said = load_profile(write_two_cameras(folder), None)
    assert profile is not None, said
    return profile
