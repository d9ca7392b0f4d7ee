"""The smallest upright box, cylinder or sphere around points, about the z axis of an object's frame.

A mesh is contained to the last vertex. Of a point cloud, single points far from all others are left out, and
then the outermost half percent of each coordinate, so that noise does not make an object larger.
"""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from xei_lang.ir.geometry import Box, Cylinder, Shape, Sphere, Vec3
from xei_lang.profiles.assets.points import Array

Kind = Literal["box", "cylinder", "sphere"]
TRIM_PERCENT = 0.5
_NEIGHBOURS = 8
_STRAY = 3.0
_FITTED = 50_000
_ROUND = 0.02


@dataclass(frozen=True, slots=True)
class Extent:
    """The box along the axes that holds the points; `radius_m` is their largest distance from the z axis,
    `ball_m` from the point of that axis half way up from the frame to the top. Metres.
    """

    lower_m: Vec3
    upper_m: Vec3
    radius_m: float
    ball_m: float

    @property
    def size_m(self) -> Vec3:
        """The edges of the box."""
        x, y, z = (high - low for low, high in zip(self.lower_m, self.upper_m, strict=True))
        return (x, y, z)

    @property
    def bottom_m(self) -> Vec3:
        """The centre of the bottom of the box."""
        (x0, y0, z0), (x1, y1, _) = self.lower_m, self.upper_m
        return ((x0 + x1) / 2, (y0 + y1) / 2, z0)


def extent_of(points_m: Array, *, is_noisy: bool) -> Extent:
    """How far points (n x 3, m, in the object's frame) reach; of those of a scan, which `is_noisy`, the
    outermost are left out.
    """
    trim = TRIM_PERCENT if is_noisy else 0.0
    lower, upper = np.percentile(points_m, (trim, 100.0 - trim), axis=0)
    middle = np.array((0.0, 0.0, upper[2] / 2))
    radius = np.percentile(np.hypot(points_m[:, 0], points_m[:, 1]), 100.0 - trim)
    ball = np.percentile(np.linalg.norm(points_m - middle, axis=1), 100.0 - trim)
    return Extent(_vec(lower), _vec(upper), float(radius), float(ball))


def fit(extent: Extent, kind: Kind | None) -> Shape:
    """A shape that stands on the object's frame; without a `kind`, that of the least volume.

    A sphere is taken unasked only where it is as high as the points, to 2 %.
    """
    height = extent.upper_m[2]
    half_x, half_y = (max(abs(extent.lower_m[axis]), abs(extent.upper_m[axis])) for axis in (0, 1))
    shapes: dict[Kind, tuple[float, Shape]] = {
        "box": (4 * half_x * half_y * height, Box((_um(2 * half_x), _um(2 * half_y), _um(height)))),
        "cylinder": (math.pi * extent.radius_m**2 * height, Cylinder(_um(extent.radius_m), _um(height))),
        "sphere": (4 / 3 * math.pi * extent.ball_m**3, Sphere(_um(extent.ball_m))),
    }
    if kind is not None:
        return shapes[kind][1]
    is_ball = abs(2 * extent.ball_m - height) <= _ROUND * height
    fitting = [made for name, made in shapes.items() if name != "sphere" or is_ball]
    return min(fitting, key=lambda made: made[0])[1]


def without_strays(points: Array) -> Array:
    """The points that have neighbours: those whose mean distance to the next 8 is at most three times the
    median of that (Rusu et al., Towards 3D Point Cloud Based Object Maps, 2008, with a median for the mean).
    Of more than 50 000 points, sorted by x, every n-th is kept.
    """
    spatial: Any = importlib.import_module("scipy.spatial")  # ships no type information
    alone = np.unique(points, axis=0)
    some = alone[:: -(-len(alone) // _FITTED)]
    if len(some) <= _NEIGHBOURS:
        return some
    distances: Array = spatial.cKDTree(some).query(some, k=_NEIGHBOURS + 1)[0]
    mean = distances[:, 1:].mean(axis=1)
    return some[mean <= _STRAY * np.median(mean)]


def _vec(values: Array) -> Vec3:
    x, y, z = (float(value) for value in values)
    return (x, y, z)


def _um(length_m: float) -> float:
    """Rounded to a micrometre: files of 32 bit numbers hold no more."""
    return round(length_m, 6)
