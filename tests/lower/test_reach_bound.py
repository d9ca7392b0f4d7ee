"""A parameter that is longer than an arm is told at its own line; motion planning has nothing to find out."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from tests.lower.plans import FOLDER, bench, put_on_rack, with_skill
from tests.lower.test_jaws_hold import grasped
from tests.lower.test_refusals import refused, skill
from xei_lang.diagnostics import Span
from xei_lang.lower import lower
from xei_lang.lower.robot import arm_length_m
from xei_lang.motion.verify.robot import Robot
from xei_lang.profiles.model import OperationDefault, Profile
from xei_lang.quantity import parse_quantity

WRITTEN = Span("development.yaml", 5, 9)


def defaulted(name: str, parameter: str, value: str) -> Profile:
    spec = skill(name)
    kept = tuple(item for item in spec.parameters if item.name != parameter)
    said = OperationDefault(parameter, parse_quantity(value), WRITTEN)
    return with_skill(bench()[0], replace(spec, parameters=(*kept, said)))


FAR = [
    ("pick", "lift", "30 m"),
    ("pick", "lift", "2.5 m"),
    ("pick", "standoff", "80 m"),
    ("insert", "approach_height", "30 m"),
]


@pytest.mark.parametrize(("name", "parameter", "value"), FAR)
def test_a_default_of_a_skill_that_is_longer_than_an_arm(name: str, parameter: str, value: str) -> None:
    found = refused(put_on_rack(), defaulted(name, parameter, value))
    assert (found.code, found.span) == ("XEI0702", WRITTEN)
    assert found.message == f"`{parameter}` of {value} is farther than an arm reaches"


@pytest.mark.parametrize(("parameter", "value"), [("lift", "30 m"), ("standoff", "80 m")])
def test_a_grasp_that_says_more_than_an_arm(parameter: str, value: str) -> None:
    found = refused(put_on_rack(), grasped("tube_1", **{parameter: value}))
    assert found.message == f"`{parameter}` of {value} is farther than an arm reaches"


@pytest.mark.parametrize(
    ("name", "parameter", "value"), [("pick", "lift", "400 mm"), ("pick", "standoff", "300 mm")]
)
def test_what_an_arm_may_reach_is_left_to_motion_planning(name: str, parameter: str, value: str) -> None:
    graph, problems = lower(put_on_rack(), defaulted(name, parameter, value), bench()[1])
    assert graph is not None, problems


@pytest.mark.parametrize("side", ["left", "right"])
def test_no_posture_reaches_farther_than_the_bound(side: str) -> None:
    urdf = (FOLDER / "robot" / "openarm_mobile.urdf").read_text(encoding="utf-8")
    robot, dice = Robot(urdf), random.Random(7)
    for _ in range(200):
        q = np.zeros(robot.size)
        for k in range(1, 8):
            joint = robot.joints[f"openarm_{side}_joint{k}"]
            q[joint.column] = dice.uniform(joint.lower, joint.upper)
        tool = robot.pose(q, f"openarm_{side}_grasp").position_m
        shoulder = robot.pose(np.zeros(robot.size), f"openarm_{side}_link2").position_m
        assert np.linalg.norm(np.subtract(tool, shoulder)) <= arm_length_m(bench()[0], side) + 1e-9
