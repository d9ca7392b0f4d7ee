"""The map of a deployment against its stations and drives."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.world.map.lab import loaded, mapped_lab, room, with_box
from xei_lang.doctor import deployment_blockers
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground
from xei_lang.world.map.deployed import MapFindings, look_at_map


def found(profile: Profile) -> MapFindings:
    world, _ = ground(profile)
    assert world is not None
    return look_at_map(profile, world)


def map_blockers(profile: Profile) -> dict[str, tuple[str, str, str]]:
    return {
        one.item: (one.code, one.status, one.blocks)
        for one in deployment_blockers(profile)
        if one.code in ("XEI0665", "XEI0666", "XEI0677", "XEI0678", "XEI0679")
    }


def test_drives_over_free_floor_are_straight(tmp_path: Path) -> None:
    profile = loaded(mapped_lab(tmp_path, room()))
    seen = found(profile)
    assert seen.faults == ()
    assert [(one.start, one.goal) for one in seen.drives] == [("bench_a", "bench_b"), ("bench_b", "bench_a")]
    for drive in seen.drives:
        assert drive.length_m == pytest.approx(2.2)
        assert drive.turn_rad == pytest.approx(math.pi / 2)
    assert map_blockers(profile) == {}
    assert "map" not in {one.item for one in profile.calibration.placeholders}


def test_a_box_in_the_way_is_driven_around(tmp_path: Path) -> None:
    grid = with_box(room(lower=(-2.5, -3.5), upper=(1.5, 1.5)), (-0.2, 0.2), (-1.3, -1.0))
    drive = found(loaded(mapped_lab(tmp_path, grid))).drives[0]
    assert 2.3 < drive.length_m < 3.5
    assert drive.poses[0] == pytest.approx((0, 0, 0))
    assert drive.poses[-1] == pytest.approx((0, -2.2, -math.pi / 2))


def test_a_station_on_something_is_a_blocker_with_its_place(tmp_path: Path) -> None:
    lab = mapped_lab(tmp_path, with_box(room(), (0.3, 0.6), (-0.1, 0.1)))
    profile = loaded(lab)
    [fault] = found(profile).faults
    assert (fault.item, fault.status) == ("stations.bench_a", "occupied")
    assert found(profile).drives == ()
    [said] = fault.diagnostics
    text = (lab / "calibration_profile.yaml").read_text(encoding="utf-8")
    assert said.span is not None and text[said.span.start : said.span.end] == "bench_a"
    assert map_blockers(profile) == {"stations.bench_a": ("XEI0677", "occupied", "hardware")}


def test_a_station_where_nobody_has_looked_is_a_blocker(tmp_path: Path) -> None:
    profile = loaded(mapped_lab(tmp_path, room(lower=(-1.5, -2.0))))
    assert map_blockers(profile) == {"stations.bench_b": ("XEI0677", "occupied", "hardware")}
    grid = with_box(room(), (-0.05, 0.0), (-2.5, -2.45), value=-1)
    profile = loaded(mapped_lab(tmp_path / "other", grid))
    assert map_blockers(profile) == {"stations.bench_b": ("XEI0677", "unknown", "hardware")}


def test_a_wall_leaves_no_way(tmp_path: Path) -> None:
    profile = loaded(mapped_lab(tmp_path, with_box(room(), (-1.5, 1.5), (-1.2, -1.1))))
    assert map_blockers(profile) == {"drives.bench_a.bench_b": ("XEI0678", "no way", "hardware")}


def test_a_gap_that_the_base_does_not_fit_through_is_no_way(tmp_path: Path) -> None:
    narrow = with_box(with_box(room(), (-1.5, -0.25), (-1.2, -1.1)), (0.25, 1.5), (-1.2, -1.1))
    assert "drives.bench_a.bench_b" in map_blockers(loaded(mapped_lab(tmp_path / "a", narrow)))
    wide = with_box(with_box(room(), (-1.5, -0.45), (-1.2, -1.1)), (0.45, 1.5), (-1.2, -1.1))
    assert map_blockers(loaded(mapped_lab(tmp_path / "b", wide))) == {}


@pytest.mark.parametrize("file", ["lab.yaml", "lab.pgm"])
def test_files_that_are_gone_or_changed_are_told(tmp_path: Path, file: str) -> None:
    lab = mapped_lab(tmp_path, room())
    path = lab / "map" / file
    data = path.read_bytes()
    path.write_bytes(data + b"\n")
    profile = loaded(lab)
    assert map_blockers(profile) == {"map.sha256": ("XEI0666", "another map", "hardware")}
    [said] = found(profile).diagnostics
    assert any("sha256: " in line for line in said.help)
    path.unlink()
    assert map_blockers(loaded(lab)) == {"map": ("XEI0665", "missing", "hardware")}


def test_no_map_is_a_placeholder_and_nothing_else() -> None:
    from tests.world.bench import bench

    assert found(bench()) == MapFindings(None, (), ()) or found(bench()).faults == ()
    assert map_blockers(bench()) == {}
