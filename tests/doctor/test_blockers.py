"""What blocks a profile: the bench as it is, and copies of it that were changed."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES
from tests.profiles.assets.bodies import cylinder, stl
from xei_lang.doctor import Blocker, deployment_blockers
from xei_lang.doctor.faults import fault_blockers
from xei_lang.doctor.forms import to_text
from xei_lang.doctor.reach import tool_bounds
from xei_lang.profiles.load import load_profile
from xei_lang.profiles.model import Profile

BENCH = PROFILES / "openarm_bench"
Change = Callable[[str, str, str], None]


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    return Path(shutil.copytree(BENCH, tmp_path / "lab"))


@pytest.fixture
def change(lab: Path) -> Change:
    def replace(file: str, old: str, new: str) -> None:
        text = (lab / file).read_text(encoding="utf-8")
        assert old in text
        (lab / file).write_text(text.replace(old, new, 1), encoding="utf-8")

    return replace


def loaded(folder: Path) -> Profile:
    profile, said = load_profile(folder, None)
    assert profile is not None, said
    return profile


def found(folder: Path) -> dict[str, Blocker]:
    return {blocker.item: blocker for blocker in deployment_blockers(loaded(folder))}


def test_nothing_blocks_the_bench_in_simulation_and_placeholders_block_a_strict_compilation() -> None:
    stages = {blocker.item: blocker.blocks for blocker in deployment_blockers(loaded(BENCH))}
    assert "simulate" not in stages.values()
    assert stages["frames.table"] == "strict"
    assert stages["objects.tube_1.assets.mesh"] == "hardware"


def test_each_blocker_says_what_to_do_and_where_to_write_it() -> None:
    for blocker in deployment_blockers(loaded(BENCH)):
        assert blocker.measure
        file, colon, item = blocker.write_to.partition(":")
        assert colon and item
        assert (BENCH / file).is_file()


def test_a_frame_that_was_measured_before_the_one_it_hangs_on_is_stale(lab: Path, change: Change) -> None:
    way = '    method: "our choice of layout; measure with the table\'s AprilTags from bench_a"'
    old = f"    status: placeholder\n{way}"
    change("calibration_profile.yaml", old, f'    status: measured\n    measured_on: "2026-11-20"\n{way}')
    tray = """
frames:
  tray:
    parent: table
    position: [0.1 m, 0 m, 0 m]
    status: measured
    measured_on: "{day}"
    method: "with a ruler"
    tolerance: {{position: 1 mm, rotation: 0.2 deg}}
"""
    change("calibration_profile.yaml", "\nframes:\n", tray.format(day="2026-11-19"))
    stale = found(lab)["frames.tray"]
    assert (stale.code, stale.status, stale.blocks) == ("XEI0671", "stale", "hardware")
    assert "2026-11-20" in stale.measure
    change("calibration_profile.yaml", '"2026-11-19"', '"2026-11-20"')
    assert "frames.tray" not in found(lab)


def test_a_named_asset_that_is_not_there_is_missing_as_well(lab: Path, change: Change) -> None:
    tube = '    aliases: ["sample tube 6"]\n'
    files = "{mesh: {file: assets/tube.stl, units: mm}, point_cloud: {file: assets/tube.xyz, units: mm}}"
    change("usage_profile.yaml", tube, f"{tube}    assets: {files}\n")
    assert "there is no `assets/tube.stl`" in found(lab)["objects.tube_6.assets.mesh"].measure
    (lab / "assets").mkdir()
    (lab / "assets" / "tube.stl").write_bytes(stl(cylinder(17.0, 118.0)))
    items = found(lab)
    assert "objects.tube_6.assets.mesh" not in items
    assert "objects.tube_6.assets.point_cloud" in items


def test_the_bounds_of_the_tools_hold_every_point_that_the_arms_come_to() -> None:
    import numpy as np

    from xei_lang.motion.robot import load_robot
    from xei_lang.profiles.open import robot_texts

    profile = loaded(BENCH)
    robot = load_robot(*robot_texts(profile))
    bounds = tool_bounds(profile)
    assert bounds is not None
    lower, upper = (np.array(side) for side in bounds)
    random = np.random.default_rng(1)
    for q in random.uniform(robot.lower, robot.upper, size=(300, robot.nq)):
        for arm in robot.arms.values():
            point = robot.T_base_frame(q, arm.tool_frame)[:3, 3]
            assert np.all(lower <= point) and np.all(point <= upper)


def test_errors_of_a_profile_are_blockers_of_the_file_that_has_them(lab: Path, change: Change) -> None:
    change("calibration_profile.yaml", "payload: 1 kg", "payload: 1 m")
    profile, said = load_profile(lab, None)
    assert profile is None
    [fault] = fault_blockers(said)
    assert (fault.representation, fault.blocks, fault.status) == ("calibration_profile", "simulate", "error")


def test_the_text_counts_what_stands_before_each_stage() -> None:
    def blocker(blocks: str) -> Blocker:
        return Blocker("XEI0670", "usage_profile", blocks, "missing", blocks, "look", "usage_profile.yaml:x")  # type: ignore[arg-type]

    text = to_text("lab", [blocker("hardware"), blocker("strict")], {})
    assert text.splitlines()[-3:] == [
        "lab: nothing before simulation",
        "lab: 1 blocker before a strict compilation",
        "lab: 2 blockers before a run on hardware",
    ]
    assert to_text("lab", [], {}) == "lab: nothing stands in the way\n"


def test_a_camera_needs_all_its_topics_and_a_robot_its_sensors(lab: Path, change: Change) -> None:
    text = (lab / "calibration_profile.yaml").read_text(encoding="utf-8")
    [topics] = [line for line in text.splitlines() if line.startswith("    topics: {rgb:")]
    change("calibration_profile.yaml", topics, "    topics: {rgb: /camera/color, depth: camera//depth}")
    change("calibration_profile.yaml", text[text.index("\nlidars:") :], "\n")
    told = {item: (one.status, one.blocks) for item, one in found(lab).items() if one.code == "XEI0689"}
    assert told == {
        "cameras.head.topics.depth": ("no topic", "hardware"),
        "cameras.head.topics.info": ("missing", "hardware"),
        "lidars": ("missing", "hardware"),
    }
