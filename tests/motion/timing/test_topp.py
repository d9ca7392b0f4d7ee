"""Trajectories keep every limit between grid points too, and say why where none exists."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.ir.timed import JointLimit, Knots
from xei_lang.motion.paths.joint_path import blended_path, line_path, spline_path
from xei_lang.motion.timing.samples import evaluate, sample
from xei_lang.motion.timing.topp import TimingFailure, parameterise

JOINTS = ("a", "b", "c", "d")
LIMITS = tuple(JointLimit(joint, -3.0, 3.0, 2.5, 8.0, 5.0) for joint in JOINTS)


def pendulum(q: np.ndarray, _dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
    """Four separate pendulums of unit inertia with 3 N m of gravity."""
    return ddq * 0.5 + 3.0 * np.sin(q)


@pytest.mark.parametrize("maker", [blended_path, spline_path])
@settings(deadline=None, max_examples=15)
@given(seed=st.integers(0, 10_000))
def test_all_limits_hold_at_one_kilohertz(maker: object, seed: int) -> None:
    waypoints = np.random.default_rng(seed).uniform(-1.5, 1.5, (5, 4))
    path = maker(JOINTS, waypoints)  # type: ignore[operator]
    knots = parameterise(path, LIMITS, pendulum)
    assert isinstance(knots, Knots)
    q, dq, ddq = evaluate(knots, np.arange(0.0, knots.times_s[-1], 1e-3))
    assert np.abs(dq).max() <= 2.5
    assert np.abs(ddq).max() <= 8.0
    assert np.abs(pendulum(q, dq, ddq)).max() <= 5.0


def test_a_straight_line_reaches_a_limit() -> None:
    knots = parameterise(line_path(JOINTS, np.zeros(4), np.ones(4)), LIMITS)
    assert isinstance(knots, Knots)
    _, dq, ddq = evaluate(knots, np.linspace(0.0, knots.times_s[-1], 500))
    assert max(np.abs(dq).max() / 2.5, np.abs(ddq).max() / 8.0) > 0.97


def test_half_speed_takes_twice_as_long() -> None:
    path = spline_path(JOINTS, np.random.default_rng(1).uniform(-1, 1, (4, 4)))
    full, half = parameterise(path, LIMITS), parameterise(path, LIMITS, speed_fraction=0.5)
    assert isinstance(full, Knots) and isinstance(half, Knots)
    assert half.times_s[-1] == pytest.approx(2.0 * full.times_s[-1], rel=1e-3)


def test_a_joint_that_cannot_hold_its_load_is_named() -> None:
    limits = (*LIMITS[:2], JointLimit("c", -3.0, 3.0, 2.5, 8.0, 2.0), LIMITS[3])
    failure = parameterise(line_path(JOINTS, np.zeros(4), np.full(4, 1.2)), limits, pendulum)
    assert isinstance(failure, TimingFailure)
    assert failure.joint == "c"
    assert failure.value > failure.limit == 2.0


def test_no_motion_takes_no_time() -> None:
    knots = parameterise(line_path(JOINTS, np.ones(4), np.ones(4) + 1e-8), LIMITS, pendulum)
    assert isinstance(knots, Knots)
    assert knots.times_s[-1] == 0.0


def test_samples_end_exactly_at_the_end() -> None:
    knots = parameterise(line_path(JOINTS, np.zeros(4), np.ones(4)), LIMITS)
    assert isinstance(knots, Knots)
    samples = sample(knots, 2.0, 100.0)
    assert samples.times_s[0] == 2.0
    assert samples.times_s[-1] == 2.0 + knots.times_s[-1]
    assert samples.positions[-1] == pytest.approx((1.0,) * 4, abs=1e-9)
    assert samples.velocities[-1] == pytest.approx((0.0,) * 4, abs=1e-6)


@pytest.mark.parametrize("fraction", [0.45, 0.2, 0.08, 0.02])
def test_a_corner_far_sharper_than_the_grid_is_timed_too(fraction: float) -> None:
    waypoints = np.random.default_rng(3).uniform(-1.5, 1.5, (7, 4))
    knots = parameterise(blended_path(JOINTS, waypoints, fraction), LIMITS, pendulum)
    assert isinstance(knots, Knots)
    _, dq, ddq = evaluate(knots, np.arange(0.0, knots.times_s[-1], 1e-4))
    assert np.abs(dq).max() <= 2.5
    assert np.abs(ddq).max() <= 8.0
