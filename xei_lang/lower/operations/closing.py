"""How jaws may close on an upright shape: from which headings, across what width."""

from __future__ import annotations

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Shape, Sphere
from xei_lang.lower.operations.grasp_ways import FACES_X_RAD, FACES_Y_RAD, ROUND_RAD
from xei_lang.record import Record, record

MIN_CLEARANCE_M = 0.001
"""The least room between each jaw and the object as the open hand comes in."""


@record
class Closing(Record):
    """One way to close: the width between the jaws, half the depth across them, and the headings (rad) it
    allows.
    """

    width_m: float
    half_depth_m: float
    headings_rad: tuple[float, ...]


def closings(shape: Shape) -> tuple[Closing, ...]:
    """The ways to close on a shape whose axis is z: any heading on a round one, two pairs of faces on a
    box.
    """
    if isinstance(shape, Box):
        x, y, _ = shape.size_m
        return (Closing(y, x / 2, FACES_X_RAD), Closing(x, y / 2, FACES_Y_RAD))
    return (Closing(2 * shape.radius_m, shape.radius_m, ROUND_RAD),)


def height_of(shape: Shape) -> float:
    """Height of a shape from its bottom to its top, metres."""
    if isinstance(shape, Box):
        return shape.size_m[2]
    if isinstance(shape, Sphere):
        return 2 * shape.radius_m
    return shape.height_m + (2 * shape.radius_m if isinstance(shape, Capsule) else 0.0)


def is_round(shape: Shape) -> bool:
    """Whether the shape may be turned about its z axis without any difference."""
    return isinstance(shape, (Cylinder, Sphere, Capsule))
