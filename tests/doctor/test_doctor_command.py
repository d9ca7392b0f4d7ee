"""`xei doctor` as a user calls it."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import jsonschema
import pytest
from click.testing import CliRunner

from tests.cli.xei import PROFILES, xei
from xei_lang.cli.schema_command import command as schema_command


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    shutil.copytree(PROFILES / "openarm_bench", tmp_path / "profiles" / "lab")
    return tmp_path


def test_the_only_profile_is_found_and_its_blockers_are_told_with_their_lines(lab: Path) -> None:
    ran = xei("doctor", cwd=lab)
    assert ran.code == 1
    lines = (lab / "profiles" / "lab" / "calibration_profile.yaml").read_text(encoding="utf-8").splitlines()
    (told,) = [line for line in ran.out.splitlines() if line.startswith("      frames.lidar ")]
    file, number = told.split()[1].split(":")
    assert file == "profiles/lab/calibration_profile.yaml"
    assert lines[int(number) - 1] == "  lidar:"
    assert "lab: nothing before simulation" in ran.out


def test_json_is_of_its_schema(lab: Path) -> None:
    ran = xei("doctor", "--profile", "lab", "--format", "json", cwd=lab)
    schema = json.loads(CliRunner().invoke(schema_command, ["doctor"]).output)
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(json.loads(ran.out))
    assert ran.code == 1


def test_a_profile_that_does_not_load_blocks_simulation(lab: Path) -> None:
    file = lab / "profiles" / "lab" / "calibration_profile.yaml"
    file.write_text(
        file.read_text(encoding="utf-8").replace("payload: 1 kg", "payload: 1 m"), encoding="utf-8"
    )
    ran = xei("doctor", "--format", "json", cwd=lab)
    assert ran.code == 1
    assert {blocker["blocks"] for blocker in json.loads(ran.out)["blockers"]} == {"simulate"}
    assert "payload" in xei("doctor", cwd=lab).err


@pytest.mark.parametrize("named", ["labb", "../nowhere", "profiles"])
def test_a_profile_that_is_not_there_is_told_with_those_that_are(lab: Path, named: str) -> None:
    ran = xei("doctor", "--profile", named, cwd=lab)
    assert ran.code == 1
    assert "XEI0601" in ran.err
    assert "`lab`" in ran.err


def test_quiet_leaves_the_exit_code(lab: Path) -> None:
    ran = xei("doctor", "--quiet", cwd=lab)
    assert (ran.code, ran.out, ran.err) == (1, "", "")


LIDAR = """    status: placeholder
    method: "measure the mount on the base's front deck"
    tolerance: {position: 5 mm, rotation: 1 deg}
"""
JUMPED = """    status: measured
    measured_on: "2026-11-20"
    method: "measure the mount on the base's front deck"
    tolerance: {position: 5 mm, rotation: 1 deg}
    history:
      - {measured_on: "2026-10-01", status: measured, position: [0.33 m, 0 m, 0.20 m],
         tolerance: {position: 5 mm, rotation: 1 deg}, method: "with a ruler"}
"""


def test_a_jump_warns_and_stops_nothing(lab: Path) -> None:
    file = lab / "profiles" / "lab" / "calibration_profile.yaml"
    text = file.read_text(encoding="utf-8")
    assert text.count(LIDAR) == 1
    file.write_text(text.replace(LIDAR, JUMPED), encoding="utf-8")
    ran = xei("doctor", "--format", "json", cwd=lab)
    schema = json.loads(CliRunner().invoke(schema_command, ["doctor"]).output)
    told = json.loads(ran.out)
    jsonschema.Draft202012Validator(schema).validate(told)
    (warning,) = told["warnings"]
    assert warning["code"] == "XEI0669" and "`lidar` moved by 30.00 mm" in warning["message"]
    assert "frames.lidar" not in {blocker["item"] for blocker in told["blockers"]}
    assert "warning[XEI0669]" in ran.err
    assert xei("doctor", "--quiet", cwd=lab).err == ""
    where = xei("world", "where", "lidar", "--history", cwd=lab)
    assert "measured on 2026-11-20, good to 5 mm and 1 deg" in where.out
    assert "30.00 mm and 0.000 deg from what came after: more than both tolerances allow" in where.out


def test_the_table_of_readiness_counts_the_blockers(lab: Path) -> None:
    told = json.loads(xei("doctor", "--format", "json", cwd=lab).out)
    stages = ["simulate", "strict", "hardware"]
    for place, row in enumerate(told["readiness"]):
        before = [one for one in told["blockers"] if stages.index(one["blocks"]) <= place]
        assert (row["stage"], row["blockers"]) == (stages[place], len(before))
        assert row["ready"] == (not before)
        for name, count in row["by_representation"].items():
            assert count == sum(one["representation"] == name for one in before)
    for blocker in told["blockers"]:
        file, item = blocker["write_to"].split(":")
        assert blocker["file"] == f"profiles/lab/{file}"
        line = (lab / blocker["file"]).read_text(encoding="utf-8").splitlines()[blocker["line"] - 1]
        assert any(word in line for word in item.split(".")), blocker
