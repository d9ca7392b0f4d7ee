"""What all tests share: golden files, and the flag that rewrites them."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

from tests.mdtest import run_markdown

# Deadlines measure the machine, not the code; a fixed seed lets a failure be had again.
settings.register_profile("xei", deadline=None, derandomize=True)
settings.load_profile("xei")

# Hundreds of tests start the program: each start would compile all of its modules anew.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

# A shell's background job ignores interrupts, and so would every program that a test starts and interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Read once, when the first test imports MuJoCo: without a screen, pictures are rendered through EGL.
os.environ.setdefault("MUJOCO_GL", "egl")

GOLDEN = Path(__file__).parent / "golden"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden", action="store_true", help="write what golden tests and markdown tests produce"
    )


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    return bool(request.config.getoption("--update-golden"))


def golden_comparer(*, update: bool) -> Callable[[str, str], None]:
    """Compares a text with a file under tests/golden/, or writes it there."""

    def compare(name: str, text: str) -> None:
        path = GOLDEN / name
        if update:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")
        if not path.exists():
            pytest.fail(f"{path} is missing; review the output and run pytest with --update-golden")
        assert text == path.read_bytes().decode(), f"differs from {path}; --update-golden writes it anew"

    return compare


@pytest.fixture
def golden(update_golden: bool) -> Callable[[str, str], None]:
    """`golden("name.txt", text)` compares with tests/golden/name.txt; a missing file fails."""
    return golden_comparer(update=update_golden)


@pytest.fixture
def markdown(update_golden: bool) -> Callable[[Path, Callable[[str], str]], None]:
    """`markdown(path, produce)` runs every section of a markdown test; see tests/mdtest.py."""

    def run(path: Path, produce: Callable[[str], str]) -> None:
        run_markdown(path, produce, update=update_golden)

    return run
