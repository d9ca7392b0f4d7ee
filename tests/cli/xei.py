"""Running the program as a user does: a process of its own, with its own cache and working folder."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROFILES = ROOT / "profiles"
PROTOCOLS = ROOT / "protocols"


@dataclass(frozen=True)
class Ran:
    code: int
    out: str
    err: str


def start(*args: str, cwd: Path, env: dict[str, str] | None = None) -> subprocess.Popen[str]:
    program = [sys.executable, "-c", "from xei_lang.cli.main import run; run()", *args]
    own = {"PYTHONPATH": str(ROOT), "NO_COLOR": "1", "XDG_CACHE_HOME": str(cwd / ".cache")}
    environment = {**os.environ, **own, **(env or {})}
    return subprocess.Popen(
        program, cwd=cwd, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def xei(*args: str, cwd: Path, env: dict[str, str] | None = None, timeout: float = 120.0) -> Ran:
    process = start(*args, cwd=cwd, env=env)
    out, err = process.communicate(timeout=timeout)
    assert "Traceback" not in err, err
    return Ran(process.returncode, out, err)
