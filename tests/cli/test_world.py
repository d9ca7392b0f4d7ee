"""`xei world`, and `--world` of the commands that ground the world."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, PROTOCOLS, Ran, xei
from tests.world.bench import bench
from tests.world.sources.scenes import scene

MOVED = (
    "rack_1: {frame: table, position: [140 mm, -135 mm, 0 mm], "
    "rpy: [0 deg, 0 deg, -90 deg], confidence: 0.95}"
)


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "monday.yaml").write_text(scene(MOVED), encoding="utf-8")
    return tmp_path


def test_a_table_lists_every_object(lab: Path):
    ran = xei("world", "show", cwd=lab)
    assert ran.code == 0
    head, *rows = ran.out.splitlines()
    assert head.split()[:2] == ["object", "place"]
    assert [row.split()[0] for row in rows] == sorted(item.name for item in bench().objects)


def test_a_scene_file_shows_in_every_form(lab: Path):
    table = xei("world", "show", "--world", "monday.yaml", cwd=lab)
    (rack,) = [line for line in table.out.splitlines() if line.startswith("rack_1 ")]
    assert "(140, -135, 0) mm yaw -90 deg" in rack
    assert "scene_file monday.yaml" in rack
    form = json.loads(xei("world", "show", "--world", "monday.yaml", "--format", "json", cwd=lab).out)
    assert form["sources"][-1] == "scene_file monday.yaml"
    assert form["reach"]["rack_1"]["bench_a"] == ["left", "right"]
    written = xei("world", "show", "--world", "monday.yaml", "--format", "scene", "-o", "again.yaml", cwd=lab)
    assert (written.code, written.out) == (0, "")
    again = xei("world", "show", "--world", "again.yaml", cwd=lab)
    assert [line[:70] for line in again.out.splitlines()] == [line[:70] for line in table.out.splitlines()]


def test_the_drawing_has_each_object_where_it_is(lab: Path):
    drawn = ET.fromstring(xei("world", "show", "--world", "monday.yaml", "--format", "svg", cwd=lab).out)
    space = "{http://www.w3.org/2000/svg}"
    names = [item.text for item in drawn.iter(f"{space}text")]
    assert {item.name for item in bench().objects} - {"floor"} <= set(names)
    (rack,) = [item for item in drawn if (item.findtext(f"{space}title") or "").startswith("rack_1:")]
    assert rack.get("class") == "seen"
    corners = [tuple(map(float, point.split(","))) for point in (rack.get("points") or "").split()]
    middle = [sum(values) / 4 for values in zip(*corners, strict=True)]
    table = bench().calibration.frames
    x = next(frame for frame in table if frame.name == "table").T_parent_frame.position_m[0]
    assert middle == pytest.approx([135.0, -(x * 1000 + 140.0)])


def test_where_says_who_said_it_and_how_well_it_is_known(lab: Path):
    ran = xei("world", "where", "sample tube 1", "--world", "monday.yaml", cwd=lab)
    assert ran.code == 0
    assert ran.out.startswith('tube_1 ("sample tube 1")\n  stands in rack_1.slot("A1")\n')
    assert re.search(r"pose +usage_profile prior, moved with rack_1\n", ran.out)
    assert re.search(
        r"by robot_base > world > table, placeholder, good to [\d.]+ mm and [\d.]+ deg\n", ran.out
    )


def test_where_says_what_each_link_adds(lab: Path):
    ran = xei("world", "where", "tube_1", cwd=lab)
    docked = re.search(r"\n +robot_base +80 mm and 8.59 deg over [\d.]+ mm: bound of ([\d.]+) mm\n", ran.out)
    table = re.search(r"\n +table +3 mm and 0.5 deg over [\d.]+ mm: bound of ([\d.]+) mm\n", ran.out)
    whole = re.search(r"good to ([\d.]+) mm and", ran.out)
    assert docked and table and whole
    assert float(docked[1]) + float(table[1]) == pytest.approx(float(whole[1]), abs=0.15)


def test_where_tells_of_frames_too(lab: Path):
    camera = xei("world", "where", "camera", "--history", cwd=lab)
    assert camera.code == 0
    assert camera.out.startswith("camera, a frame\n  in slide: ")
    assert "by robot_base > slide > camera, placeholder, good to 2 mm and 0.3 deg\n" in camera.out
    assert camera.out.endswith("  never measured anew\n")
    base = xei("world", "where", "robot_base", cwd=lab)
    assert "docked at bench_a, good to 80 mm and 8.59 deg" in base.out
    near = xei("world", "where", "camra", cwd=lab)
    assert near.code == 2 and "did you mean `camera`?" in near.err


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("tub_1", "did you mean `tube_1`?"),
        ("beakr", "did you mean `beaker_1` or `beaker_2` or `beaker_3`?"),
        ("waste beakr", "did you mean `waste beaker`?"),
        ("centrifuge", "`xei world show` lists all objects"),
    ],
)
def test_where_of_an_unknown_name_offers_near_ones(lab: Path, name: str, hint: str):
    ran = xei("world", "where", name, cwd=lab)
    assert ran.code == 2
    assert f"has no object or frame `{name}`; {hint}" in ran.err


def compile_(lab: Path, world: str, *more: str) -> Ran:
    return xei(
        "compile", str(PROTOCOLS / "put_on_rack.xei"), "--emit", "goals", "--world", world, *more, cwd=lab
    )


@pytest.mark.parametrize(
    ("world", "code", "said"),
    [
        ("nowhere.yaml", 2, "XEI0101"),
        ("http://127.0.0.1:1", 1, "XEI0663"),
        ("ftp://bench/scene.yaml", 1, "XEI0663"),
        ("bad.yaml", 1, "XEI0658"),
        ("unsure.yaml", 1, "XEI0661"),
    ],
)
def test_a_source_that_cannot_be_used_is_not_replaced_by_another(lab: Path, world: str, code: int, said: str):
    bad = "beaker_1: {frame: table, position: [120 mm, -135 mm, 0 mm], confidence: 0.9}"
    (lab / "bad.yaml").write_text(scene(bad), encoding="utf-8")
    (lab / "unsure.yaml").write_text(scene("tube_1: {confidence: 0.3}"), encoding="utf-8")
    ran = compile_(lab, world)
    assert (ran.code, ran.out) == (code, "")
    assert f"error[{said}]" in ran.err


def test_a_picture_is_for_a_pose_service(lab: Path):
    ran = compile_(lab, "monday.yaml", "--picture", "picture.json")
    assert ran.code == 1
    assert "`--picture` is for a pose service, and `--world` names `monday.yaml`" in ran.err


def test_what_is_not_in_the_scene_keeps_its_prior(lab: Path):
    ran = compile_(lab, "monday.yaml")
    assert ran.code == 0, ran.err
    assert ran.out != compile_(lab, "profile").out


def test_sources_are_asked_in_their_order_and_a_later_one_overrides_field_by_field(lab: Path):
    unsure, open_ = "rack_1: {confidence: 0.7}", "tube_1: {states: {cap: open}}"
    (lab / "tuesday.yaml").write_text(scene(f"{unsure}\n{open_}"), encoding="utf-8")

    def rack(*files: str):
        worlds = [word for file in files for word in ("--world", file)]
        ran = xei("world", "show", "--format", "json", *worlds, cwd=lab)
        assert ran.code == 0, ran.err
        world = json.loads(ran.out)
        (found,) = [item for item in world["objects"] if item["name"] == "rack_1"]
        return world["sources"], found["confidence"], found["provenance"]

    sources, confidence, said_by = rack("profile", "monday.yaml", "tuesday.yaml")
    assert sources[2:] == ["scene_file monday.yaml", "scene_file tuesday.yaml"]
    assert (confidence, said_by["confidence"]) == (0.7, "scene_file tuesday.yaml")
    assert said_by["pose"] == "scene_file monday.yaml"
    _, confidence, said_by = rack("tuesday.yaml", "monday.yaml")
    assert (confidence, said_by["confidence"]) == (0.95, "scene_file monday.yaml")


def test_two_sources_of_one_name_are_refused(lab: Path):
    (lab / "old").mkdir()
    (lab / "old" / "monday.yaml").write_text(scene(MOVED), encoding="utf-8")
    for second in ("monday.yaml", "old/monday.yaml"):
        ran = compile_(lab, "monday.yaml", "--world", second)
        assert (ran.code, "error[XEI0663]" in ran.err) == (1, True), ran.err
