"""What a run is told before it starts: answers and places that would stop it half way."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, Ran, xei

CALM = 'protocol calm {\n  profile "openarm_bench"\n  confirm "The bench is clear"\n  wait 1 s\n}\n'
FAR = CALM.replace("wait 1 s", "pick(object=tube_7)")
"""Planning finds that the tube stands at the other bench."""


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "calm.xei").write_text(CALM, encoding="utf-8")
    (tmp_path / "far.xei").write_text(FAR, encoding="utf-8")
    (tmp_path / "yes.json").write_text('{"confirm#1": true}', encoding="utf-8")
    return tmp_path


def run(lab: Path, name: str, *more: str) -> Ran:
    return xei("run", name, "--answers", "yes.json", *more, cwd=lab)


def test_planning_fails_where_nothing_else_does(lab: Path) -> None:
    ran = run(lab, "far.xei", "--trace", "trace.jsonl")
    assert ran.code == 1 and "error[XEI0801]" in ran.err
    assert not (lab / "trace.jsonl").exists()


def test_an_answer_to_nothing_is_told_before_anything_is_planned(lab: Path) -> None:
    (lab / "yes.json").write_text(
        '{\n  "confirm#1": true,\n  "The bench is clean": true\n}\n', encoding="utf-8"
    )
    ran = run(lab, "far.xei", "--trace", "trace.jsonl")
    assert ran.code == 1
    assert ran.err.startswith(
        "error[XEI0917]: `The bench is clean` is answered, and the plan does not ask it"
    )
    assert "--> yes.json:3:3" in ran.err
    assert "help: did you mean `The bench is clear`?" in ran.err
    assert "XEI0801" not in ran.err
    assert not (lab / "trace.jsonl").exists()


def test_answers_that_cannot_be_read_are_shown_where_they_break(lab: Path) -> None:
    (lab / "yes.json").write_text('{"confirm#1": yes}\n', encoding="utf-8")
    ran = run(lab, "calm.xei")
    assert ran.code == 1
    assert "error[XEI0110]: `yes` is not JSON" in ran.err and "--> yes.json:1:15" in ran.err


PLACES = [
    ("missing/trace.jsonl", "no such file or directory"),
    ("yes.json/trace.jsonl", "not a directory"),
    ("folder", "is a directory"),
    ("x" * 300, "file name too long"),
]


@pytest.mark.parametrize(("place", "reason"), PLACES)
def test_a_place_without_room_for_a_trace_is_told_before_anything_is_planned(
    lab: Path, place: str, reason: str
) -> None:
    (lab / "folder").mkdir()
    ran = run(lab, "far.xei", "--trace", place)
    assert ran.code == 2
    assert f"error[XEI0101]: `{place}` cannot be written: {reason}\n" in ran.err
    assert "help: choose another place with --trace" in ran.err
    assert "XEI0801" not in ran.err


@pytest.mark.parametrize(("place", "reason"), [*PLACES[1:2], PLACES[3]])
def test_nor_is_there_for_a_representation(lab: Path, place: str, reason: str) -> None:
    ran = xei("compile", "far.xei", "--emit", "timed", "-o", place, cwd=lab)
    assert ran.code == 2
    assert f"error[XEI0101]: `{place}` cannot be written: {reason}\n" in ran.err
    assert "help: choose another place with -o" in ran.err
    assert "XEI0801" not in ran.err


def test_a_folder_is_no_place_for_a_representation(lab: Path) -> None:
    ran = xei("compile", "far.xei", "--emit", "timed", "-o", "profiles", cwd=lab)
    assert ran.code == 2
    assert "error[XEI0101]: `profiles` is a folder, and a file was to be written" in ran.err
    assert "XEI0801" not in ran.err


def test_a_representation_that_cannot_be_made_leaves_no_folders(lab: Path) -> None:
    ran = xei("compile", "far.xei", "--emit", "timed", "-o", "new/timed.json", cwd=lab)
    assert ran.code == 1 and "error[XEI0801]" in ran.err
    assert not (lab / "new").exists()


def test_a_trace_of_before_stays_where_planning_fails(lab: Path) -> None:
    (lab / "trace.jsonl").write_text("precious")
    assert run(lab, "far.xei", "--trace", "trace.jsonl").code == 1
    assert (lab / "trace.jsonl").read_text() == "precious"


def test_a_trace_goes_to_pipes_devices_and_through_links(lab: Path) -> None:
    assert run(lab, "calm.xei", "--trace", "/dev/null").code == 0
    printed = run(lab, "calm.xei", "--trace", "/dev/stdout")
    assert printed.code == 0
    assert [json.loads(line)["stage"] for line in printed.out.splitlines()][-1] == "end"
    (lab / "link").symlink_to("to.jsonl")
    assert run(lab, "calm.xei", "--trace", "link").code == 0
    assert (lab / "to.jsonl").read_text(encoding="utf-8") == printed.out
    os.mkfifo(lab / "pipe")
    reader = subprocess.Popen(["cat", "pipe"], cwd=lab, stdout=subprocess.PIPE, text=True)
    assert run(lab, "calm.xei", "--trace", "pipe").code == 0
    assert reader.communicate(timeout=30)[0] == printed.out
