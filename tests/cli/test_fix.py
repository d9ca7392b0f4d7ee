"""`xei fix`: what is mended and what is left, and that a file never ends worse than it began."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, xei

ROUGH = """xei 1
protocol tired {
  profile "openarm_bench"
  pick(object: tube_1, arm=right);
  wait 10 minutes
  x = 1
  if x > 0 && True { wait 5 sec } // that will do
  place(object="tube_1", on=rack_2.slot("A1"), arm=right)
}
"""
MENDED = """xei 1
protocol tired {
  profile "openarm_bench"
  pick(object= tube_1, arm=right)
  wait 10 min
  let x = 1
  if x > 0 and true { wait 5 s } # that will do
  place(object=tube_1, on=rack_2.slot("A1"), arm=right)
}
"""


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    (tmp_path / "tired.xei").write_bytes(ROUGH.encode())
    return tmp_path


def protocol(*lines: str) -> str:
    return "\n".join(["protocol tired {", '  profile "openarm_bench"', *lines, "}", ""])


def test_safe_fixes_are_applied_until_none_is_left(lab: Path) -> None:
    ran = xei("fix", "tired.xei", cwd=lab)
    assert (lab / "tired.xei").read_text() == MENDED
    assert (ran.code, ran.out) == (0, ""), ran.err
    assert "fixed tired.xei:5: `minutes` is not a unit" in ran.err
    assert "0 errors left" in ran.err
    again = xei("fix", "tired.xei", cwd=lab)
    assert (again.code, again.err) == (0, "1 file: 0 fixes applied, 0 errors left\n")


def test_a_diff_writes_nothing_and_can_be_applied(lab: Path) -> None:
    ran = xei("fix", "--diff", "tired.xei", cwd=lab)
    assert (lab / "tired.xei").read_text() == ROUGH
    assert "would fix tired.xei:4: " in ran.err
    subprocess.run(["patch", "-p1"], input=ran.out.encode(), cwd=lab, check=True, capture_output=True)
    assert (lab / "tired.xei").read_text() == MENDED


def test_what_may_not_have_been_meant_is_mended_on_demand_only(lab: Path) -> None:
    text = protocol("  pik(object=tube_1, arm=right)", "  let half = 7 // 2", "  wait 1 s")
    (lab / "tired.xei").write_text(text)
    ran = xei("fix", "tired.xei", cwd=lab)
    assert ran.code == 1
    assert (lab / "tired.xei").read_text() == text
    assert "`//` has no such use here" in ran.err
    xei("fix", "--unsafe", "tired.xei", cwd=lab)
    assert (lab / "tired.xei").read_text() == text.replace("pik", "pick").replace("//", "#")


@pytest.mark.parametrize(
    "data",
    [b"\xff\xfe", b"", b"protocol p { wait 5 ul \xff }", b"protocol {{{{ ", b"}" * 100, b'note "\x00'],
)
def test_what_has_no_safe_fix_is_not_touched(lab: Path, data: bytes) -> None:
    (lab / "tired.xei").write_bytes(data)
    before = (lab / "tired.xei").stat()
    ran = xei("fix", "tired.xei", cwd=lab)
    assert ran.code == 1
    assert (lab / "tired.xei").read_bytes() == data
    assert (lab / "tired.xei").stat().st_mtime_ns == before.st_mtime_ns


def test_line_ends_and_the_byte_order_mark_stay(lab: Path) -> None:
    (lab / "tired.xei").write_bytes(b"\xef\xbb\xbf" + ROUGH.replace("\n", "\r\n").encode())
    assert xei("fix", ".", cwd=lab).code == 0
    assert (lab / "tired.xei").read_bytes() == b"\xef\xbb\xbf" + MENDED.replace("\n", "\r\n").encode()


def test_several_files_are_mended_by_themselves(lab: Path) -> None:
    (lab / "other.xei").write_text(protocol("  nonsense here", "  wait 5 sec"))
    ran = xei("fix", ".", "missing.xei", cwd=lab)
    assert ran.code == 1
    assert (lab / "tired.xei").read_text() == MENDED
    assert (lab / "other.xei").read_text() == protocol("  nonsense here", "  wait 5 s")
    assert "`missing.xei` does not exist" in ran.err
