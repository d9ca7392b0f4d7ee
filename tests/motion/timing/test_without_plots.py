"""Planning loads no plotting library, and leaves it to those who draw."""

from __future__ import annotations

import subprocess
import sys

_ASKED = """
import sys
import xei_lang.motion.timing.toppra_solver
print(sorted(name for name in sys.modules if name.split(".")[0] == "matplotlib"))
"""


def test_the_solver_loads_no_matplotlib_and_hides_none() -> None:
    run = subprocess.run([sys.executable, "-c", _ASKED], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_a_real_one_stays() -> None:
    asked = "import matplotlib.pyplot as real" + _ASKED + "assert sys.modules['matplotlib.pyplot'] is real"
    run = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert "'matplotlib.pyplot'" in run.stdout
