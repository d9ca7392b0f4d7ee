"""Laws of joint paths: they hit their ends, pass near their waypoints and never kink."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.motion.paths.joint_path import JointPath, blended_path, line_path, spline_path

JOINTS = ("a", "b", "c")
points = st.lists(
    st.tuples(*(st.floats(-2.0, 2.0).map(lambda x: round(x, 3)) for _ in JOINTS)), min_size=2, max_size=6
).map(np.array)


def make(kind: str, waypoints: np.ndarray) -> JointPath:
    if kind == "line":
        return line_path(JOINTS, waypoints[0], waypoints[-1])
    return blended_path(JOINTS, waypoints) if kind == "blend" else spline_path(JOINTS, waypoints)


@pytest.mark.parametrize("kind", ["line", "blend", "spline"])
@given(waypoints=points)
def test_a_path_starts_and_ends_where_it_should(kind: str, waypoints: np.ndarray) -> None:
    path = make(kind, waypoints)
    assert np.allclose(path.start, waypoints[0], atol=1e-8)
    assert np.allclose(path.end, waypoints[-1], atol=1e-7)


@pytest.mark.parametrize("kind", ["blend", "spline"])
@given(waypoints=points)
def test_a_path_is_continuous_with_its_first_two_derivatives(kind: str, waypoints: np.ndarray) -> None:
    path = make(kind, waypoints)
    for left, (start, end) in zip(
        path.coefficients, zip(path.breaks, path.breaks[1:], strict=False), strict=True
    ):
        if end == path.length:
            continue
        width = end - start
        order = np.arange(len(left))[:, None]
        value = (left * width**order).sum(axis=0)
        assert np.allclose(value, path.evaluate(np.array([end]), 0)[0], atol=1e-7)
        slope = (order * left * width ** np.maximum(order - 1, 0)).sum(axis=0)
        assert np.allclose(slope, path.evaluate(np.array([end]), 1)[0], atol=1e-6)


@given(waypoints=points)
def test_derivatives_agree_with_finite_differences(waypoints: np.ndarray) -> None:
    path = blended_path(JOINTS, waypoints)
    if path.length < 0.1:
        return
    s = np.linspace(0.01, path.length - 0.01, 40)
    h = 1e-6
    numeric = (path.evaluate(s + h, 0) - path.evaluate(s - h, 0)) / (2 * h)
    assert np.allclose(numeric, path.evaluate(s, 1), atol=1e-4)


@given(waypoints=points, fraction=st.floats(0.02, 0.45))
def test_a_rounded_corner_stays_inside_its_triangle(waypoints: np.ndarray, fraction: float) -> None:
    path = blended_path(JOINTS, waypoints, fraction)
    low, high = waypoints.min(axis=0), waypoints.max(axis=0)
    q = path.sampled(path.length / 50)
    assert np.all(q >= low - 1e-9) and np.all(q <= high + 1e-9)


def test_a_path_that_never_moves_is_a_line_of_no_length() -> None:
    path = blended_path(JOINTS, np.zeros((3, 3)))
    assert path.kind == "line"
    assert np.array_equal(path.end, np.zeros(3))
