"""Every startup check, by what shows it and what takes it away: the small profile with changes in it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from pathlib import Path

import pytest

from tests.profiles.changed import changed_profile
from xei_lang.doctor import Blocker, deployment_blockers
from xei_lang.doctor.faults import fault_blockers
from xei_lang.profiles.load import load_profile

TODAY = date(2026, 11, 22)
CALIBRATION = "calibration_profile.yaml"
USAGE = "usage_profile.yaml"
BANK = "development_profile.yaml"
TABLE = 'status: placeholder, method: "measure it", tolerance: {position: 3 mm, rotation: 1 deg}}'


@dataclass(frozen=True)
class Check:
    """The lines that show a blocker and those that do not; empty for the small profile as it is."""

    name: str
    shown: str
    gone: str
    code: str
    representation: str
    item: str
    blocks: str


def change(file: str, *lines: tuple[str, str]) -> str:
    return f"{file}\n" + "\n".join(f"- {old}\n+ {new}" for old, new in lines)


def measured(day: str, tolerance: str = "{position: 3 mm, rotation: 1 deg}") -> tuple[str, str]:
    at = f"measured_on: {day}, " if day else ""
    return TABLE, f'status: measured, {at}method: "with a ruler", tolerance: {tolerance}}}'


def tray(day: str) -> tuple[str, str]:
    return (
        "  table: {parent: world",
        f'  tray: {{parent: table, status: measured, measured_on: {day}, method: "m", tolerance: '
        "{position: 1 mm, rotation: 1 deg}}\\n  table: {parent: world",
    )


AGE = ("spill_tilt: 8 deg", "spill_tilt: 8 deg\\nmax_age: 90 d")
HEIGHT = "table: {height: 750 mm, status: measured"
CAMERAS = (
    "spill_tilt: 8 deg",
    "spill_tilt: 8 deg\\ncameras:\\n  eye: {frame: camera, status: measured, intrinsics: {fx: 900, fy: 900, "
    "cx: 640, cy: 360, width: 1280, height: 720, distortion: []}, "
    "topics: {rgb: /rgb, depth: /depth, info: INFO}}",
)
WORKSPACE = ("workspace: {lower: [0 m, -1 m, 0 m], upper: [1 m, 1 m, 2 m]}",
             "workspace: {lower: [0.1 m, 0 m, 0.7 m], upper: [0.5 m, 0.3 m, 1.7 m]}")  # fmt: skip
WARM = (
    "\\n  warm:\\n    owner: slide\\n    summary: Warm a block.\\n    args:\\n"
    "      block: {type: object, roles: ROLE}\\n      height: {type: Length, min: 0 mm, max: 600 mm}\\n"
    "    exposed: true\\n    duration: 0 s .. 10 s\\n    process: Stand by.\\n"
    "    template: [{slide_move: {height: height}}]"
)
SKILLS = ("template: [{slide_move: {height: height}}]", "template: [{slide_move: {height: height}}]")
TIGHT = "{position: 0.1 mm, rotation: 0 deg}"
DOCKED = ("docking: {position: 80 mm, rotation: 0.15 rad,", "docking: {position: 0.1 mm, rotation: 0 rad,")

CHECKS = [
    Check(
        "a placeholder", "", change(CALIBRATION, measured("2026-11-01")),
        "XEI0670", "calibration_profile", "frames.table", "strict",
    ),
    Check(
        "a measurement without a date",
        change(CALIBRATION, measured("")), change(CALIBRATION, measured("2026-11-01")),
        "XEI0671", "calibration_profile", "frames.table", "hardware",
    ),
    Check(
        "a measurement before that of what it hangs on",
        change(CALIBRATION, measured("2026-11-01"), tray("2026-10-31")),
        change(CALIBRATION, measured("2026-11-01"), tray("2026-11-01")),
        "XEI0671", "calibration_profile", "frames.tray", "hardware",
    ),
    Check(
        "a measurement that is too old",
        change(CALIBRATION, measured("2026-08-23"), AGE), change(CALIBRATION, measured("2026-08-24"), AGE),
        "XEI0671", "calibration_profile", "frames.table", "hardware",
    ),
    Check(
        "a measurement of tomorrow",
        change(CALIBRATION, measured("2026-11-23")), change(CALIBRATION, measured("2026-11-22")),
        "XEI0671", "calibration_profile", "frames.table", "hardware",
    ),
    Check(
        "a frame without a way to the root",
        change(CALIBRATION, ("parent: slide", "parent: neck")), "",
        "XEI0630", "calibration_profile", "`neck` is not a frame of this profile", "simulate",
    ),
    Check(
        "a table whose height nobody measured",
        change(CALIBRATION, (HEIGHT, HEIGHT.replace("measured", "placeholder"))), "",
        "XEI0670", "calibration_profile", "table", "strict",
    ),
    Check(
        "a sensor without topics", "",
        change(CALIBRATION, (CAMERAS[0], CAMERAS[1].replace("INFO", "/info"))),
        "XEI0689", "calibration_profile", "cameras", "hardware",
    ),
    Check(
        "a topic that is none",
        change(CALIBRATION, (CAMERAS[0], CAMERAS[1].replace("INFO", "camera//info"))),
        change(CALIBRATION, (CAMERAS[0], CAMERAS[1].replace("INFO", "/info"))),
        "XEI0689", "calibration_profile", "cameras.eye.topics.info", "hardware",
    ),
    Check(
        "an object whose skill the bank lacks",
        change(USAGE, ("skills: [pick]", "skills: [pick, warm]")), "",
        "XEI0620", "usage_profile", "`warm` is not a skill of this profile", "simulate",
    ),
    Check(
        "a skill whose roles no object has",
        change(BANK, (SKILLS[0], SKILLS[1] + WARM.replace("ROLE", "heater"))),
        change(BANK, (SKILLS[0], SKILLS[1] + WARM.replace("ROLE", "tube_rack"))),
        "XEI0674", "development_profile", "skills.warm.args.block", "hardware",
    ),
    Check(
        "bounds that no hand comes to", "", change(CALIBRATION, WORKSPACE),
        "XEI0675", "calibration_profile", "workspace.upper.x", "hardware",
    ),
    Check(
        "a limit above the motor's rating",
        change(CALIBRATION, ("velocity: 2.5 rad/s", "velocity: 25 rad/s")), "",
        "XEI0651", "calibration_profile", "the velocity limit of `elbow` does not fit the robot", "simulate",
    ),
    Check(
        "an object that nothing places",
        change(USAGE, ("    prior: {in: 'table.spot(\"cup\")', confidence: 0.6}", "    mass: 1 g")), "",
        "XEI0673", "usage_profile", "objects.cup.prior", "simulate",
    ),
    Check(
        "a place known worse than its gap", "",
        change(CALIBRATION, measured("2026-11-01", TIGHT), DOCKED),
        "XEI0676", "world", "slots.rack", "hardware",
    ),
    Check(
        "a place known worse than its gap, as three standard deviations",
        change(CALIBRATION, measured("2026-11-01", "{position: 0.6 mm, rotation: 0 deg, as: std}"), DOCKED),
        change(CALIBRATION, measured("2026-11-01", "{position: 0.6 mm, rotation: 0 deg, as: bound}"), DOCKED),
        "XEI0676", "world", "slots.rack", "hardware",
    ),
    Check(
        "a map that is not there",
        change(CALIBRATION, ("yaml: null, image: null, sha256: null, status: placeholder",
                             f"yaml: m.yaml, image: m.pgm, sha256: {'ab' * 32}, status: estimated")), "",
        "XEI0665", "calibration_profile", "map", "hardware",
    ),
]  # fmt: skip


def found(folder: Path, edit: str) -> dict[str, Blocker]:
    folder.mkdir()
    lab = changed_profile(folder, edit or CALIBRATION)
    profile, said = load_profile(lab, None)
    blockers = fault_blockers(said) if profile is None else deployment_blockers(profile, TODAY)
    return {f"{one.code} {one.item}": one for one in blockers}


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.name)
def test_a_check_blocks_until_it_is_mended(check: Check, tmp_path: Path) -> None:
    key = f"{check.code} {check.item}"
    shown = found(tmp_path / "shown", check.shown)
    assert key in shown, list(shown)
    blocker = shown[key]
    assert (blocker.representation, blocker.blocks) == (check.representation, check.blocks)
    assert blocker.measure and blocker.write_to
    assert key not in found(tmp_path / "gone", check.gone)


def test_models_of_objects_block_until_they_are_there(tmp_path: Path) -> None:
    shown = found(tmp_path / "shown", "")
    assert shown["XEI0672 objects.cup.assets.mesh"].blocks == "hardware"
    assert (
        shown["XEI0672 objects.cup.assets.point_cloud"].write_to == f"{USAGE}:objects.cup.assets.point_cloud"
    )


def test_without_a_day_nothing_is_too_old(tmp_path: Path) -> None:
    lab = changed_profile(tmp_path, change(CALIBRATION, measured("2001-01-01"), AGE))
    profile, said = load_profile(lab, None)
    assert profile is not None, said
    assert "frames.table" not in {one.item for one in deployment_blockers(profile)}
    assert "frames.table" in {one.item for one in deployment_blockers(profile, TODAY)}
