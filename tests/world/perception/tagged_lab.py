"""The bench with tags on its racks and a head camera that looks at them: a profile of its own."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.world.perception.views import ROOT
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile

# Between and behind the slots, whose mouths are 18 mm wide at 60 mm pitch: x, y and size in mm.
_PLACES = ((-100, 82, 20), (0, 82, 20), (100, 82, 20), (0, 30, 30), (0, -30, 30))
_FIRST = {"rack_1": 20, "rack_2": 30}
_PITCH = "rpy: [0 deg, 40 deg, 0 deg]"
STEEPER = "rpy: [0 deg, 46 deg, 0 deg]"


def write_tagged_lab(folder: Path) -> Path:
    """Copy the bench's profile to `folder`/profiles, with the camera turned down and tags added."""
    target = folder / "profiles" / "openarm_bench"
    shutil.copytree(ROOT / "profiles" / "openarm_bench", target, ignore=shutil.ignore_patterns("*.py"))
    file = target / "calibration_profile.yaml"
    text = file.read_text(encoding="utf-8")
    lines = "".join(
        f"    - {{id: {first + index}, size: {size} mm, frame: {rack}, position: [{x} mm, {y} mm, 70 mm], "
        "rpy: [0 deg, 0 deg, 0 deg]}\n"
        for rack, first in _FIRST.items()
        for index, (x, y, size) in enumerate(_PLACES)
    )
    assert text.count(_PITCH) == 1 and text.count("  minimum_tags: 2\n") == 1
    text = text.replace(_PITCH, STEEPER).replace("  minimum_tags: 2\n", f"{lines}  minimum_tags: 2\n")
    file.write_text(text, encoding="utf-8")
    return target


def tagged_lab(folder: Path) -> Profile:
    profile, said = load_profile(write_tagged_lab(folder), None)
    assert profile is not None, said
    return profile
