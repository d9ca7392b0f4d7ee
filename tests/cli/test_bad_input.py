"""Whatever a tired person does: a place, a reason, a way out, the right exit code, and no traceback."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, PROTOCOLS, start, xei

GOOD = (PROTOCOLS / "put_on_rack.xei").read_text(encoding="utf-8")


def protocol(*lines: str) -> str:
    body = "\n".join(f"  {line}" for line in lines)
    return f'xei 1\nprotocol tired {{\n  profile "openarm_bench"\n{body}\n}}\n'


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "tired.xei"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return path


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """A working folder whose profile is the bench's own."""
    (tmp_path / "profiles").symlink_to(PROFILES)
    return tmp_path


CHECKED = [
    ("an unknown skill", protocol("pik(object=tube_1)"), "XEI02", ["`pik`", "`pick`"]),
    ("a wrong role", protocol("pick(object=rack_1)"), "XEI03", ["`rack_1`", "movable"]),
    ("a wrong unit", protocol("slide_to(height=30 s)"), "XEI03", ["`height`", "Length", "30 s"]),
    ("a missing argument", protocol("pick()"), "XEI03", ["`object`", "`pick`"]),
    (
        "a slot that does not exist",
        protocol('insert(object=tube_1, into=rack_2.slot("D9"))'),
        "XEI0",
        ["D9", "rack_2"],
    ),
    ("an empty file", "", "XEI0103", ["protocol"]),
    ("a cut file", GOOD[: GOOD.index("}")], "XEI0104", ["{"]),
    ("bytes that are no text", b"xei 1\n\xff\xfe\x00", "XEI0102", ["UTF-8"]),
    ("nothing but a comment", "# later\n", "XEI0103", ["protocol"]),
    ("a huge loop", protocol("repeat 1000000000 times { wait 1 s }"), "XEI0", ["1000000000"]),
    (
        "a profile that does not exist",
        GOOD.replace("openarm_bench", "openarm_bentch"),
        "XEI0601",
        ["openarm_bench"],
    ),
]


@pytest.mark.parametrize(("_name", "text", "code", "words"), CHECKED, ids=[case[0] for case in CHECKED])
def test_check_says_what_is_wrong(
    lab: Path, _name: str, text: str | bytes, code: str, words: list[str]
) -> None:
    ran = xei("check", written(lab, text).name, cwd=lab)
    assert ran.code == 1, ran.err
    assert f"[{code}" in ran.err
    assert "tired.xei" in ran.err
    for word in words:
        assert word in ran.err, ran.err


@pytest.mark.parametrize("command", ["check", "compile", "run"])
def test_a_missing_file_is_wrong_usage(lab: Path, command: str) -> None:
    ran = xei(command, "nowhere.xei", cwd=lab)
    assert ran.code == 2
    assert "`nowhere.xei`" in ran.err


@pytest.mark.parametrize("command", ["compile", "run"])
def test_a_folder_instead_of_a_file_is_wrong_usage(lab: Path, command: str) -> None:
    ran = xei(command, "profiles", cwd=lab)
    assert ran.code == 2
    assert "folder" in ran.err


def test_a_folder_without_protocols_is_wrong_usage(lab: Path) -> None:
    (lab / "empty").mkdir()
    ran = xei("check", "empty", cwd=lab)
    assert ran.code == 2
    assert "no .xei file" in ran.err


def test_a_broken_profile_is_shown_at_its_line(tmp_path: Path) -> None:
    shutil.copytree(PROFILES, tmp_path / "profiles")
    usage = tmp_path / "profiles" / "openarm_bench" / "usage_profile.yaml"
    usage.write_text(usage.read_text().replace("mass: 6.5 g", "mass: 6.5 mL", 1))
    ran = xei("check", written(tmp_path, GOOD).name, cwd=tmp_path)
    line = (
        usage.read_text().splitlines().index(next(x for x in usage.read_text().splitlines() if "6.5 mL" in x))
        + 1
    )
    assert ran.code == 1
    assert f"profiles/openarm_bench/usage_profile.yaml:{line}:" in ran.err


def test_a_gap_is_compiled_only_when_it_is_allowed(lab: Path) -> None:
    text = protocol('unmapped "centrifuge at 3000 g" because "no centrifuge"', "wait 1 s")
    ran = xei("compile", written(lab, text).name, "--emit", "goals", cwd=lab)
    assert ran.code == 1
    assert "centrifuge at 3000 g" in ran.err
    assert xei("compile", "tired.xei", "--emit", "goals", "--allow-unmapped", cwd=lab).code == 0


def test_a_strict_compilation_names_the_placeholders(lab: Path) -> None:
    ran = xei("compile", written(lab, GOOD).name, "--strict", "--emit", "goals", cwd=lab)
    assert ran.code == 1
    assert "`frames.table` is a placeholder" in ran.err
    assert "calibration_profile.yaml:" in ran.err


@pytest.mark.parametrize("option", [("--bind", "rack"), ("--bind", "=x"), ("--param", "a"), ("--speed", "2")])
def test_a_malformed_option_is_wrong_usage(lab: Path, option: tuple[str, str]) -> None:
    ran = xei("run", written(lab, GOOD).name, *option, cwd=lab)
    assert ran.code == 2
    assert option[0] in ran.err


@pytest.mark.skipif(os.geteuid() != 0 and not hasattr(os, "setuid"), reason="needs POSIX permissions")
def test_a_file_in_the_way_of_the_bundle_is_not_replaced(lab: Path) -> None:
    (lab / "out").write_text("precious")
    ran = xei("compile", written(lab, protocol("wait 1 s")).name, "-o", "out", cwd=lab)
    assert ran.code in (1, 2)
    assert (lab / "out").read_text() == "precious"
    assert "[XEI09" in ran.err


@pytest.mark.parametrize("place", ["file", "file/bundle", "/", "mine"])
def test_a_place_without_room_for_a_bundle_is_told_before_anything_is_planned(lab: Path, place: str) -> None:
    (lab / "file").write_text("precious")
    (lab / "mine").mkdir()
    (lab / "mine" / "thesis.tex").write_text("precious")
    ran = xei("compile", written(lab, protocol("wait 1 s")).name, "-o", place, cwd=lab)
    assert (ran.code, f"`{place}`" in ran.err, "help: choose" in ran.err) == (1, True, True), ran.err
    assert "motion" not in ran.err


def test_what_is_written_to_a_pipe_or_through_a_link_leaves_both(lab: Path) -> None:
    name = written(lab, protocol("wait 1 s")).name
    (lab / "to").write_text("")
    (lab / "link").symlink_to("to")
    assert xei("compile", name, "--emit", "plan", "-o", "link", cwd=lab).code == 0
    assert (lab / "link").is_symlink()
    plan = (lab / "to").read_text()
    assert '"skill_calls"' in plan
    os.mkfifo(lab / "pipe")
    reader = subprocess.Popen(["cat", "pipe"], cwd=lab, stdout=subprocess.PIPE, text=True)
    assert xei("compile", name, "--emit", "plan", "-o", "pipe", cwd=lab).code == 0
    assert reader.communicate(timeout=30)[0] == plan
    assert (lab / "pipe").is_fifo()


FULL = Path("/dev/full")


@pytest.mark.skipif(not FULL.is_char_device(), reason="needs /dev/full")
def test_an_output_that_is_full_is_no_bug_of_ours(lab: Path) -> None:
    # By way of a link, so that a program that replaces its output breaks the link only.
    (lab / "full").symlink_to(FULL)
    name = written(lab, protocol("wait 1 s")).name
    traced = xei("run", name, "--trace", "full", cwd=lab)
    assert (traced.code, "error[XEI0101]: `full` cannot be written: no space left" in traced.err) == (2, True)
    with FULL.open("w") as full:
        printed = start("check", "--format", "json", name, cwd=lab, stdout=full)
    _, err = printed.communicate(timeout=60)
    assert (printed.returncode, err) == (
        2, "error: standard output cannot be written: no space left on device\n")  # fmt: skip


def test_a_foreign_folder_is_not_replaced(lab: Path) -> None:
    (lab / "out").mkdir()
    (lab / "out" / "thesis.tex").write_text("precious")
    ran = xei("compile", written(lab, protocol("wait 1 s")).name, "-o", "out", cwd=lab)
    assert ran.code in (1, 2)
    assert (lab / "out" / "thesis.tex").read_text() == "precious"


def test_ctrl_c_in_the_middle_leaves_nothing_half_written(lab: Path) -> None:
    process = start("compile", written(lab, GOOD).name, "-o", "out", cwd=lab)
    time.sleep(1.5)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert process.returncode in (130, 0), err
    assert "Traceback" not in err
    left = {path.name for path in lab.iterdir()} - {"profiles", "tired.xei", ".cache", "out"}
    assert left == set()
    assert process.returncode == 0 or not (lab / "out").exists()


def test_a_terminal_escape_in_a_file_name_is_not_printed_raw(lab: Path) -> None:
    (lab / "a\x1b[31mred.xei").write_text("protocol")
    ran = xei("check", "a\x1b[31mred.xei", cwd=lab)
    assert "\x1b" not in ran.err
    assert ran.code == 1
