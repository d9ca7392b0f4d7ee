"""How much stays in a tilted vessel: closed forms where there are some, and the tilt that leaves a volume."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from xei_lang.lower.operations.vessel import Vessel

vessels = st.builds(Vessel, st.floats(0.005, 0.06), st.floats(0.02, 0.2))


@given(vessels, st.floats(0.0, 1.0))
def test_while_the_bottom_is_covered_the_level_falls_by_the_tangent(vessel: Vessel, share: float) -> None:
    tilt = share * math.atan2(vessel.height_m, 2 * vessel.radius_m)
    level = vessel.height_m - vessel.radius_m * math.tan(tilt)
    assert vessel.holds_m3(tilt) == pytest.approx(math.pi * vessel.radius_m**2 * level, rel=1e-9)


@given(vessels)
def test_level_with_the_middle_of_the_bottom_two_thirds_of_a_cube_stay(vessel: Vessel) -> None:
    tilt = math.atan2(vessel.height_m, vessel.radius_m)
    assert vessel.holds_m3(tilt) == pytest.approx(2 / 3 * vessel.radius_m**2 * vessel.height_m, rel=1e-9)


@given(vessels, st.floats(0.0, 1.0))
def test_the_tilt_leaves_what_is_to_stay(vessel: Vessel, share: float) -> None:
    tilt = vessel.tilt_rad(share * vessel.brimful_m3)
    assert 0.0 <= tilt <= math.pi / 2
    assert vessel.holds_m3(tilt) == pytest.approx(share * vessel.brimful_m3, abs=1e-6 * vessel.brimful_m3)


@given(vessels, st.floats(0.01, 0.999))
def test_what_stays_is_the_volume_under_the_level_plane_through_the_lip(vessel: Vessel, share: float) -> None:
    """Against a sum over strips of the bottom."""
    tilt, r, strips = share * math.pi / 2, vessel.radius_m, 2000
    total = 0.0
    for k in range(strips):
        u = r * (2 * (k + 0.5) / strips - 1.0)
        depth = max(0.0, vessel.height_m - (r - u) * math.tan(tilt))
        total += 2 * math.sqrt(r * r - u * u) * depth * 2 * r / strips
    assert vessel.holds_m3(tilt) == pytest.approx(total, abs=1e-4 * vessel.brimful_m3)
