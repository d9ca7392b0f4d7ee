"""The openings of the bench's objects, from what the usage profile states of them."""

from __future__ import annotations

import pytest

from tests.lower.plans import bench
from xei_lang.ir.world import Opening
from xei_lang.profiles.grid import T_object_slot


def openings(name: str) -> tuple[Opening, ...]:
    item = bench()[1].find(name)
    assert item is not None
    return item.openings


def test_a_tube_is_open_at_its_top_down_to_a_bottom_as_thick_as_its_wall() -> None:
    (opening,) = openings("tube_1")
    assert opening.T_object_mouth.position_m == (0.0, 0.0, 0.118)
    assert opening.radius_m == pytest.approx(0.0147 / 2)
    assert opening.depth_m == pytest.approx(0.118 - (0.017 - 0.0147) / 2)


def test_the_holes_of_a_rack_are_its_slots() -> None:
    profile, _ = bench()
    rack = profile.object("rack_1")
    assert rack is not None
    (opening,) = openings("rack_1")
    assert (opening.radius_m, opening.depth_m) == (pytest.approx(0.009), pytest.approx(0.065))
    assert opening.counts == (4, 3)
    (x, y, z), (along_x, along_y) = opening.T_object_mouth.position_m, opening.pitch_m
    for key, column, row in (("A1", 0, 0), ("A4", 3, 0), ("C2", 1, 2)):
        slot = T_object_slot(rack, key)
        assert slot is not None
        assert slot.position_m == pytest.approx((x + column * along_x, y + row * along_y, z))


def test_a_box_of_tips_leaves_room_for_the_tip_that_a_pipette_takes() -> None:
    (opening,) = openings("tip_box_1")
    assert 0.0045 < opening.radius_m < 0.006
    assert opening.depth_m == pytest.approx(0.078)


def test_what_is_not_stated_to_be_open_is_solid() -> None:
    assert openings("table") == ()
    assert openings("pipette_1") == ()
