"""`xei fmt`: what is written, what is not, and how a file stays what it was otherwise."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.xei import ROOT, xei

ROUGH = "protocol p{wait 5s # so\n}"
NEAT = "protocol p {\n  wait 5 s  # so\n}\n"
WRONG = "protocol p {  wait 5 s"


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "rough.xei").write_bytes(ROUGH.encode())
    (tmp_path / "below").mkdir()
    (tmp_path / "below" / "neat.xei").write_bytes(NEAT.encode())
    return tmp_path


def piped(text: bytes, *args: str, cwd: Path) -> subprocess.CompletedProcess[bytes]:
    program = [sys.executable, "-c", "from xei_lang.cli.main import run; run()", "fmt", *args]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(cwd / ".cache")}
    return subprocess.run(program, input=text, cwd=cwd, env=environment, capture_output=True, check=False)


def test_files_and_folders_are_formatted(lab: Path) -> None:
    ran = xei("fmt", "rough.xei", ".", "below", cwd=lab)
    assert (ran.code, ran.out) == (0, "")
    assert "1 file formatted, 1 as they should be" in ran.err
    assert (lab / "rough.xei").read_bytes() == NEAT.encode()
    assert xei("fmt", "--check", ".", cwd=lab).code == 0
    assert sorted(path.name for path in lab.iterdir()) == [".cache", "below", "rough.xei"]


def test_check_writes_nothing_and_names_the_files(lab: Path) -> None:
    ran = xei("fmt", "--check", ".", cwd=lab)
    assert ran.code == 1
    assert "rough.xei is not formatted" in ran.err
    assert "neat.xei" not in ran.err
    assert (lab / "rough.xei").read_bytes() == ROUGH.encode()


def test_a_diff_can_be_applied(lab: Path) -> None:
    ran = xei("fmt", "--diff", "rough.xei", cwd=lab)
    assert ran.code == 0
    assert (lab / "rough.xei").read_bytes() == ROUGH.encode()
    subprocess.run(["patch", "-p1"], input=ran.out.encode(), cwd=lab, check=True, capture_output=True)
    assert (lab / "rough.xei").read_bytes() == NEAT.encode()
    assert xei("fmt", "--diff", "rough.xei", cwd=lab).out == ""
    assert xei("fmt", "--diff", "--check", "below", cwd=lab).code == 0


def test_standard_input_goes_to_standard_output(lab: Path) -> None:
    ran = piped(ROUGH.encode(), "-", cwd=lab)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, NEAT.encode(), b"")
    ran = piped(ROUGH.encode(), "-", "--check", cwd=lab)
    assert (ran.returncode, ran.stdout) == (1, b"")
    ran = piped(WRONG.encode(), "-", cwd=lab)
    assert (ran.returncode, ran.stdout) == (1, b"")
    assert b"<stdin>" in ran.stderr
    assert piped(b"\xff\xfe", "-", cwd=lab).returncode == 1
    assert piped(b"", "-", "rough.xei", cwd=lab).returncode == 2


@pytest.mark.parametrize(
    "data", [WRONG.encode(), b"\xff\xfe\x00", b"", b"# only a comment\r\n", b"protocol P { }"]
)
def test_what_cannot_be_parsed_stays_as_it_is(lab: Path, data: bytes) -> None:
    (lab / "rough.xei").write_bytes(data)
    before = (lab / "rough.xei").stat()
    ran = xei("fmt", ".", cwd=lab)
    assert ran.code == 1
    assert "rough.xei" in ran.err
    assert "1 file with errors left as they are" in ran.err
    assert (lab / "rough.xei").read_bytes() == data
    assert (lab / "rough.xei").stat().st_mtime_ns == before.st_mtime_ns


def test_a_formatted_file_is_not_written_again(lab: Path) -> None:
    before = (lab / "below" / "neat.xei").stat()
    xei("fmt", ".", cwd=lab)
    after = (lab / "below" / "neat.xei").stat()
    assert (after.st_mtime_ns, after.st_ino) == (before.st_mtime_ns, before.st_ino)


@pytest.mark.parametrize("data", [NEAT.replace("\n", "\r\n").encode(), b"\xef\xbb\xbf" + NEAT.encode()])
def test_lines_end_in_line_feeds_and_no_mark_stands_before_them(lab: Path, data: bytes) -> None:
    (lab / "rough.xei").write_bytes(data)
    assert xei("fmt", "--check", "rough.xei", cwd=lab).code == 1
    assert xei("fmt", "rough.xei", cwd=lab).code == 0
    assert (lab / "rough.xei").read_bytes() == NEAT.encode()


def test_permissions_and_links_stay(lab: Path) -> None:
    (lab / "rough.xei").chmod(0o640)
    (lab / "link.xei").symlink_to("rough.xei")
    assert xei("fmt", "link.xei", cwd=lab).code == 0
    assert (lab / "link.xei").is_symlink()
    assert (lab / "rough.xei").read_bytes() == NEAT.encode()
    assert stat.S_IMODE((lab / "rough.xei").stat().st_mode) == 0o640


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anything")
def test_a_file_that_may_not_be_written_is_not_replaced(lab: Path) -> None:
    (lab / "rough.xei").chmod(0o444)
    ran = xei("fmt", "rough.xei", cwd=lab)
    assert ran.code == 2
    assert "permission denied" in ran.err
    assert (lab / "rough.xei").read_bytes() == ROUGH.encode()


def test_a_missing_file_is_wrong_usage(lab: Path) -> None:
    ran = xei("fmt", "nowhere.xei", "rough.xei", cwd=lab)
    assert ran.code == 2
    assert "`nowhere.xei` does not exist" in ran.err
    assert (lab / "rough.xei").read_bytes() == NEAT.encode()
