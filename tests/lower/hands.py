"""Hands and objects as bodies of the collision library: boxes of the robot's description at tool poses."""

from __future__ import annotations

import re
from functools import lru_cache

import coal
import numpy as np

from tests.lower.plans import FOLDER
from xei_lang.ir.geometry import Box, Cylinder, Pose, Vec3

Body = tuple[coal.CollisionGeometry, Pose]
"""A shape and where it is."""


@lru_cache(maxsize=1)
def hand_boxes() -> tuple[tuple[str, Vec3, Vec3], ...]:
    """Centres and sizes of the right hand's collision boxes, each with its link, from the URDF."""
    text = (FOLDER / "robot" / "openarm_mobile.urdf").read_text(encoding="utf-8")
    pattern = (
        r'<collision name="openarm_right_(hand|left_finger|right_finger)_\d+">'
        r'<origin xyz="([^"]*)" rpy="0 0 0"/><geometry><box size="([^"]*)"/>'
    )
    found = [(link, vector(center), vector(size)) for link, center, size in re.findall(pattern, text)]
    assert len(found) == 13
    return tuple(found)


def vector(text: str) -> Vec3:
    x, y, z = (float(word) for word in text.split())
    return (x, y, z)


def links_in_tool(gap_m: float) -> dict[str, Vec3]:
    """Origins of hand and fingers in the grasp frame, the jaws opened to a gap.

    The grasp frame is 6 mm along y and 80 mm along z of the hand.
    """
    return {
        "hand": (0.0, -0.006, -0.08),
        "right_finger": (0.0, -0.006 - gap_m / 2, -0.065),
        "left_finger": (0.0, 0.006 + gap_m / 2, -0.065),
    }


def hand(T_x_tool: Pose, gap_m: float, only: str = "") -> list[Body]:
    """The boxes of a hand, or of its links whose names end in `only`."""
    origins = links_in_tool(gap_m)
    bodies: list[Body] = []
    for link, center, size in hand_boxes():
        if link.endswith(only):
            x, y, z = (a + b for a, b in zip(origins[link], center, strict=True))
            bodies.append((coal.Box(*size), T_x_tool @ Pose((x, y, z))))
    return bodies


def body(shape: Box | Cylinder, T_x_object: Pose) -> Body:
    """An object whose origin is the middle of its bottom."""
    if isinstance(shape, Box):
        return coal.Box(*shape.size_m), T_x_object @ Pose((0.0, 0.0, shape.size_m[2] / 2))
    geometry = coal.Cylinder(shape.radius_m, shape.height_m)
    return geometry, T_x_object @ Pose((0.0, 0.0, shape.height_m / 2))


def apart_m(first: list[Body], second: list[Body]) -> float:
    """The least distance between two groups of bodies, metres; negative where they overlap."""
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    distances: list[float] = []
    for a, T_a in first:
        for b, T_b in second:
            result.clear()
            distances.append(coal.distance(a, placed(T_a), b, placed(T_b), request, result))
    return min(distances)


def placed(pose: Pose) -> coal.Transform3s:
    matrix = np.array(pose.matrix())
    return coal.Transform3s(matrix[:3, :3], matrix[:3, 3])
