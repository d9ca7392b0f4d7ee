"""What never comes near each other is left out of a collision scene, and nothing else."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.ir.geometry import Box, Capsule, Pose, Primitive, Sphere
from xei_lang.motion.collision import AttachedBody, StaticBody
from xei_lang.motion.collision.bodies import robot_links, scene_geometry
from xei_lang.motion.collision.reach import reach_of
from xei_lang.motion.robot import Robot

pin: Any = importlib.import_module("pinocchio")

NEAR_M = 0.05
SHAPES = (Primitive(Box((0.3, 0.2, 0.1))), Primitive(Sphere(0.04)), Primitive(Capsule(0.02, 0.12)))
TUBE = (Primitive(Capsule(0.0085, 0.12), Pose((0.0, 0.0, 0.06))),)


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_pairs_that_come_near_are_all_asked(robot: Robot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    standing = tuple(
        StaticBody(
            f"body_{k}", (SHAPES[k % 3],), Pose(tuple(rng.uniform([-1.0, -1.5, 0.0], [1.5, 1.5, 2.0])))
        )
        for k in range(30)
    )
    held = AttachedBody("tube", TUBE, "right", Pose.from_rpy((0.059, 0.0, 0.0), (0.0, -1.5, 0.0)))
    links = robot_links(robot)
    geometry = scene_geometry(robot, links, standing, (held,))
    asked = reach_of(robot, links).may_meet(geometry, NEAR_M)
    every = np.triu(geometry.joint[:, None] != geometry.joint, 1)
    assert 0 < (every & ~asked).sum() < every.sum()
    geometry.model.setCollisionPairs(every & ~asked, True)
    data = pin.GeometryData(geometry.model)
    for q in rng.uniform(robot.lower, robot.upper, (20, robot.nq)):
        pin.computeDistances(robot.model, robot.data, geometry.model, data, q)
        assert min(result.min_distance for result in data.distanceResults) >= NEAR_M


def test_what_stands_within_reach_of_the_slide_is_asked(robot: Robot) -> None:
    """A body beside the shoulder, which no arm has to turn for to come near it, but at one height only."""
    links, q = robot_links(robot), np.zeros(robot.nq)
    q[robot.slide_index] = robot.upper[robot.slide_index]
    T = robot.T_base_frame(q, robot.arm("left").shoulder_frame)
    ball = StaticBody("ball", (Primitive(Sphere(0.01)),), Pose(tuple((T[:3, 3] + [0.2, 0.0, 0.0]).tolist())))
    far = StaticBody("far", (Primitive(Sphere(0.01)),), Pose((5.0, 0.0, 1.0)))
    geometry = scene_geometry(robot, links, (ball, far), ())
    asked = reach_of(robot, links).may_meet(geometry, NEAR_M)
    arm = [row for row, name in enumerate(geometry.names) if name.startswith("openarm_left")]
    assert asked[arm, -2].any()
    assert not asked[arm, -1].any()
