"""Stated paths of the tool (arc, screw, raster) between two targets of a chain, in joint space.

Along a straight move the arm keeps its swivel angle. A stated path may need another one at its end than at
its start: a turn of the hand by more than one wrist joint gives is shared by the whole arm as the elbow
swings. So the swivel changes at a constant rate along it, by an amount that is chosen for the least motion
of the joints; slide and branch stay.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MoveTo
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.motion.kinematics import Solver
from xei_lang.motion.paths.tool_path import (
    StraightPath,
    SweepingPath,
    ToolPath,
    TurningPath,
    displacements,
)

Array = NDArray[np.float64]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int64]

JUMP_RAD = 0.7
"""A step of a joint between two samples that no continuous motion makes: a wrist that flips."""

_SWINGS_RAD = (0.0, *(sign * 0.2 * k for k in range(1, 13) for sign in (1.0, -1.0)))
_COARSE_RAD = math.radians(8.0)
_FEWEST, _MOST = 5, 60


@dataclass(frozen=True, slots=True)
class Leg:
    """A stated path, and what it does to the tool (m, 4, 4) at coarse shares (m,) of its way."""

    stated: Turn | Raster
    share: Array
    moved: Array
    thin: bool = False

    def thinned(self) -> Leg:
        """The leg at a few of its samples, its end first of all: what fails there need not be looked at
        closely.
        """
        few = np.unique(np.linspace(0, len(self.share) - 1, 4).round().astype(np.int64))[1:]
        return Leg(self.stated, self.share[few], self.moved[few], True)

    def seen_from(self, T_new_old: Array) -> Leg:
        """The leg as `follow` needs it where the base stands elsewhere."""
        return replace(self, moved=T_new_old @ self.moved @ np.linalg.inv(T_new_old))


def legs_of(moves: tuple[MoveTo, ...]) -> tuple[Leg | None, ...]:
    """Between each two moves of a chain: the stated path of the second, or None for a straight one."""
    return tuple(None if move.along is None else _leg(move.along) for move in moves[1:])


def _leg(path: Turn | Raster) -> Leg:
    count = math.ceil(abs(path.angle_rad) / _COARSE_RAD) if isinstance(path, Turn) else 8 * path.lanes
    share = np.linspace(0.0, 1.0, min(_MOST, max(_FEWEST, count)) + 1)
    return Leg(path, share, displacements(path, share))


def tool_path(leg: Leg | None, T_start: Array, T_end: Array) -> ToolPath:
    """The way of the tool between two targets (4, 4)."""
    if leg is None:
        return StraightPath(T_start, T_end)
    if isinstance(leg.stated, Turn):
        return TurningPath(T_start, leg.stated)
    return SweepingPath(T_start, leg.stated)


def follow(
    solver: Solver, leg: Leg, T_start: Array, height: Array, swivel: Array, branch: Ints
) -> tuple[Array, Bools]:
    """The swivel angle (n,) at the end of a leg that begins at tool poses (n, 4, 4) with these slide heights,
    swivel angles and branches (n,), and for which of them (n,) there is one: the nearest that holds.
    """
    ends, good = swivel.copy(), np.zeros(len(swivel), dtype=np.bool_)
    for code in np.unique(branch):
        rows = np.flatnonzero(branch == code)
        for swing in _SWINGS_RAD:
            left = rows[~good[rows]]
            if len(left) == 0:
                break
            for some in (leg.thinned(), leg):
                angle = swivel[left, None] + some.share * swing
                left = left[_holds(solver, some, T_start[left], height[left], angle, int(code))]
            holds = left
            ends[holds], good[holds] = swivel[holds] + swing, True
    return ends, good


def _holds(solver: Solver, leg: Leg, T_start: Array, height: Array, swivel: Array, branch: int) -> Bools:
    """Which rows (n,) keep limits and branch at all samples of the leg, with swivel angles (n, m) there."""
    rows, samples = swivel.shape
    poses = leg.moved[None] @ T_start[:, None]
    q, valid = solver.at_many(poses.reshape(-1, 4, 4), np.repeat(height, samples), swivel.reshape(-1), branch)
    steps = np.abs(np.diff(q.reshape(rows, samples, 7), axis=1)).max(axis=(1, 2))
    return valid.reshape(rows, samples).all(axis=1) & ((steps < JUMP_RAD) | leg.thin)
