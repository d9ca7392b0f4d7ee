"""`xei check --jobs`: the same bytes as from one process, and an end whatever happens to one of several."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, ROOT, xei

GOOD = 'protocol fine {\n  profile "openarm_bench"\n  wait 1 s\n}\n'
IMPORTING = 'import "lib.xei"\n' + GOOD.replace("wait 1 s", "rest()\n  let unused = 1")
FORMS = ["full", "concise", "json", "sarif", "github", "junit"]


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    (tmp_path / "profiles").symlink_to(PROFILES)
    many = tmp_path / "many"
    many.mkdir()
    texts = [GOOD, IMPORTING, GOOD.replace("wait", "wiat"), GOOD.replace("1 s", "1 mL"), GOOD[:-2], ""]
    for number in range(24):
        (many / f"p{number:02}.xei").write_text(texts[number % len(texts)], encoding="utf-8")
    (many / "lib.xei").write_text("procedure rest() {\n  wait 1 mL\n}\n", encoding="utf-8")
    (many / "latin.xei").write_bytes(b"\xff\xfe")
    return tmp_path


@pytest.mark.parametrize("form", FORMS)
def test_the_same_bytes_from_any_number_of_processes(lab: Path, form: str) -> None:
    one, several = (
        xei("check", "--no-cache", "--format", form, "--jobs", jobs, "many", "nowhere.xei", cwd=lab)
        for jobs in ("1", "40" if form == "json" else "2")
    )
    assert one.code == 1, one.err
    assert one == several


def test_processes_that_are_no_number_are_wrong_usage(lab: Path) -> None:
    for jobs in ("0", "-1", "many"):
        assert xei("check", "--jobs", jobs, "many", cwd=lab).code == 2


def slow(lab: Path) -> subprocess.Popen[str]:
    """A check whose processes have work for a while, as the leader of a group of its own."""
    lines = "".join(f"  let a{number} = {number} + 1\n" for number in range(4000))
    for number in range(8):
        (lab / f"slow{number}.xei").write_text(GOOD.replace("  wait", lines + "  wait"), encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(lab / ".cache")}
    program = [sys.executable, "-c", "from xei_lang.cli.main import run; run()"]
    files = [f"slow{number}.xei" for number in range(8)]
    return subprocess.Popen(
        [*program, "check", "--jobs", "2", "--no-cache", *files],
        cwd=lab, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip


def children(pid: int) -> list[int]:
    """The processes that a process has made, once there are two of them."""
    path = Path(f"/proc/{pid}/task/{pid}/children")
    for _ in range(3000):
        found = [int(child) for child in path.read_text().split()]
        if len(found) == 2:
            return found
        time.sleep(0.01)
    raise AssertionError("no processes were made")


needs_proc = pytest.mark.skipif(
    not Path(f"/proc/{os.getpid()}/task/{os.getpid()}/children").exists(), reason="needs Linux's /proc"
)


@needs_proc
def test_a_killed_process_ends_the_check_with_words(lab: Path) -> None:
    process = slow(lab)
    made = children(process.pid)
    time.sleep(0.3)  # by now it has said what it is at
    os.kill(made[1], signal.SIGKILL)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (70, "")
    assert err.startswith("internal error: a process that checked files was ended by SIGKILL\n")
    assert "`slow" in err
    assert "Traceback" not in err


@needs_proc
def test_ctrl_c_ends_all_of_them_at_once(lab: Path) -> None:
    process = slow(lab)
    made = children(process.pid)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert err == "\ninterrupted: nothing was left half-written\n"
    assert not [child for child in made if Path(f"/proc/{child}").exists()]
