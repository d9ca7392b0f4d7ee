"""RRT-Connect (Kuffner and LaValle, ICRA 2000) from OMPL, made a pure function of its seed."""

from __future__ import annotations

from typing import Any

import numpy as np
from ompl import base, geometric, util  # pyright: ignore[reportMissingTypeStubs]

from xei_lang.motion.paths.joint_path import Array
from xei_lang.motion.paths.space import FreeSpace

RANGE_S = 0.35
"""Longest extension of a tree, as seconds of motion at full speed."""


class _Edges(base.MotionValidator):
    """Edges are checked by the collision room's own certificate, not by OMPL's sampling."""

    def __init__(self, information: Any, space: FreeSpace, budget: list[int]) -> None:
        super().__init__(information)
        self._space = space
        self._budget = budget

    def checkMotion(self, s1: Any, s2: Any, *_last_valid: Any) -> bool:
        self._budget[0] -= 1
        return self._space.edge_is_free(_configuration(self._space, s1), _configuration(self._space, s2))


def rrt_connect(space: FreeSpace, q_start: Array, q_goal: Array, seed: int, max_checks: int) -> Array | None:
    """Waypoints (m, n) of a free polyline, or None once `max_checks` edges have been tried.

    States are scaled by joint speed, so that distance means seconds.
    """
    util.setLogLevel(util.LogLevel.LOG_NONE)
    util.RNG.setSeed(seed % (2**31 - 1) + 1)
    state_space = _state_space(space)
    information = base.SpaceInformation(state_space)
    information.setStateValidityChecker(lambda state: space.is_free(_configuration(space, state)))
    budget = [max_checks]
    information.setMotionValidator(_Edges(information, space, budget))
    information.setup()
    problem = base.ProblemDefinition(information)
    problem.setStartAndGoalStates(_state(state_space, space, q_start), _state(state_space, space, q_goal))
    planner = geometric.RRTConnect(information)
    planner.setRange(RANGE_S)
    planner.setProblemDefinition(problem)
    planner.setup()
    planner.solve(base.PlannerTerminationCondition(lambda: budget[0] <= 0))
    if not problem.hasExactSolution():
        return None
    found: Any = problem.getSolutionPath()
    points = [_configuration(space, found.getState(i)) for i in range(found.getStateCount())]
    points[0], points[-1] = q_start, q_goal
    return np.stack(points)


def _state_space(space: FreeSpace) -> Any:
    dimension = len(space.joints)
    state_space = base.RealVectorStateSpace(dimension)
    bounds = base.RealVectorBounds(dimension)
    for i in range(dimension):
        bounds.setLow(i, float(space.lower[i] / space.speed[i]))
        bounds.setHigh(i, float(space.upper[i] / space.speed[i]))
    state_space.setBounds(bounds)
    return state_space


def _state(state_space: Any, space: FreeSpace, q: Array) -> Any:
    state = state_space.allocState()
    for i, value in enumerate(np.clip(q, space.lower, space.upper) / space.speed):
        state[i] = float(value)
    return state


def _configuration(space: FreeSpace, state: Any) -> Array:
    return np.array([state[i] for i in range(len(space.joints))]) * space.speed
