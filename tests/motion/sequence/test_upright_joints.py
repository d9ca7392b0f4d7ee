"""Turning a posture upright: what the search over joints steps along."""

from __future__ import annotations

import math

import numpy as np

from tests.motion.sequence.bench import bench, context
from xei_lang.motion.sequence.snapshot import first_snapshot
from xei_lang.motion.sequence.upright_joints import Upright

WITHIN_RAD = math.radians(4.0)


def test_a_projected_posture_is_upright_and_an_upright_one_stays() -> None:
    profile, world = bench()
    about = context(profile, world)
    robot, rest = about.robot, first_snapshot(about.robot, world).q
    columns = about.arm_indices("right")
    frame = robot.arm("right").tool_frame
    draw = np.random.default_rng(3)
    room = (np.full(3, -np.inf), np.full(3, np.inf))
    upright = Upright(robot, frame, np.array([1.0, 0.0, 0.0]), rest, columns, WITHIN_RAD, room)
    projected = 0
    for _ in range(50):
        q = draw.uniform(robot.lower[columns], robot.upper[columns])
        found = upright.project(q)
        if found is None:
            continue
        whole = rest.copy()
        whole[columns] = found
        up = robot.T_base_frame(whole, frame)[:3, :3] @ upright.axis
        assert up[2] >= math.cos(WITHIN_RAD)
        assert abs(found[0] - q[0]) < 1e-9
        again = upright.project(found)
        assert again is not None
        assert np.array_equal(again, found)
        projected += 1
    assert projected >= 25
