"""Recordings of scans that are not what they should be, and where they say so."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tests.world.bench import BENCH, bench
from tests.world.map.lab import loaded
from tests.world.map.ranging import recorded
from xei_lang.diagnostics import Diagnostics, Source
from xei_lang.world.map.build_map import build_map
from xei_lang.world.map.recording import MAX_FAULTS, read_scans

HEAD, *LINES = recorded(4).splitlines()


def told(text: str, profile=None) -> Diagnostics:
    scans, said = read_scans(Source("drive.jsonl", text), profile or bench())
    assert (scans is None) == bool(said)
    for one in said:
        assert one.code == "XEI0667"
        if one.span is not None and one.span.file == "drive.jsonl":
            assert 0 <= one.span.start <= one.span.end <= len(text)
    return said


def with_scan(**changed: object) -> str:
    line = {**json.loads(LINES[1]), **changed}
    return "\n".join([HEAD, LINES[0], json.dumps(line), *LINES[2:]])


def with_head(**changed: object) -> str:
    return "\n".join([json.dumps({**json.loads(HEAD), **changed}), *LINES])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("\n\n", "is empty"),
        (HEAD, "has no scan"),
        (HEAD + "\nnonsense", "line 2 is no JSON object"),
        (HEAD + "\n[1, 2]", "line 2 is no JSON object"),
        (HEAD + '\n{"stamp_s": 0, "base": [0, 0, NaN], "ranges_m": [1]}', "`base` must be a finite number"),
        (with_head(version=2), "version 2"),
        (with_head(lidar="bse"), "no lidar `bse`"),
        (with_head(recorded_on="yesterday"), "`yesterday` must be a day"),
        (with_head(range_min_m=20.0), "no range"),
        (with_head(angle_increment_rad=0.0), "one direction"),
        (with_head(stray=1), "`stray` is not a key"),
        (with_scan(base=[0.0, 0.0]), "`base`"),
        (with_scan(base=[0.0, 0.0, 90.0]), "yaw of 90"),
        (with_scan(base=[1e6, 0.0, 0.0]), "10 km"),
        (with_scan(ranges_m=[1.0]), "has 1 ranges, not 360"),
        (with_scan(ranges_m=[-1.0] * 360), "`ranges_m`"),
        (with_scan(ranges_m=["far"] * 360), "`ranges_m`"),
        (with_scan(stamp_s=99.0), "taken before"),
    ],
)
def test_what_is_wrong_is_told(text: str, message: str) -> None:
    said = told(text)
    assert any(message in one.message for one in said), [one.message for one in said]


def test_a_fault_points_at_its_own_line() -> None:
    text = with_scan(base=[0.0, 0.0, 90.0])
    [one] = told(text)
    assert one.span is not None
    assert text[: one.span.start].count("\n") == 2
    [one] = told(with_head(stray=1))
    assert one.span is not None and with_head(stray=1)[one.span.start : one.span.end] == '"stray"'


def test_only_the_first_faults_are_told() -> None:
    assert len(told("\n".join([HEAD, *["nonsense"] * 500]))) == MAX_FAULTS


def test_a_recording_without_echoes_or_of_a_whole_town_is_no_map() -> None:
    scans, said = read_scans(Source("drive.jsonl", HEAD + "\n" + LINES[0]), bench())
    assert scans is not None, said
    scans.ranges_m[:] = float("nan")
    assert "echo" in getattr(build_map(scans, 0.05), "message", "")
    far = with_scan(base=[5000.0, 5000.0, 0.0])
    scans, said = read_scans(Source("drive.jsonl", far), bench())
    assert scans is not None, said
    assert "too large" in getattr(build_map(scans, 0.05), "message", "")


PARENT = "    parent: robot_base\n    position: [0.30 m"
PLACE = "position: [0.30 m, 0 m, 0.20 m]"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (PARENT, PARENT.replace("robot_base", "slide"), "not fixed"),
        (PARENT, PARENT.replace("robot_base", "world"), "not fixed"),
        (PLACE, PLACE + "\n    rpy: [0 deg, 20 deg, 0 deg]", "tilted by 20 deg"),
        (PLACE, PLACE + "\n    rpy: [180 deg, 0 deg, 0 deg]", "tilted by 180 deg"),
    ],
)
def test_a_lidar_that_is_not_level_on_the_base_maps_no_floor(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    lab = Path(shutil.copytree(BENCH, tmp_path / "lab"))
    file = lab / "calibration_profile.yaml"
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    [one] = told(recorded(4), loaded(lab))
    assert message in one.message
