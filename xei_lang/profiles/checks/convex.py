"""Convex solids that stand, lean or lie in any way, and how deep two of them are in each other.

Whether two share a point is found with the Gilbert-Johnson-Keerthi algorithm (IEEE Journal of Robotics and
Automation 4(2), 1988) on support functions, so round things need no facets. In plain Python: a check of a
profile imports this.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Shape, Vec3

TOUCH_M = 1e-4
"""Solids that share less than this along some direction count as touching."""
_ITERATIONS = 64
_ON_ORIGIN = 1e-18
"""Square (m2) of a distance that is none."""


@dataclass(frozen=True, slots=True)
class Convex:
    """A box with half edges `half_m` along `axes` around `centre_m`; swept with a disc of `disc_m` across its
    z axis, and with a ball of `ball_m`. A cylinder is a disc along a line; a capsule is a ball along one.
    """

    centre_m: Vec3
    axes: tuple[Vec3, Vec3, Vec3]
    half_m: Vec3
    disc_m: float = 0.0
    ball_m: float = 0.0

    def support(self, direction: Vec3) -> Vec3:
        """The farthest point along a unit vector."""
        along = [_dot(direction, axis) for axis in self.axes]
        halves = zip(self.axes, self.half_m, along, strict=True)
        parts = [(axis, math.copysign(half, c)) for axis, half, c in halves]
        across = math.hypot(along[0], along[1])
        if self.disc_m > 0.0 and across > 0.0:
            parts += [(self.axes[k], self.disc_m * along[k] / across) for k in (0, 1)]
        parts.append((direction, self.ball_m))
        x, y, z = self.centre_m
        for (ax, ay, az), length in parts:
            x, y, z = x + length * ax, y + length * ay, z + length * az
        return (x, y, z)

    def reach_m(self, direction: Vec3) -> float:
        """How far it reaches from its centre along a unit vector, to either side alike."""
        along = [_dot(direction, axis) for axis in self.axes]
        boxed = sum(half * abs(c) for half, c in zip(self.half_m, along, strict=True))
        return boxed + self.disc_m * math.hypot(along[0], along[1]) + self.ball_m

    @property
    def radius_m(self) -> float:
        """The radius of a ball around its centre that holds it."""
        x, y, z = self.half_m
        return math.hypot(x + self.disc_m, y + self.disc_m, z) + self.ball_m

    def worn(self, by_m: float) -> Convex:
        """With a skin of this thickness taken off, as far as there is something to take."""
        x, y, z = (max(0.0, half - by_m) for half in self.half_m)
        return replace(
            self, half_m=(x, y, z), disc_m=max(0.0, self.disc_m - by_m), ball_m=max(0.0, self.ball_m - by_m)
        )


def convex(shape: Shape, pose: Pose) -> Convex:
    """A primitive at the pose of its centre."""
    centre, axes = pose.position_m, pose.axes()
    if isinstance(shape, Box):
        x, y, z = shape.size_m
        return Convex(centre, axes, (x / 2, y / 2, z / 2))
    if isinstance(shape, Cylinder):
        return Convex(centre, axes, (0.0, 0.0, shape.height_m / 2), disc_m=shape.radius_m)
    half = shape.height_m / 2 if isinstance(shape, Capsule) else 0.0
    return Convex(centre, axes, (0.0, 0.0, half), ball_m=shape.radius_m)


def convex_overlap_m(a: Convex, b: Convex) -> float:
    """How deep two solids are in each other, at most 0 where they are apart or touch.

    Along the axes of both, across pairs of them, and from centre to centre: for boxes these are all that can
    part them (the separating axis theorem), so the depth is exact; of round solids it is a bound from above,
    and solids that no such axis parts are tested without their skins.
    """
    depth_m = math.inf
    for axis in _candidates(a, b):
        apart_m = abs(_dot(axis, _minus(b.centre_m, a.centre_m)))
        depth_m = min(depth_m, a.reach_m(axis) + b.reach_m(axis) - apart_m)
        if depth_m <= TOUCH_M:
            return min(depth_m, 0.0)
    return depth_m if _share_a_point(a.worn(TOUCH_M / 2), b.worn(TOUCH_M / 2)) else 0.0


def _candidates(a: Convex, b: Convex) -> Iterator[Vec3]:
    yield from _unit(_minus(b.centre_m, a.centre_m))
    yield from a.axes
    yield from b.axes
    for one, other in itertools.product(a.axes, b.axes):
        yield from _unit(_cross(one, other))


def _share_a_point(a: Convex, b: Convex) -> bool:
    """Whether the difference of both sets holds the origin: a simplex of it is moved ever nearer."""
    nearest = _minus(a.centre_m, b.centre_m)
    simplex: list[Vec3] = []
    for _ in range(_ITERATIONS):
        length = math.sqrt(_dot(nearest, nearest))
        if length * length <= _ON_ORIGIN:
            return True
        towards = (-nearest[0] / length, -nearest[1] / length, -nearest[2] / length)
        away = (-towards[0], -towards[1], -towards[2])
        found = _minus(a.support(towards), b.support(away))
        if _dot(found, away) > 0.0:
            return False
        simplex, nearest = _nearest([*simplex, found])
        if len(simplex) == 4:
            return True
    return True


def _nearest(points: list[Vec3]) -> tuple[list[Vec3], Vec3]:
    """The point nearest to the origin of the hull of at most four points, and those that it lies between."""
    best: tuple[float, list[Vec3], Vec3] | None = None
    for count in range(len(points), 0, -1):
        for chosen in itertools.combinations(points, count):
            found = _foot(chosen)
            if found is None:
                continue
            if count == 4:
                return list(chosen), found
            distance = _dot(found, found)
            if best is None or distance < best[0]:
                best = (distance, list(chosen), found)
    assert best is not None
    return best[1], best[2]


def _foot(points: tuple[Vec3, ...]) -> Vec3 | None:
    """The foot of the origin on the plane, line or point through these; None where it is not between them."""
    first, *others = points
    edges = [_minus(point, first) for point in others]
    gram = [[_dot(one, other) for other in edges] for one in edges]
    weights = _solved(gram, [-_dot(edge, first) for edge in edges])
    if weights is None or any(weight < 0.0 for weight in weights) or sum(weights) > 1.0:
        return None
    x, y, z = first
    for weight, edge in zip(weights, edges, strict=True):
        x, y, z = x + weight * edge[0], y + weight * edge[1], z + weight * edge[2]
    return (x, y, z)


def _solved(matrix: list[list[float]], right: list[float]) -> list[float] | None:
    """The solution of at most three equations by Cramer's rule; None where they are (almost) dependent."""
    size = len(matrix)
    whole = _determinant(matrix)
    scale = math.prod(matrix[k][k] for k in range(size))
    if size and whole <= 1e-14 * scale:
        return None
    return [
        _determinant([[*row[:k], value, *row[k + 1 :]] for row, value in zip(matrix, right, strict=True)])
        / whole
        for k in range(size)
    ]


def _determinant(m: list[list[float]]) -> float:
    if len(m) == 3:
        first, second, third = ((row[0], row[1], row[2]) for row in m)
        return _dot(first, _cross(second, third))
    return m[0][0] * m[1][1] - m[0][1] * m[1][0] if len(m) == 2 else m[0][0] if m else 1.0


def _unit(vector: Vec3) -> Iterator[Vec3]:
    """The vector at unit length; nothing where it has no direction."""
    length = math.sqrt(_dot(vector, vector))
    if length > 1e-9:
        yield (vector[0] / length, vector[1] / length, vector[2] / length)


def _dot(a: Vec3, b: Vec3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Vec3, b: Vec3) -> Vec3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _cross(a: Vec3, b: Vec3) -> Vec3:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
