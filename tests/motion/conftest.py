"""The bench's robot, loaded once."""

from __future__ import annotations

from pathlib import Path

import pytest

from xei_lang.motion.robot import Robot, load_robot

ROBOT_FOLDER = Path(__file__).parents[2] / "profiles" / "openarm_bench" / "robot"


@pytest.fixture(scope="session")
def urdf_text() -> str:
    return (ROBOT_FOLDER / "openarm_mobile.urdf").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def srdf_text() -> str:
    return (ROBOT_FOLDER / "openarm_mobile.srdf").read_text(encoding="utf-8")


@pytest.fixture(scope="session")
def robot(urdf_text: str, srdf_text: str) -> Robot:
    return load_robot(urdf_text, srdf_text)
