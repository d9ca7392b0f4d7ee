"""The call to toppra, in a room of its own: its import costs half a second (it imports scipy's splines)."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

import numpy as np

from xei_lang.motion.paths.joint_path import Array, JointPath
from xei_lang.motion.timing.without_plots import without_plots

with without_plots():
    import toppra  # pyright: ignore[reportMissingTypeStubs]
    import toppra.algorithm  # pyright: ignore[reportMissingTypeStubs]
    import toppra.constraint  # pyright: ignore[reportMissingTypeStubs]
    from toppra.constraint.linear_constraint import (  # pyright: ignore[reportMissingTypeStubs]
        LinearConstraint,
        canlinear_colloc_to_interpolate,  # pyright: ignore[reportUnknownVariableType]
    )
    from toppra.interpolator import AbstractGeometricPath  # pyright: ignore[reportMissingTypeStubs]

_ANY_SPEED = 1e3

logging.getLogger("toppra").setLevel(logging.CRITICAL)


class _Path(AbstractGeometricPath):
    """A `JointPath` as toppra wants to see it."""

    def __init__(self, path: JointPath) -> None:
        self._path = path

    def __call__(self, path_positions: Any, order: int = 0) -> Any:
        positions = np.atleast_1d(np.asarray(path_positions, dtype=float))
        values = self._path.evaluate(positions, order)
        return values[0] if np.ndim(path_positions) == 0 else values

    @property
    def dof(self) -> int:
        return len(self._path.joints)

    @property
    def path_interval(self) -> Any:
        return np.array([0.0, self._path.length])


class _Torque(LinearConstraint):
    """|tau(q, dq, ddq)| within bounds, its coefficients taken from three batched inverse dynamics."""

    def __init__(self, inverse_dynamics: Any, bound: Array) -> None:
        super().__init__()
        self.discretization_type = toppra.constraint.DiscretizationType.Interpolation
        self.identical = True
        self._inverse_dynamics = inverse_dynamics
        self._bound = bound

    def compute_constraint_params(self, path: Any, gridpoints: Any, *_args: Any, **_kwargs: Any) -> Any:
        q, dq, ddq = path(gridpoints, 0), path(gridpoints, 1), path(gridpoints, 2)
        zero = np.zeros_like(q)
        gravity = self._inverse_dynamics(q, zero, zero)
        inertial = self._inverse_dynamics(q, zero, dq) - gravity
        velocity = self._inverse_dynamics(q, dq, ddq) - gravity
        select = np.vstack([np.eye(q.shape[1]), -np.eye(q.shape[1])])
        bounds = np.concatenate([self._bound, self._bound])
        interpolate: Callable[..., Any] = canlinear_colloc_to_interpolate  # pyright: ignore[reportUnknownVariableType]
        return interpolate(
            inertial, velocity, gravity, select, bounds, None, None, gridpoints, identical=True
        )


class _Cap(LinearConstraint):
    """The path speed within bounds (N+1,) at the grid points."""

    def __init__(self, fastest: Array) -> None:
        super().__init__()
        self.discretization_type = toppra.constraint.DiscretizationType.Interpolation
        self._squares = np.minimum(fastest, _ANY_SPEED) ** 2

    def compute_constraint_params(self, path: Any, gridpoints: Any, *_args: Any, **_kwargs: Any) -> Any:
        bounds = np.stack([np.zeros_like(self._squares), self._squares], axis=1)
        return None, None, None, None, None, None, bounds


def solve_toppra(
    path: JointPath,
    grid: Array,
    velocity: Array,
    acceleration: Array,
    torque: Array,
    inverse_dynamics: Any,
    fastest: Array | None = None,
) -> Array | None:
    """Path speeds ds/dt at the grid points, shape (N+1,), zero at both ends; None where no profile exists.

    Limits have shape (n,) and hold symmetrically: rad/s, rad/s2 and N m (m and N for prismatic joints).
    `fastest` (N+1,) bounds the path speed at the grid points as well.
    """
    constraints: list[Any] = [
        toppra.constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)),
        toppra.constraint.JointAccelerationConstraint(np.stack([-acceleration, acceleration], axis=1)),
    ]
    if inverse_dynamics is not None:
        constraints.append(_Torque(inverse_dynamics, torque))
    if fastest is not None:
        constraints.append(_Cap(fastest))
    instance = toppra.algorithm.TOPPRA(
        constraints,
        _Path(path),
        gridpoints=grid,
        solver_wrapper="seidel",
        parametrizer="ParametrizeConstAccel",
    )
    solution: Any = instance.compute_parameterization(0.0, 0.0)
    speeds = solution[1]
    if speeds is None or not np.all(np.isfinite(speeds)):
        return None
    speeds = np.maximum(np.asarray(speeds, dtype=float), 0.0)
    return speeds if np.all(speeds[:-1] + speeds[1:] > 0.0) else None
