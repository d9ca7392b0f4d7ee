"""Whether a straight line in joint space is free of collision, between its samples too.

A bound on how far any point moves along the line turns clearance at one configuration into a certificate for
a stretch of it: with every pair at least `margin` apart, no pair touches until it has closed by `margin`.
Stretches that a wide margin does not certify are split and tried with a narrower one, as in Schwarzer, Saha,
Latombe, "Exact Collision Checking of Robot Paths" (WAFR 2002). What remains below the narrowest margin is
sampled so densely that no two bodies close by more than 0.5 mm unseen: a touch deeper than that, on top of
the scene's padding, is never missed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.collision.bodies import Geometry, ball
from xei_lang.motion.robot import Array, Robot

MARGINS_M = (0.04, 0.01, 0.0025)
UNSEEN_M = 0.0005


@dataclass(frozen=True, slots=True)
class MotionBound:
    """How far points move per unit of each joint: `lever` (p, nq) in m per rad or per m, one row for each
    sort of pair.

    Rows are the relative motion of pairs of bodies; what holds for the greatest row holds for all.
    """

    lever: Array

    def closing_m(self, q_start: Array, q_end: Array) -> float:
        """The most that any two bodies approach each other along the straight line."""
        return float((self.lever @ np.abs(q_end - q_start)).max(initial=0.0))


def edge_is_free(
    bound: MotionBound, q_start: Array, q_end: Array, is_clear: Callable[[Array, float], bool]
) -> bool:
    """Whether the line is free. `is_clear(q, margin_m)` tells whether nothing is nearer than the margin."""
    closing = bound.closing_m(q_start, q_end)
    open_stretches: list[tuple[float, float]] = [(0.0, 1.0)]
    for margin in MARGINS_M:
        pieces = [piece for stretch in open_stretches for piece in _split(stretch, closing, margin)]
        open_stretches.clear()
        for start, end in pieces:
            q = q_start + (start + end) / 2 * (q_end - q_start)
            if not is_clear(q, margin):
                if not is_clear(q, 0.0):
                    return False
                open_stretches.append((start, end))
    return all(
        is_clear(q_start + (start + end) / 2 * (q_end - q_start), 0.0)
        for stretch in open_stretches
        for start, end in _split(stretch, closing, UNSEEN_M)
    )


def _split(stretch: tuple[float, float], closing_m: float, margin_m: float) -> list[tuple[float, float]]:
    """Pieces of a stretch within which nothing closes by more than the margin from the piece's middle."""
    start, end = stretch
    count = max(1, int(np.ceil((end - start) * closing_m / (2.0 * margin_m))))
    cuts = np.linspace(start, end, count + 1).tolist()
    return list(pairwise(cuts))


def motion_bound(robot: Robot, geometry: Geometry, checked: NDArray[np.bool_]) -> MotionBound:
    """Levers of all pairs (g, g) that are checked, one row for each two joints that carry such a pair.

    A joint that moves both bodies of a pair or neither brings them no nearer to each other.
    """
    own = _levers(robot, geometry)
    first, second = np.nonzero(checked)
    carriers = geometry.joint[first] * (robot.nq + 1) + geometry.joint[second]
    order = np.argsort(carriers, kind="stable")
    first, second, carriers = first[order], second[order], carriers[order]
    starts = np.flatnonzero(np.diff(carriers, prepend=-1))
    if len(starts) == 0:
        return MotionBound(np.zeros((0, robot.nq)))
    moves = own > 0.0
    differ = moves[first[starts]] ^ moves[second[starts]]
    farthest = np.maximum.reduceat(own[first], starts) + np.maximum.reduceat(own[second], starts)
    return MotionBound(np.where(differ, farthest, 0.0))


def _levers(robot: Robot, geometry: Geometry) -> Array:
    """(g, nq): a bound on how far any point of a geometry moves per unit of a joint; 0 for joints that do not
    move it.

    For a revolute joint this is the distance to its axis, bounded by a polyline from a point of the axis over
    points of the axes between, whose lengths no joint changes.
    """
    axes = axes_of(robot)
    levers = np.zeros((len(geometry.names), robot.nq))
    for row, (carrier, item) in enumerate(
        zip(geometry.joint.tolist(), geometry.model.geometryObjects, strict=True)
    ):
        if carrier == 0:
            continue
        joint, (middle, radius) = carrier, ball(item)
        center = axes[joint].rotation @ middle + axes[joint].origin
        reach = float(np.linalg.norm(center - axes[joint].point)) + radius
        while joint > 0:
            levers[row, joint - 1] = reach if axes[joint].revolute else 1.0
            parent = int(robot.model.parents[joint])
            if parent > 0:
                reach += float(np.linalg.norm(axes[joint].point - axes[parent].point)) + axes[joint].travel_m
            joint = parent
    return levers


@dataclass(frozen=True, slots=True)
class Axis:
    """A joint in base_link with all joints at zero; `point` lies on its axis, near the next joint or the one
    before.
    """

    rotation: Array
    origin: Array
    point: Array
    revolute: bool
    travel_m: float


def axes_of(robot: Robot) -> dict[int, Axis]:
    """The axes of all joints by pinocchio's joint index."""
    zero = np.zeros(robot.nq)
    axes: dict[int, Axis] = {}
    for index, name in enumerate(robot.joint_names, start=1):
        T, twist = robot.T_base_frame(zero, name), robot.jacobian(zero, name)[:, index - 1]
        revolute = bool(np.linalg.norm(twist[3:]) > 0.5)
        parent = axes.get(int(robot.model.parents[index]))
        point = T[:3, 3]
        if revolute:
            follows = parent is not None and parent.revolute
            near = parent.point if parent is not None and follows else _next_origin(robot, index)
            point = point + twist[3:] * float(twist[3:] @ (near - point))
        travel = 0.0 if revolute else float(max(abs(robot.lower[index - 1]), abs(robot.upper[index - 1])))
        axes[index] = Axis(T[:3, :3], T[:3, 3], point, revolute, travel)
    return axes


def _next_origin(robot: Robot, index: int) -> Array:
    """Where the first joint that this one carries has its origin, or this one's own."""
    parents = [int(parent) for parent in robot.model.parents]
    child = next((k for k, parent in enumerate(parents) if parent == index), index)
    return robot.T_base_frame(np.zeros(robot.nq), robot.joint_names[child - 1])[:3, 3]
