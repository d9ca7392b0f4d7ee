"""What checking must not import: it has to start at once."""

from __future__ import annotations

import subprocess
import sys

HEAVY = ("numpy", "networkx", "pydantic", "pinocchio", "yaml", "lark", "scipy", "toppra")


def test_checking_imports_no_heavy_library() -> None:
    code = f"import sys, xei_lang.check; print([name for name in {HEAVY!r} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
