"""Tasks that need a place known better than it is: told once for a rack and a size of what goes into it, and
only where something must fit.
"""

from __future__ import annotations

from dataclasses import replace

from tests.lower.plans import bench, obj, plan, slot, spot, with_object
from xei_lang.ir.skill_plan import SkillPlan
from xei_lang.lower import imprecise_tasks
from xei_lang.quantity import quantity
from xei_lang.world.precision import Benches


def carried(*moves: tuple[str, str, str]) -> SkillPlan:
    calls = ({"object": obj(name), "to": slot(rack, key)} for name, rack, key in moves)
    return plan(*(("move_object", args) for args in calls))


def test_each_rack_is_told_of_once() -> None:
    profile, world = bench()
    moves = carried(("tube_1", "rack_2", "A1"), ("tube_2", "rack_2", "A2"), ("tube_1", "rack_1", "C1"))
    told = list(imprecise_tasks(moves, profile, world))
    assert [item.message for item in told] == [
        '`tube_1` may miss `rack_2.slot("A1")`',
        '`tube_1` may miss `rack_1.slot("C1")`',
    ]
    assert "`camera` (2.0 mm, 0.3 deg)" in told[0].notes[0]


def test_what_fits_worse_in_the_same_rack_is_told_of_too() -> None:
    profile, world = bench()
    tube = profile.object("tube_2")
    assert tube is not None
    wider = with_object(profile, "tube_2", replace(tube, size_m=(0.0175, 0.0175, tube.size_m[2])))
    moves = carried(("tube_1", "rack_2", "A1"), ("tube_2", "rack_2", "A2"), ("tube_3", "rack_2", "A3"))
    told = list(imprecise_tasks(moves, wider, world))
    assert [item.message for item in told] == [
        '`tube_1` may miss `rack_2.slot("A1")`',
        '`tube_2` may miss `rack_2.slot("A2")`',
    ]


def test_a_spot_asks_for_nothing() -> None:
    profile, world = bench()
    moves = plan(("move_object", {"object": obj("beaker_1"), "to": spot("table", "beaker")}))
    assert not list(imprecise_tasks(moves, profile, world))


def test_a_wide_chamfer_or_a_close_calibration_is_enough() -> None:
    profile, world = bench()
    rack = profile.object("rack_2")
    assert rack is not None and rack.slots is not None
    wide = with_object(profile, "rack_2", replace(rack, slots=replace(rack.slots, chamfer_m=0.01)))
    moves = carried(("tube_1", "rack_2", "A1"))
    assert not list(imprecise_tasks(moves, wide, world))
    exact = tuple(
        replace(frame, position_tolerance_m=0.0, rotation_tolerance_rad=0.0) for frame in world.frames
    )
    assert not list(imprecise_tasks(moves, profile, replace(world, frames=exact)))


def test_the_better_of_two_ways_counts() -> None:
    profile, world = bench()
    rack, tube = profile.object("rack_2"), profile.object("tube_1")
    assert rack is not None and tube is not None
    found = Benches.of(world, profile).slot(rack, "A1", tube)
    assert found is not None
    assert found.way.path == ("robot_base", "slide", "camera")
    blind = replace(profile, calibration=replace(profile.calibration, cameras=()))
    docked = Benches.of(world, blind).slot(rack, "A1", tube)
    assert docked is not None
    assert docked.way.path == ("robot_base", "world", "table")
    assert docked.tolerance_m > 0.08 > found.tolerance_m


def test_tips_and_openings_ask_for_a_place_known_well() -> None:
    profile, world = bench()
    pipette, arm = obj("pipette_1"), "right"
    steps = plan(
        ("attach_tip", {"pipette": pipette, "tip": slot("tip_box_1", "A1"), "arm": arm}),
        ("aspirate", {"pipette": pipette, "source": obj("tube_3"), "volume": quantity(1, "mL"), "arm": arm}),
        (
            "dispense",
            {"pipette": pipette, "target": obj("beaker_1"), "volume": quantity(1, "mL"), "arm": arm},
        ),
    )
    told = list(imprecise_tasks(steps, profile, world))
    assert [item.message for item in told] == [
        '`pipette_1` may miss `tip_box_1.slot("A1")`',
        "`pipette_1` may miss `tube_3`",
    ]
    assert "the tip takes an error of 0.8 mm" in told[0].label
    assert "the opening takes an error of 2.9 mm" in told[1].label
    exact = tuple(
        replace(frame, position_tolerance_m=0.0, rotation_tolerance_rad=0.0) for frame in world.frames
    )
    assert not list(imprecise_tasks(steps, profile, replace(world, frames=exact)))


def test_elements_of_a_screen_ask_for_a_place_known_well() -> None:
    profile, world = bench()
    screen = obj("incubator_screen")
    taps = plan(*(("tap", {"screen": screen, "element": name, "arm": "left"}) for name in ("start", "stop")))
    told = list(imprecise_tasks(taps, profile, world))
    assert [item.message for item in told] == ["`tap` may miss `start`"], "once for elements of one size"
    assert "the element takes an error of 5.0 mm, and may be" in told[0].label
    known = profile.object("incubator_screen")
    assert known is not None
    large = tuple(replace(item, size_m=(0.03, 0.03)) for item in known.elements)
    assert not list(
        imprecise_tasks(taps, with_object(profile, known.name, replace(known, elements=large)), world)
    )


def test_a_bench_is_looked_at_from_the_station_that_works_it() -> None:
    """Seen from the other station, three metres away, a turn of the camera would count for far more."""
    profile, world = bench()
    rack, tube = profile.object("rack_3"), profile.object("tube_1")
    assert rack is not None and tube is not None
    found = Benches.of(world, profile).slot(rack, "A1", tube)
    assert found is not None
    assert found.way.path == ("robot_base", "slide", "camera")
    (share,) = [one for one in found.way.shares if one.link.name == "camera"]
    assert share.lever_m < 1.2
