"""AX = XB: exact data give the exact answer, noise gives a covariance that holds, and bad data a reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import chi2

from tests.world.calibration.scene import apart, pose, samples_of, seen_samples
from xei_lang.world.calibration.closed_form import park_martin
from xei_lang.world.calibration.hand_eye import HandEye, Unsolved, solve_hand_eye
from xei_lang.world.calibration.residuals import corner_residuals, moved, pose_residuals
from xei_lang.world.perception.optics import matrix_of

FOCAL = 920.0


def error(found: HandEye | Unsolved, X: np.ndarray) -> np.ndarray:
    assert isinstance(found, HandEye), found
    return apart(matrix_of(found.T_parent_camera), X)


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), count=st.integers(5, 12))
def test_exact_data_give_the_exact_answer(seed, count):
    X, Z, samples = samples_of(seed, count)
    found = solve_hand_eye(samples, FOCAL)
    assert np.abs(error(found, X)).max() < 1e-9
    assert np.abs(apart(matrix_of(found.T_target_board), Z)).max() < 1e-9


@settings(max_examples=10)
@given(seed=st.integers(0, 10**6))
def test_the_closed_form_alone_is_exact_too(seed):
    X, Z, samples = samples_of(seed, 6)
    start = park_martin(np.array([one.A for one in samples]), np.array([one.B for one in samples]))
    assert np.abs(apart(start.X, X)).max() < 1e-8
    assert np.abs(apart(start.Z, Z)).max() < 1e-8


@pytest.mark.parametrize("eye_in_hand", [True, False])
def test_exact_corners_give_the_exact_answer(eye_in_hand):
    X, _, samples = seen_samples(5, 8, noise_px=0.0, eye_in_hand=eye_in_hand)
    assert np.abs(error(solve_hand_eye(samples, FOCAL), X)).max() < 1e-9


def test_the_covariance_from_poses_holds():
    assert_holds([samples_of(seed, 25, position_m=5e-4, rotation_rad=2e-3) for seed in range(40)])


def test_the_covariance_from_corners_holds():
    assert_holds([seen_samples(seed, 15, noise_px=0.2) for seed in range(30)])


def assert_holds(recordings):
    """Normalised squared errors are chi-square with 6 degrees of freedom each; their sum is within 99.9 %."""
    squares = []
    for X, _, samples in recordings:
        found = solve_hand_eye(samples, FOCAL)
        motion = error(found, X)
        squares.append(motion @ np.linalg.solve(found.covariance, motion))
    low, high = chi2.ppf([0.0005, 0.9995], 6 * len(squares))
    assert low < sum(squares) < high


def test_refining_is_better_than_the_closed_form():
    closed, refined = [], []
    for seed in range(15):
        X, _, samples = samples_of(seed, 20, position_m=1e-4, rotation_rad=5e-3)
        start = park_martin(np.array([one.A for one in samples]), np.array([one.B for one in samples]))
        closed.append(np.linalg.norm(apart(start.X, X)[:3]))
        refined.append(np.linalg.norm(error(solve_hand_eye(samples, FOCAL), X)[:3]))
    assert np.median(refined) < np.median(closed)


@pytest.mark.parametrize("kind", ["poses", "corners"])
def test_jacobians_are_those_of_the_residuals(kind):
    if kind == "poses":
        X, Z, samples = samples_of(2, 5, position_m=1e-3, rotation_rad=1e-2)
        linear = pose_residuals(samples)
    else:
        X, Z, samples = seen_samples(2, 5, noise_px=1.0)
        linear = corner_residuals(samples, FOCAL)
    _, jacobian = linear(X, Z)
    for index in range(12):
        step = np.zeros(12)
        step[index] = 1e-6
        ahead, _ = linear(moved(X, step[:6]), moved(Z, step[6:]))
        behind, _ = linear(moved(X, -step[:6]), moved(Z, -step[6:]))
        numeric = (ahead - behind) / 2e-6
        assert np.abs(numeric - jacobian[:, index]).max() < 1e-5 * (1.0 + np.abs(numeric).max())


@pytest.mark.parametrize(
    ("recording", "reason"),
    [
        (samples_of(1, 4)[2], "too_few"),
        (samples_of(1, 20, axes=1)[2], "one_axis"),
        (samples_of(1, 20, turn_rad=0.01)[2], "no_rotation"),
        (samples_of(1, 1)[2] * 12, "no_rotation"),
        (samples_of(1, 20, position_m=0.03, rotation_rad=0.01)[2], "inconsistent"),
    ],
)
def test_motions_that_fix_nothing_are_refused(recording, reason):
    found = solve_hand_eye(recording, FOCAL)
    assert isinstance(found, Unsolved)
    assert found.reason == reason


@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_samples_that_contradict_the_others_are_named(noise):
    samples = samples_of(3, 20, position_m=noise * 5e-4, rotation_rad=noise * 2e-3)[2]
    for number, slip in ((7, pose([0.01, 0, 0], [0, 0.02, 0])), (12, pose([0.03, 0, 0], [0, 0.2, 0]))):
        samples[number - 1] = replace(samples[number - 1], B=samples[number - 1].B @ slip)
    found = solve_hand_eye(samples, FOCAL)
    assert isinstance(found, Unsolved)
    assert (found.reason, found.samples) == ("outlier", (7, 12))


def test_a_board_that_slipped_halfway_is_not_averaged_away():
    samples = samples_of(3, 20, position_m=5e-4, rotation_rad=2e-3)[2]
    slip = pose([0.0, 0.02, 0.0], [0.0, 0.0, 0.1])
    samples[10:] = [replace(one, B=one.B @ slip) for one in samples[10:]]
    found = solve_hand_eye(samples, FOCAL)
    assert isinstance(found, Unsolved)
    assert found.reason in ("inconsistent", "outlier")


def test_the_same_recording_gives_the_same_bytes():
    samples = samples_of(9, 15, position_m=5e-4, rotation_rad=2e-3)[2]
    first, second = (solve_hand_eye(samples, FOCAL) for _ in range(2))
    assert first.T_parent_camera == second.T_parent_camera
    assert first.covariance.tobytes() == second.covariance.tobytes()
