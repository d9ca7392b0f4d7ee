"""How tolerances add up along a way: bounds linearly, standard deviations in quadrature, a mix as both."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chi2, norm

from tests.world.test_transforms import NAMES, PARENTS, POSES, VECTORS, world_of
from xei_lang.ir.geometry import IDENTITY, Pose, Vec3
from xei_lang.ir.tolerance import SIGMAS, ToleranceKind, as_bound, tolerance_text
from xei_lang.ir.world import Frame, World
from xei_lang.world.transforms import lookup, verify_transform

FRAMES = st.sampled_from((*NAMES, "world"))


@st.composite
def worlds(draw: st.DrawFn, kinds: tuple[ToleranceKind, ...] = ("bound", "std")) -> World:
    frames = []
    for name in NAMES:
        tolerances = draw(st.floats(0.0, 0.01)), draw(st.floats(0.0, 0.1))
        kind = draw(st.sampled_from(kinds))
        frames.append(Frame(name, PARENTS[name], draw(POSES), "measured", *tolerances, kind))
    return world_of(frames)


def all_as(world: World, kind: ToleranceKind) -> World:
    return replace(world, frames=tuple(replace(frame, tolerance_as=kind) for frame in world.frames))


@given(worlds(), st.sampled_from(NAMES), FRAMES, VECTORS)
def test_a_longer_chain_is_never_known_better(world: World, source: str, target: str, point: Vec3) -> None:
    """The same point, told in a frame that is nearer to the other end of the way."""
    longer = lookup(world, target, source, point)
    for link in longer.links:
        if link.name == source:
            shorter = lookup(world, target, link.parent, link.T_parent_frame.apply(point))
            assert longer.position_tolerance_m >= shorter.position_tolerance_m - 1e-12
            assert longer.rotation_tolerance_rad >= shorter.rotation_tolerance_rad - 1e-12


@given(worlds(), FRAMES, FRAMES, VECTORS)
def test_the_parts_of_a_mixed_way_are_those_of_its_links(
    world: World, target: str, source: str, point: Vec3
) -> None:
    found = lookup(world, target, source, point)
    bounds = [one.position_m for one in found.shares if one.link.tolerance_as == "bound"]
    deviations = [one.position_m for one in found.shares if one.link.tolerance_as == "std"]
    assert found.position_bound_m == pytest.approx(sum(bounds))
    assert found.position_std_m == pytest.approx(math.sqrt(sum(value**2 for value in deviations)))
    assert found.position_tolerance_m == pytest.approx(found.position_bound_m + 3.0 * found.position_std_m)
    assert found.rotation_tolerance_rad == pytest.approx(
        found.rotation_bound_rad + 3.0 * found.rotation_std_rad
    )
    assert [one.link for one in found.shares] == list(found.links)


@given(worlds(), FRAMES, FRAMES, VECTORS)
def test_quadrature_is_never_more_than_the_linear_sum(
    world: World, target: str, source: str, point: Vec3
) -> None:
    bounds = lookup(all_as(world, "bound"), target, source, point)
    deviations = lookup(all_as(world, "std"), target, source, point)
    assert deviations.position_std_m <= bounds.position_bound_m + 1e-12
    assert deviations.rotation_std_rad <= bounds.rotation_bound_rad + 1e-12
    assert deviations.position_bound_m == bounds.position_std_m == 0.0
    if len(bounds.links) == 1 and bounds.links[0].rotation_tolerance_rad == 0.0:
        assert deviations.position_std_m == pytest.approx(bounds.position_bound_m)


def sampled(world: World, target: str, source: str, point: Vec3, seed: int, count: int) -> np.ndarray:
    """Errors (count, 3) of a point in the target, with normal errors in all links."""
    random = np.random.default_rng(seed)
    stated = lookup(world, target, source).T_target_source.apply(point)
    errors = np.empty((count, 3))
    for index in range(count):
        frames = []
        for frame in world.frames:
            shift = random.normal(0.0, frame.position_tolerance_m, 3)
            turn = random.normal(0.0, frame.rotation_tolerance_rad, 3)
            half = np.linalg.norm(turn) / 2
            x, y, z = (float(value) for value in turn / 2 * np.sinc(half / np.pi))
            at = frame.T_parent_frame
            position = tuple(float(a + b) for a, b in zip(at.position_m, shift, strict=True))
            wrong = Pose(position, at.quaternion) @ Pose((0.0, 0.0, 0.0), (x, y, z, math.cos(half)))
            frames.append(replace(frame, T_parent_frame=wrong))
        actual = lookup(world_of(frames), target, source).T_target_source.apply(point)
        errors[index] = np.subtract(actual, stated)
    return errors


def chain(position_m: float, rotation_rad: float) -> World:
    """Three links of an arm's length each, turned against each other, known to standard deviations."""
    poses = [Pose.from_rpy((0.3, 0.1 * k, 0.2), (0.4 * k, -0.3, 0.7)) for k in range(3)]
    parents = ("world", "base", "slide")
    return world_of([
        Frame(name, parent, at, "measured", position_m, rotation_rad, "std")
        for name, parent, at in zip(NAMES, parents, poses, strict=False)
    ])  # fmt: skip


RATE_ALONG = 2 * norm.cdf(SIGMAS) - 1
RATE_IN_SPACE = float(chi2.cdf(SIGMAS**2, 3))


def test_the_stated_rates_are_those_of_three_standard_deviations() -> None:
    assert round(RATE_ALONG, 3) == 0.997
    assert round(RATE_IN_SPACE, 3) == 0.971


@pytest.mark.parametrize(("position_m", "rotation_rad"), [(1e-3, 0.0), (5e-4, 2e-3), (0.0, 3e-3)])
@pytest.mark.parametrize(("target", "source"), [("world", "camera"), ("camera", "world")])
def test_sampled_errors_stay_within_the_tolerance_at_the_expected_rate(
    position_m: float, rotation_rad: float, target: str, source: str
) -> None:
    world, point, count = chain(position_m, rotation_rad), (0.2, -0.1, 0.4), 3000
    errors = sampled(world, target, source, point, 7, count)
    tolerance = lookup(world, target, source, point).position_tolerance_m
    noise = 3.5 * math.sqrt(RATE_IN_SPACE * (1 - RATE_IN_SPACE) / count)
    rate = float((np.linalg.norm(errors, axis=1) <= tolerance).mean())
    assert rate >= RATE_IN_SPACE - noise
    if rotation_rad == 0.0:  # the same in all directions: the rate is met, and not just undercut
        assert rate <= RATE_IN_SPACE + noise
    along = (np.abs(errors) <= tolerance).mean(axis=0)
    assert along.min() >= RATE_ALONG - 3.5 * math.sqrt(RATE_ALONG * (1 - RATE_ALONG) / count)


@given(worlds(kinds=("std",)), FRAMES, FRAMES, VECTORS)
def test_the_deviation_is_at_least_that_of_the_first_order_covariance(
    world: World, target: str, source: str, point: Vec3
) -> None:
    """The covariance of the point from the lever of each link; its largest eigenvalue is the least certain
    direction.
    """
    found = lookup(world, target, source, point)
    covariance = np.zeros((3, 3))
    for share in found.shares:
        frame = share.link.name
        lever = np.subtract(
            lookup(world, target, source).T_target_source.apply(point),
            lookup(world, target, frame).T_target_source.position_m,
        )
        turned = np.dot(lever, lever) * np.eye(3) - np.outer(lever, lever)
        covariance += share.link.position_tolerance_m**2 * np.eye(3)
        covariance += share.link.rotation_tolerance_rad**2 * turned
    largest = float(np.linalg.eigvalsh(covariance)[-1])
    assert found.position_std_m**2 >= largest - 1e-12
    if len(found.shares) == 1:
        assert found.position_std_m**2 == pytest.approx(largest, abs=1e-12)


@pytest.mark.parametrize(("kind", "most"), [("bound", 1.0), ("std", 3.0)])
def test_a_measurement_may_be_off_by_the_bound_or_by_three_deviations(
    kind: ToleranceKind, most: float
) -> None:
    frame = Frame("table", "world", IDENTITY, "measured", 0.001, 0.01, kind)
    for share, within in ((0.99, True), (1.01, False)):
        shifted, turned = share * most * 0.001, share * most * 0.01
        assert verify_transform(frame, Pose((shifted, 0.0, 0.0))).within == within
        assert verify_transform(frame, Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, turned))).within == within


def test_a_tolerance_says_which_it_is() -> None:
    assert tolerance_text(0.003, math.radians(0.5), "bound") == "3 mm and 0.5 deg"
    assert tolerance_text(0.0002, math.radians(0.01), "std") == "3 x (0.2 mm and 0.01 deg)"
    assert as_bound(0.1, "bound") == 0.1
    assert as_bound(0.1, "std") == pytest.approx(0.3)
