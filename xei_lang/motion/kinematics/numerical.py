"""Numerical inverse kinematics for arms that are not S-R-S: damped least squares from seeded restarts.

Wampler, "Manipulator Inverse Kinematic Solutions Based on Vector Formulations and Damped Least-Squares
Methods", IEEE T-SMC 16(1), 1986, with the damping following the error (Sugihara, IEEE T-RO 27(5), 2011). It
may miss postures, and poses.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics.solver import Solutions
from xei_lang.motion.robot import Array, Robot, Side

pin: Any = importlib.import_module("pinocchio")  # ships no type information

SEED = 20
RESTARTS = 40
ITERATIONS = 100
TOLERANCE = 1e-10
SWIVEL_JOINT = 2
_ALL = np.arange(7)
_WITHOUT_SWIVEL = np.delete(_ALL, SWIVEL_JOINT)


@dataclass(frozen=True, slots=True)
class NumericalArm:
    """See `Solver`. The swivel angle is the third joint's angle; a branch is a bit set of the joints that
    stand below the middle of their limits: 1 the second, 2 the sixth, 4 the fourth. Along `at_many` only the
    first pose's branch is held, later ones follow it.
    """

    robot: Robot
    side: Side

    @property
    def name(self) -> str:
        """`numerical-lm`."""
        return "numerical-lm"

    def solve(self, T_base_tool: Array, slide_m: float) -> Solutions:
        """What the restarts find, each once."""
        found: list[Array] = []
        for seed in self._seeds(RESTARTS):
            q = self._descend(T_base_tool, slide_m, seed, _ALL)
            if q is not None and all(float(np.abs(q - other).max()) > 1e-3 for other in found):
                found.append(q)
        found.sort(key=lambda q: (self.describe(q)[1], self.describe(q)[0]))
        told = [self.describe(q) for q in found]
        return Solutions(
            q=np.array(found).reshape(-1, 7),
            swivel_angle=np.array([angle for angle, _ in told]),
            branch=np.array([branch for _, branch in told], dtype=np.int64),
        )

    def solve_many(self, T_base_tool: Array, slide_m: float | Array) -> list[Solutions]:
        """`solve`, pose by pose."""
        heights = np.broadcast_to(np.asarray(slide_m, dtype=np.float64), (len(T_base_tool),))
        return [self.solve(T, float(height)) for T, height in zip(T_base_tool, heights, strict=True)]

    def at(self, T_base_tool: Array, slide_m: float, swivel_angle: float, branch: int) -> Array | None:
        """The first restart's result on this branch."""
        return self._first(T_base_tool, slide_m, swivel_angle, lambda q: self.describe(q)[1] == branch)

    def at_many(
        self, T_base_tool: Array, slide_m: float | Array, swivel_angle: float | Array, branch: int
    ) -> tuple[Array, NDArray[np.bool_]]:
        """`at` for the first pose, then each from the one before."""
        count = len(T_base_tool)
        heights = np.broadcast_to(np.asarray(slide_m, dtype=np.float64), (count,))
        angles = np.broadcast_to(np.asarray(swivel_angle, dtype=np.float64), (count,))
        rows, valid = np.zeros((count, 7)), np.zeros(count, dtype=np.bool_)
        previous: Array | None = None
        for k, (T, height, angle) in enumerate(zip(T_base_tool, heights, angles, strict=True)):
            if previous is None:
                q = self.at(T, float(height), float(angle), branch)
            else:
                previous[SWIVEL_JOINT] = angle
                q = self._descend(T, float(height), previous, _WITHOUT_SWIVEL)
            if q is not None:
                rows[k], valid[k], previous = q, True, q.copy()
        return rows, valid

    def describe(self, q_arm: Array) -> tuple[float, int]:
        """The third joint's angle and the branch."""
        lower, upper = self._limits()
        below = q_arm < (lower + upper) / 2
        return float(q_arm[SWIVEL_JOINT]), int(below[1]) + 2 * int(below[5]) + 4 * int(below[3])

    def reach_shortfall(self, T_base_tool: Array, slide_m: float) -> float:
        """A lower bound: the distance past the arm stretched out, link after link."""
        arm = self.robot.arm(self.side)
        q = np.zeros(self.robot.nq)
        q[self.robot.slide_index] = slide_m
        frames = (*arm.joint_names[1:], arm.tool_frame)
        points = np.array([self.robot.T_base_frame(q, frame)[:3, 3] for frame in frames])
        stretched = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        return max(0.0, float(np.linalg.norm(T_base_tool[:3, 3] - points[0])) - stretched)

    def _first(
        self, T_base_tool: Array, slide_m: float, swivel_angle: float, accepts: Callable[[Array], bool]
    ) -> Array | None:
        lower, upper = self._limits()
        if not lower[SWIVEL_JOINT] <= swivel_angle <= upper[SWIVEL_JOINT]:
            return None
        for seed in self._seeds(RESTARTS):
            seed[SWIVEL_JOINT] = swivel_angle
            q = self._descend(T_base_tool, slide_m, seed, _WITHOUT_SWIVEL)
            if q is not None and accepts(q):
                return q
        return None

    def _limits(self) -> tuple[Array, Array]:
        span = self.robot.arm(self.side).span
        return self.robot.lower[span], self.robot.upper[span]

    def _seeds(self, count: int) -> Array:
        lower, upper = self._limits()
        return np.random.default_rng(SEED).uniform(lower, upper, (count, 7))

    def _descend(
        self, T_base_tool: Array, slide_m: float, seed: Array, free: NDArray[np.int64]
    ) -> Array | None:
        """Descend over the `free` joints within limits; None where the error stays above the tolerance."""
        arm = self.robot.arm(self.side)
        columns = np.array(arm.q_indices)[free]
        lower, upper = self.robot.lower[columns], self.robot.upper[columns]
        q = np.zeros(self.robot.nq)
        q[self.robot.slide_index], q[arm.span] = slide_m, seed
        for _ in range(ITERATIONS):
            error = _pose_error(self.robot.T_base_frame(q, arm.tool_frame), T_base_tool)
            square = float(error @ error)
            if square < TOLERANCE * TOLERANCE:
                return q[arm.span].copy()
            J = self.robot.jacobian(q, arm.tool_frame)[:, columns]
            step = J.T @ np.linalg.solve(J @ J.T + (0.1 * square + 1e-12) * np.eye(6), error)
            q[columns] = np.clip(q[columns] + step, lower, upper)
        return None


def _pose_error(T_base_now: Array, T_base_goal: Array) -> Array:
    """The twist (6,), linear then angular in base axes, that leads from one pose to the other."""
    turn = pin.log3(T_base_goal[:3, :3] @ T_base_now[:3, :3].T)
    return np.concatenate([T_base_goal[:3, 3] - T_base_now[:3, 3], turn])
