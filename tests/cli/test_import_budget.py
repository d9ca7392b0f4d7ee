"""`xei check` starts fast because it never imports what it does not use."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.cli.xei import ROOT, xei

HEAVY = (
    "toppra",
    "pinocchio",
    "coal",
    "casadi",
    "networkx",
    "rosbags",
    "numpy",
    "scipy",
    "ompl",
    "pydantic",
    "yaml",
    "jsonschema",
)

PROBE = """
import sys
from xei_lang.cli.main import run
try:
    run(["check", sys.argv[1]])
except SystemExit as stop:
    assert stop.code == 0, stop.code
print(" ".join(sorted(name for name in sys.argv[2].split() if name in sys.modules)))
"""


def test_a_check_with_an_unchanged_profile_imports_nothing_heavy(tmp_path: Path) -> None:
    protocol = str(ROOT / "protocols" / "put_on_rack.xei")
    assert xei("check", protocol, cwd=tmp_path).code == 0
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path / ".cache")}
    probed = subprocess.run(
        [sys.executable, "-c", PROBE, protocol, " ".join(HEAVY)], env=environment, cwd=tmp_path, text=True,
        capture_output=True, check=True,
    )  # fmt: skip
    assert probed.stdout.strip() == ""
