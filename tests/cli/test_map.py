"""`xei map`: scans to a map, the map into the profile, and what it shows."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import pytest
import yaml
from PIL import Image

from tests.cli.xei import PROFILES, xei
from tests.world.map.ranging import recorded
from xei_lang.profiles.load import load_profile


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    shutil.copytree(PROFILES, tmp_path / "profiles")
    (tmp_path / "drive.jsonl").write_text(recorded(200, noise_m=0.01), encoding="utf-8")
    return tmp_path


def put_in(lab: Path, lines: str) -> None:
    """Replace the section `map` of the profile by these lines."""
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    text = file.read_text(encoding="utf-8")
    start, end = text.index("\nmap:\n") + 1, text.index("\napriltags:\n")
    file.write_text(text[:start] + lines + text[end:], encoding="utf-8")


def test_a_recording_becomes_the_map_that_the_profile_names(lab: Path) -> None:
    folder = lab / "profiles" / "openarm_bench" / "map"
    ran = xei("map", "build", "drive.jsonl", "-o", str(folder), cwd=lab)
    assert ran.code == 0, ran.err
    assert "200 scans" in ran.err
    written = (folder / "lab.yaml").read_bytes(), (folder / "lab.pgm").read_bytes()
    section = yaml.safe_load(ran.out)["map"]
    assert section == {
        "frame": "map",
        "yaml": "map/lab.yaml",
        "image": "map/lab.pgm",
        "sha256": hashlib.sha256(written[0] + written[1]).hexdigest(),
        "status": "measured",
        "measured_on": "2026-11-20",
    }
    again = xei("map", "build", "drive.jsonl", "-o", str(folder), "--quiet", cwd=lab)
    assert (again.out, again.err) == (ran.out, "")
    assert written == ((folder / "lab.yaml").read_bytes(), (folder / "lab.pgm").read_bytes())

    put_in(lab, ran.out)
    shown = xei("map", "show", "-o", "lab.png", cwd=lab)
    # The room of the recording is not the bench's: at bench_a the map has a table's legs.
    assert "station bench_a: at 0.00, 0.00 m, 0 deg; below the base" in shown.out
    assert "station bench_b: at 0.00, -2.20 m, -90 deg; below the base free" in shown.out
    with Image.open(lab / "lab.png") as drawn:
        assert drawn.format == "PNG" and min(drawn.size) > 100
    found = json.loads(xei("doctor", "--format", "json", cwd=lab).out)["blockers"]
    assert "map" not in {one["item"] for one in found}
    assert {one["item"] for one in found if one["code"] == "XEI0677"} == {
        line.split()[1].rstrip(":").join(("stations.", ""))
        for line in shown.out.splitlines()
        if line.startswith("station") and not line.endswith(" free")
    }
    assert shown.code == (1 if any(one["code"] == "XEI0677" for one in found) else 0)


def test_a_bench_without_a_map_has_none_to_show(lab: Path) -> None:
    ran = xei("map", "show", cwd=lab)
    assert (ran.code, ran.out) == (1, "")
    assert "has no map" in ran.err and "xei map build" in ran.err


def test_a_map_with_a_gap_is_told_what_it_lacks(lab: Path) -> None:
    path = next((lab / "profiles").glob("*/calibration_profile.yaml"))
    text = path.read_text(encoding="utf-8")
    assert text.count("yaml: null") == 1
    path.write_text(text.replace("yaml: null", "yaml: map/lab.yaml"), encoding="utf-8")
    ran = xei("map", "show", cwd=lab)
    assert ran.code == 1
    assert "has `map` without `image` and `sha256`" in ran.err


def test_files_of_another_map_are_told_with_their_hash(lab: Path) -> None:
    folder = lab / "profiles" / "openarm_bench" / "map"
    put_in(lab, xei("map", "build", "drive.jsonl", "-o", str(folder), cwd=lab).out)
    (folder / "lab.pgm").write_bytes((folder / "lab.pgm").read_bytes()[:-1] + b"\x00")
    ran = xei("map", "show", cwd=lab)
    assert ran.code == 1
    assert "XEI0666" in ran.err


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (("nowhere.jsonl", "-o", "out"), 2, "does not exist"),
        (("drive.jsonl",), 2, "--output"),
        (("drive.jsonl", "--write", "-o", "out"), 2, "a folder of the profile"),
        (("drive.jsonl", "-o", "out", "--resolution", "0"), 2, "--resolution"),
        (("drive.jsonl", "-o", "out", "--name", "../lab"), 2, "without folders"),
        (("profiles", "-o", "out"), 1, "rosbag2"),
        (("bad.jsonl", "-o", "out"), 1, "XEI0667"),
        (("binary.jsonl", "-o", "out"), 1, "UTF-8"),
        (("drive.jsonl", "-o", "drive.jsonl"), 2, "cannot be written"),
    ],
)
def test_what_cannot_be_built_from_is_told(
    lab: Path, arguments: tuple[str, ...], code: int, says: str
) -> None:
    (lab / "bad.jsonl").write_text('{"version": 1}\n', encoding="utf-8")
    (lab / "binary.jsonl").write_bytes(b"\xff\xfe\x00")
    ran = xei("map", "build", *arguments, cwd=lab)
    assert (ran.code, ran.out) == (code, ""), ran.err
    assert says in ran.err
    assert not (lab / "out").exists()


def section_of(lab: Path) -> dict[str, object]:
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    return yaml.safe_load(file.read_text(encoding="utf-8"))["map"]


def test_the_profile_takes_the_map_and_no_other_is_lost(lab: Path) -> None:
    file = lab / "profiles" / "openarm_bench" / "calibration_profile.yaml"
    comments = [line for line in file.read_text(encoding="utf-8").splitlines() if line.lstrip()[:1] == "#"]
    ran = xei("map", "build", "drive.jsonl", "--write", cwd=lab)
    assert (ran.code, ran.out) == (0, ""), ran.err
    first = section_of(lab)
    assert (first["yaml"], first["image"], first["frame"]) == ("map/lab.yaml", "map/lab.pgm", "map")
    assert "history" not in first, "there was no map before"
    # Stations and drives are held against it at once: of the recorded room, a table's legs are in the way.
    assert "station bench_b: at 0.00, -2.20 m, -90 deg; below the base free" in ran.err
    assert ("warning[XEI0677]" in ran.err) == (
        "below the base free" not in ran.err.split("bench_a: ")[1][:60]
    )
    loaded, said = load_profile(file.parent, None)
    assert loaded is not None, said
    text = file.read_text(encoding="utf-8")
    assert [line for line in text.splitlines() if line.lstrip()[:1] == "#"] == comments
    assert xei("map", "build", "drive.jsonl", "--write", "--quiet", cwd=lab).code == 0
    assert file.read_text(encoding="utf-8") == text

    (lab / "again.jsonl").write_text(recorded(200, noise_m=0.02), encoding="utf-8")
    kept = (file.parent / "map" / "lab.pgm").read_bytes()
    refused = xei("map", "build", "again.jsonl", "--write", cwd=lab)
    assert refused.code == 1
    assert "error[XEI0668]" in refused.err and "--name" in refused.err
    assert (section_of(lab), (file.parent / "map" / "lab.pgm").read_bytes()) == (first, kept)
    ran = xei("map", "build", "again.jsonl", "--write", "--name", "lab_2", cwd=lab)
    assert ran.code == 0, ran.err
    assert "`map/lab.yaml` is in its history" in ran.err
    second = section_of(lab)
    assert second["yaml"] == "map/lab_2.yaml" and second["sha256"] != first["sha256"]
    assert second["history"] == [first]
    assert load_profile(file.parent, None)[0] is not None
    # The files of another map under the names of this one are told at once.
    (file.parent / "map" / "lab_2.pgm").write_bytes(kept)
    assert "XEI0666" in xei("map", "show", cwd=lab).err
