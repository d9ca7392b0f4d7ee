"""Running the program as a user does: a process of its own, with its own cache and working folder.

A cache begins with the compiled profile of the bench: reading its YAML anew takes a second each time.
"""

from __future__ import annotations

import atexit
import functools
import os
import shutil
import subprocess
import sys
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

ROOT = Path(__file__).resolve().parents[2]
PROFILES = ROOT / "profiles"
PROTOCOLS = ROOT / "protocols"


@dataclass(frozen=True)
class Ran:
    code: int
    out: str
    err: str


@functools.cache
def _warm_cache() -> Path:
    """A cache folder after a first check with the bench's profile; one for all tests of this process."""
    folder = Path(tempfile.mkdtemp(prefix="xei-warm-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    (folder / "profiles").symlink_to(PROFILES)
    (folder / "warm.xei").write_text('protocol warm { profile "openarm_bench" wait 1 s }\n', encoding="utf-8")
    _start(("check", "--no-cache", "warm.xei"), folder, None).communicate()
    return folder / ".cache"


def start(
    *args: str, cwd: Path, env: dict[str, str] | None = None, stdout: IO[str] | int = subprocess.PIPE
) -> subprocess.Popen[str]:
    assert cwd != ROOT, "a test leaves its cache where it runs"
    if not (cwd / ".cache").exists():
        with suppress(OSError):
            shutil.copytree(_warm_cache(), cwd / ".cache")
    return _start(args, cwd, env, stdout)


def _start(
    args: tuple[str, ...], cwd: Path, env: dict[str, str] | None, stdout: IO[str] | int = subprocess.PIPE
) -> subprocess.Popen[str]:
    program = [sys.executable, "-c", "from xei_lang.cli.main import run; run()", *args]
    own = {"PYTHONPATH": str(ROOT), "NO_COLOR": "1", "XDG_CACHE_HOME": str(cwd / ".cache")}
    environment = {**os.environ, **own, **(env or {})}
    return subprocess.Popen(
        program, cwd=cwd, env=environment, stdin=subprocess.DEVNULL, stdout=stdout,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def xei(*args: str, cwd: Path, env: dict[str, str] | None = None, timeout: float = 120.0) -> Ran:
    process = start(*args, cwd=cwd, env=env)
    out, err = process.communicate(timeout=timeout)
    assert "Traceback" not in err, err
    return Ran(process.returncode, out, err)
