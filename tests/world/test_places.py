from __future__ import annotations

import pytest

from tests.world.bench import bench, world
from xei_lang.ir.skill_plan import PlaceRef
from xei_lang.world import places


def keys(found):
    return [place.key for place in found]


def rack():
    found = bench().object("rack_1")
    assert found is not None
    return found


def test_slots_come_row_by_row():
    assert keys(places.slots(rack())) == [f"{row}{column}" for row in "ABC" for column in range(1, 5)]
    assert keys(places.row(rack(), "B")) == ["B1", "B2", "B3", "B4"]
    assert keys(places.column(rack(), 2)) == ["A2", "B2", "C2"]


@pytest.mark.parametrize(
    "found",
    [places.row(rack(), "D"), places.row(rack(), "a"), places.column(rack(), 0), places.column(rack(), 5)],
)
def test_rows_and_columns_that_do_not_exist_are_empty(found):
    assert found == ()


def test_what_has_no_slots_has_none():
    table = bench().object("table")
    assert table is not None
    assert places.slots(table) == places.row(table, "A") == places.column(table, 1) == ()
    assert keys(places.spots(table)) == ["bottle", "beaker", "mixing", "front", "cradle", "reagent"]


@pytest.mark.parametrize("key", ["", "A", "A0", "A5", "A01", "A-1", "A1 ", "D1", "a1", "1A", "A\u0661"])
def test_keys_that_name_no_slot(key):
    place = PlaceRef("rack_1", "slot", key)
    assert not places.has_place(rack(), place)
    assert places.T_object_place(rack(), place) is None
    assert places.T_object_standing(rack(), place) is None


def test_wrong_keys_are_answered_with_near_ones():
    assert places.nearest_keys(rack(), "slot", "a1") == ("A1",)
    assert "A1" in places.nearest_keys(rack(), "slot", "A11")
    table = bench().object("table")
    assert table is not None
    assert places.nearest_keys(table, "spot", "botle") == ("bottle",)


def test_a_slot_is_where_the_grid_says():
    place = PlaceRef("rack_1", "slot", "B3")
    mouth, floor = places.T_object_place(rack(), place), places.T_object_standing(rack(), place)
    assert mouth is not None
    assert floor is not None
    assert mouth.position_m == pytest.approx((-0.125 + 0.035 + 2 * 0.06, -0.095 + 0.035 + 0.06, 0.07))
    assert floor.position_m == pytest.approx((*mouth.position_m[:2], 0.005))


def test_a_whole_surface_is_no_single_pose():
    surface = PlaceRef("rack_1", "surface", "")
    assert places.has_place(rack(), surface)
    assert places.T_object_place(rack(), surface) is None
    assert places.T_object_standing(rack(), surface) is None


def test_occupants_are_those_of_the_priors():
    taken = {
        key: places.initial_occupant(bench(), PlaceRef("rack_1", "slot", key)) for key in ("A1", "B3", "C4")
    }
    assert taken == {"A1": "tube_1", "B3": "tube_6", "C4": None}


def test_slots_take_only_what_they_accept():
    place = PlaceRef("rack_1", "slot", "A1")
    assert places.accepts(rack(), place, ("movable", "insert_object"))
    assert not places.accepts(rack(), place, ("movable",))
    assert places.accepts(rack(), PlaceRef("rack_1", "surface", ""), ("movable",))


def test_places_are_written_as_the_language_does():
    assert places.place_text(PlaceRef("rack_1", "slot", "A1")) == 'rack_1.slot("A1")'
    assert places.place_text(PlaceRef("table", "surface", "")) == "table"
    tube = world().find("tube_1")
    assert tube is not None
    assert tube.place == 'rack_1.slot("A1")'
