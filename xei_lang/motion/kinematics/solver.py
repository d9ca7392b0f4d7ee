"""What both inverse kinematics solvers offer, and the choice between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.robot import Array, Robot, Side


@dataclass(frozen=True, slots=True)
class Solutions:
    """Configurations of one arm for one tool pose, n of them; n = 0 where there is none.

    q: (n, 7) in rad, within limits. swivel_angle: (n,) rad in [-pi, pi). branch: (n,) which of the discrete
    postures. Rows are ordered by branch, then by swivel angle.
    """

    q: Array
    swivel_angle: Array
    branch: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.branch)


class Solver(Protocol):
    """Inverse kinematics of one arm. Tool poses are `T_base_tool` (4, 4), the slide's height is in metres."""

    @property
    def name(self) -> str:
        """`srs-closed-form` or `numerical-lm`; reports show it."""
        ...

    def solve(self, T_base_tool: Array, slide_m: float) -> Solutions:
        """About twenty configurations that cover all postures within limits."""
        ...

    def solve_many(self, T_base_tool: Array, slide_m: float | Array) -> list[Solutions]:
        """`solve` for poses (m, 4, 4) at one slide height or at (m,) heights."""
        ...

    def at(self, T_base_tool: Array, slide_m: float, swivel_angle: float, branch: int) -> Array | None:
        """The one configuration (7,) with this swivel angle and branch; None where a limit or the reach
        forbids it.
        """
        ...

    def at_many(
        self, T_base_tool: Array, slide_m: float | Array, swivel_angle: float | Array, branch: int
    ) -> tuple[Array, NDArray[np.bool_]]:
        """`at` along poses (m, 4, 4): q (m, 7) and a mask (m,) of rows that are valid."""
        ...

    def describe(self, q_arm: Array) -> tuple[float, int]:
        """Swivel angle and branch of a configuration (7,), as `at` takes them."""
        ...

    def reach_shortfall(self, T_base_tool: Array, slide_m: float) -> float:
        """Metres by which the pose lies outside the arm's reach, its direction left aside; 0 within reach."""
        ...


def arm_solver(robot: Robot, side: Side) -> Solver:
    """The closed-form solver where the arm's axes meet as it needs them, else the numerical one."""
    from xei_lang.motion.kinematics.geometry import srs_geometry
    from xei_lang.motion.kinematics.numerical import NumericalArm
    from xei_lang.motion.kinematics.srs import srs_arm

    geometry = srs_geometry(robot, side)
    return NumericalArm(robot, side) if geometry is None else srs_arm(geometry)
