"""`xei check --watch`: checked again at every change of what the check depends on, until Ctrl-C."""

from __future__ import annotations

import os
import pty
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cli.xei import PROFILES, ROOT

MAIN = (
    'import "lib.xei"\nimport table "t.csv" as t\nprotocol fine {\n  profile "openarm_bench"\n'
    "  rest()\n  wait t[1].time\n}\n"
)
LIB = "procedure rest() {\n  wait 1 s\n}\n"
FINE = "1 file checked: 0 errors, 0 warnings"


class Watching:
    """A watching process, and what it has printed so far."""

    def __init__(self, lab: Path, *args: str) -> None:
        program = [sys.executable, "-u", "-c", "from xei_lang.cli.main import run; run()", "check", "--watch"]
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(lab / ".cache")}
        self.process = subprocess.Popen(
            [*program, *args],
            cwd=lab,
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self._lines: list[str] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stderr is not None
        self._lines.extend(iter(self.process.stderr.readline, ""))

    def round(self) -> str:
        """What the next check says; waits for it."""
        for _ in range(6000):
            ends = [index for index, line in enumerate(self._lines) if line.startswith("watching ")]
            if ends:
                said = self._lines[: ends[0]]
                del self._lines[: ends[0] + 1]
                return "".join(said)
            assert self.process.poll() is None, "".join(self._lines)
            time.sleep(0.01)
        raise AssertionError("nothing was checked: " + "".join(self._lines))

    def end(self) -> tuple[int, str]:
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(timeout=60)
        self.close()
        return code, "".join(self._lines)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join(timeout=60)
        assert self.process.stderr is not None
        self.process.stderr.close()


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    shutil.copytree(PROFILES / "openarm_bench", tmp_path / "profiles" / "openarm_bench")
    for name, text in (("main.xei", MAIN), ("lib.xei", LIB), ("t.csv", "time [s]\n1\n")):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def watching(lab: Path) -> Iterator[Watching]:
    found = Watching(lab, "main.xei")
    assert FINE in found.round()
    yield found
    found.close()


def test_every_input_is_watched(lab: Path, watching: Watching) -> None:
    calibration = lab / "profiles/openarm_bench/calibration_profile.yaml"
    changes = [
        (lab / "main.xei", MAIN.replace("rest()", "rset()"), "XEI0201"),
        (lab / "main.xei", MAIN.replace("{", "("), "XEI0104"),
        (lab / "lib.xei", LIB.replace("1 s", "1 mL"), "lib.xei:2:"),
        (lab / "t.csv", "time [s]\nx\n", "t.csv:2:"),
        (calibration, "version: [", "calibration_profile.yaml:"),
    ]
    for path, text, said in changes:
        before = path.read_text(encoding="utf-8")
        path.write_text(text, encoding="utf-8")
        assert said in watching.round()
        path.write_text(before, encoding="utf-8")
        assert FINE in watching.round()
    assert watching.end() == (0, "")


def test_files_may_go_and_come_back(lab: Path, watching: Watching) -> None:
    for name, said in (
        ("main.xei", "`main.xei` does not exist"),
        ("lib.xei", "XEI0122"),
        ("t.csv", "XEI0122"),
    ):
        (lab / name).rename(lab / "away")
        assert said in watching.round()
        (lab / "away").rename(lab / name)
        assert FINE in watching.round()
    (lab / "profiles").rename(lab / "away")
    watching.round()  # the profile that comes with xei, or none
    (lab / "away").rename(lab / "profiles")
    assert FINE in watching.round()


def test_a_file_that_is_replaced_as_editors_do_is_seen(lab: Path, watching: Watching) -> None:
    (lab / "new").write_text(MAIN.replace("rest()", "rset()"), encoding="utf-8")
    os.replace(lab / "new", lab / "main.xei")
    assert "XEI0201" in watching.round()


def test_it_ends_with_the_last_exit_code(lab: Path, watching: Watching) -> None:
    (lab / "main.xei").write_text(MAIN.replace("rest()", "rset()"), encoding="utf-8")
    watching.round()
    assert watching.end() == (1, "")


def test_a_folder_is_watched_for_new_files_and_may_be_empty(lab: Path) -> None:
    (lab / "many").mkdir()
    found = Watching(lab, "--jobs", "2", "many")
    assert "there is no .xei file in `many`" in found.round()
    shutil.copy(ROOT / "protocols" / "put_on_rack.xei", lab / "many" / "a.xei")
    assert FINE in found.round()
    shutil.copy(ROOT / "protocols" / "put_on_rack.xei", lab / "many" / "b.xei")
    assert "2 files checked: 0 errors" in found.round()
    (lab / "many" / "a.xei").unlink()
    (lab / "many" / "b.xei").unlink()
    found.round()
    assert found.end()[0] == 2


def test_the_screen_is_not_cleared_where_there_is_none(lab: Path, watching: Watching) -> None:
    (lab / "lib.xei").write_text(LIB.replace("1 s", "1 mL"), encoding="utf-8")
    assert "\x1b" not in watching.round()


def test_the_screen_is_cleared_on_a_terminal(lab: Path) -> None:
    ours, theirs = pty.openpty()
    program = [
        sys.executable,
        "-c",
        "from xei_lang.cli.main import run; run()",
        "check",
        "--watch",
        "main.xei",
    ]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(lab / ".cache")}
    process = subprocess.Popen(program, cwd=lab, env=environment, stdin=theirs, stdout=theirs, stderr=theirs)
    os.close(theirs)
    printed = b""
    while b"Ctrl-C ends" not in printed:
        printed += os.read(ours, 4096)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 0
    os.close(ours)
    assert printed.startswith(b"\x1b[2J")
