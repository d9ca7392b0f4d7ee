"""Time-optimal path parameterisation by reachability analysis (Pham and Pham, IEEE T-RO 34(3), 2018).

Interpolation discretisation with constant path acceleration between grid points keeps the limits between
grid points too (worst seen 1.0003 of the limit); the limits are scaled by `HEADROOM`, so that the exact
trajectory stays inside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from xei_lang.ir.timed import JointLimit, Knots, Row
from xei_lang.motion.paths.joint_path import Array, JointPath

HEADROOM = 0.98
"""Share of each velocity, acceleration and torque limit that a plan may use."""

_GRID_INTERVALS = (100, 200, 400)
_STILL = 1e-6

InverseDynamics = Callable[[Array, Array, Array], Array]
"""Torques (m, n) of the joints (N m, N for the slide) for positions, velocities, accelerations (m, n)."""

PathSpeed = Callable[[Array], Array]
"""The largest path speed ds/dt (m,) that is allowed at path positions (m,), infinite where nothing is."""


@dataclass(frozen=True, slots=True)
class TimingFailure:
    """No parameterisation exists: `joint` cannot hold even a standstill, or no speed keeps all the limits."""

    reason: str
    joint: str = ""
    value: float = 0.0
    limit: float = 0.0


def parameterise(
    path: JointPath,
    limits: tuple[JointLimit, ...],
    inverse_dynamics: InverseDynamics | None = None,
    speed_fraction: float = 1.0,
    fastest: PathSpeed | None = None,
) -> Knots | TimingFailure:
    """The fastest rest-to-rest motion along the path within the limits of its joints.

    `limits` stand in the order of `path.joints`; `speed_fraction` in (0, 1] scales velocities by itself and
    accelerations by its square, as slowing down time does. `fastest` bounds the path speed as well, for a
    tool that may not go faster.
    """
    if np.ptp(path.sampled(path.length / 8), axis=0).max() < _STILL:
        return still(path)
    stuck = _static_overload(path, limits, inverse_dynamics)
    if stuck is not None:
        return stuck
    for intervals in _GRID_INTERVALS:
        grid = _grid(path, intervals)
        speeds = _solve(path, grid, limits, inverse_dynamics, speed_fraction, fastest)
        if speeds is not None:
            knots = _knots(path, grid, speeds)
            if _keeps_limits(path, grid, speeds, limits, inverse_dynamics, fastest):
                return knots
    return TimingFailure("no speed along the path keeps the velocity, acceleration and torque limits")


def still(path: JointPath, duration_s: float = 0.0) -> Knots:
    """A trajectory that stays where the path starts."""
    return Knots((0.0, 1.0), ((_row(path.start),),), (0.0, duration_s), (0.0, 0.0), (0.0, 0.0), (0.0,))


def _grid(path: JointPath, intervals: int) -> Array:
    """Grid points: an even division, finer towards the slow ends, and every piece of the path divided,

    for a sharp corner is a piece that is shorter than an interval, and its curvature vanishes at its two
    ends.
    """
    even = path.length * np.linspace(0.0, 1.0, intervals + 1)
    ends = path.length * np.array([0.001, 0.004, 0.996, 0.999])
    share = np.linspace(0.0, 1.0, intervals // 12 + 1)
    within = (path.breaks[:-1, None] + np.diff(path.breaks)[:, None] * share).ravel()
    grid = np.unique(np.concatenate([path.breaks, even, ends, within]))
    keep = np.concatenate([[True], np.diff(grid) > 1e-7 * path.length])
    grid = grid[keep]
    grid[-1] = path.length
    return grid


def _solve(
    path: JointPath,
    grid: Array,
    limits: tuple[JointLimit, ...],
    inverse_dynamics: InverseDynamics | None,
    speed_fraction: float,
    fastest: PathSpeed | None,
) -> Array | None:
    from xei_lang.motion.timing.toppra_solver import solve_toppra

    velocity = np.array([limit.velocity for limit in limits]) * HEADROOM * speed_fraction
    acceleration = np.array([limit.acceleration for limit in limits]) * HEADROOM * speed_fraction**2
    torque = np.array([limit.torque for limit in limits]) * HEADROOM
    cap = None if fastest is None else HEADROOM * fastest(grid)
    return solve_toppra(path, grid, velocity, acceleration, torque, inverse_dynamics, cap)


def _static_overload(
    path: JointPath, limits: tuple[JointLimit, ...], inverse_dynamics: InverseDynamics | None
) -> TimingFailure | None:
    """The joint that cannot even hold the arm against gravity somewhere on the path, worst first."""
    if inverse_dynamics is None:
        return None
    q = path.sampled(path.length / 16)
    holding = np.abs(inverse_dynamics(q, np.zeros_like(q), np.zeros_like(q))).max(axis=0)
    bounds = np.array([limit.torque for limit in limits]) * HEADROOM
    worst = int(np.argmax(holding / bounds))
    if holding[worst] <= bounds[worst]:
        return None
    reason = "holding still against gravity needs more torque than the joint may give"
    return TimingFailure(reason, path.joints[worst], float(holding[worst]), limits[worst].torque)


def _keeps_limits(
    path: JointPath,
    grid: Array,
    speeds: Array,
    limits: tuple[JointLimit, ...],
    inverse_dynamics: InverseDynamics | None,
    fastest: PathSpeed | None,
) -> bool:
    """Whether the exact motion keeps all limits within each grid interval too, at five places of each.

    A coarse grid can miss the bend of a rounded corner; then the caller takes a finer one.
    """
    share = np.linspace(0.01, 0.99, 5)
    squares = speeds**2
    s = (grid[:-1, None] + np.diff(grid)[:, None] * share).ravel()
    ds_squared = (squares[:-1, None] + np.diff(squares)[:, None] * share).ravel()[:, None]
    dds = np.repeat(np.diff(squares) / (2.0 * np.diff(grid)), len(share))[:, None]
    slope = path.evaluate(s, 1)
    velocity = slope * np.sqrt(ds_squared)
    acceleration = path.evaluate(s, 2) * ds_squared + slope * dds
    bounds = np.array([[limit.velocity, limit.acceleration, limit.torque] for limit in limits]).T
    kept = bool(np.all(np.abs(velocity) <= bounds[0]) and np.all(np.abs(acceleration) <= bounds[1]))
    kept = kept and (fastest is None or bool(np.all(ds_squared[:, 0] <= fastest(s) ** 2)))
    if not kept or inverse_dynamics is None:
        return kept
    return bool(np.all(np.abs(inverse_dynamics(path.evaluate(s, 0), velocity, acceleration)) <= bounds[2]))


def _knots(path: JointPath, grid: Array, speeds: Array) -> Knots:
    """Exact piecewise form from grid positions and path speeds, with constant acceleration between them."""
    squares = speeds**2
    dds = np.diff(squares) / (2.0 * np.diff(grid))
    times = np.concatenate([[0.0], np.cumsum(2.0 * np.diff(grid) / (speeds[:-1] + speeds[1:]))])
    coefficients = tuple(tuple(_row(row) for row in piece) for piece in path.coefficients)
    return Knots(_row(path.breaks), coefficients, _row(times), _row(grid), _row(speeds), _row(dds))


def _row(values: Any) -> Row:
    return tuple(np.asarray(values, dtype=float).tolist())
