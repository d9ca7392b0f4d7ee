"""Sources merged: who wins, what moves along, what nobody places."""

from __future__ import annotations

import math

import pytest

from tests.world.bench import bench, world
from tests.world.sources.scenes import at, codes, free, grounded, read, scene, seen
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.grid import T_object_standing
from xei_lang.world.ground import ground, is_prior, observers
from xei_lang.world.sources import Observation
from xei_lang.world.sources.settle import HEIGHT_M, SPOT_M

QUARTER = -math.pi / 2


def test_without_observations_the_priors_hold():
    assert grounded() == world()
    assert observers(world()) == ()


def test_a_later_source_overrides_field_by_field():
    first = seen(
        Observation("tube_1", states=(("cap", "open"),)), at("beaker_1", 0.10, -0.33), source="scene_file a"
    )
    second = seen(at("beaker_1", 0.11, -0.33), source="pose_service b")
    found = grounded(first, second)
    tube, beaker = found.find("tube_1"), found.find("beaker_1")
    assert tube is not None
    assert beaker is not None
    assert dict(tube.states)["cap"] == "open"
    said = dict(tube.provenance)
    assert (said["states.cap"], said["pose"]) == ("scene_file a", "usage_profile prior")
    assert beaker.T_frame_object.position_m == pytest.approx((0.11, -0.33, 0.0))
    assert beaker.confidence == 0.9
    said = dict(beaker.provenance)
    assert (said["pose"], said["confidence"], said["size"]) == (
        "pose_service b",
        "pose_service b",
        "usage_profile",
    )
    assert found.sources == ("usage_profile", "object_registry", "scene_file a", "pose_service b")
    assert observers(found) == ("scene_file a", "pose_service b")
    assert not is_prior(beaker)
    assert is_prior(tube)


def test_what_stands_in_a_rack_that_was_seen_moves_with_it():
    found = grounded(seen(at("rack_1", 0.15, -0.14, yaw=QUARTER + 0.1)))
    T_before = world().T_world_object("rack_1").inverse()
    T_after = found.T_world_object("rack_1").inverse()
    for item in world().objects:
        if item.place.startswith("rack_1."):
            before, after = (
                T_before @ world().T_world_object(item.name),
                T_after @ found.T_world_object(item.name),
            )
            assert after.position_m == pytest.approx(before.position_m, abs=1e-12)
            assert after.quaternion == pytest.approx(before.quaternion, abs=1e-12)
            moved = found.find(item.name)
            assert moved is not None
            assert moved.place == item.place
            assert dict(moved.provenance)["pose"] == "usage_profile prior, moved with rack_1"
            assert is_prior(moved)


def test_what_was_seen_itself_does_not_move_with_its_rack():
    alone = free("tube_1")
    assert alone.T_frame_object is not None
    found = grounded(seen(at("rack_1", 0.13, -0.135, yaw=QUARTER), alone))
    tube = found.find("tube_1")
    assert tube is not None
    assert tube.place == ""
    assert tube.T_frame_object.position_m == pytest.approx(alone.T_frame_object.position_m)


def test_a_tube_seen_near_a_slot_stands_in_it():
    rack = bench().object("rack_2")
    assert rack is not None
    T_rack_floor = T_object_standing(rack, "slot", "B2")
    assert T_rack_floor is not None
    exact = world().T_world_object("rack_2") @ T_rack_floor
    x, y, z = exact.position_m
    seen_at = Observation(
        "tube_1", Pose.from_rpy((x + 0.005, y - 0.004, z + 0.006), (0.05, -0.03, 0.4)), "world", 0.8
    )
    tube = grounded(seen(seen_at)).find("tube_1")
    assert tube is not None
    assert tube.place == 'rack_2.slot("B2")'
    found = grounded(seen(seen_at)).T_world_object("tube_1")
    assert found.position_m == pytest.approx(exact.position_m)
    assert found.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert dict(tube.metadata)["seen.moved_mm"] == f"{1000 * math.hypot(0.005, 0.004, 0.006):.1f}"


def test_beyond_the_tolerance_it_is_in_the_way_of_the_rack():
    """Half in the wall of a slot, or far above its floor, nothing can stand."""
    x, y, z = world().T_world_object("rack_2").position_m
    assert codes(seen(at("tube_1", x, y, z + 2 * HEIGHT_M, frame="world"))) == ["XEI0658"]


def test_near_a_spot_it_stands_on_the_spot_where_it_was_seen():
    table = bench().object("table")
    assert table is not None
    spot = next(item for item in table.spots if item.name == "beaker").T_object_spot
    x, y, z = (world().T_world_object("table") @ spot).position_m
    near = grounded(seen(at("beaker_1", x + 0.6 * SPOT_M, y, z - 0.004, frame="world"))).find("beaker_1")
    assert near is not None
    assert near.place == 'table.spot("beaker")'
    assert near.frame_id == "table"
    found = grounded(seen(at("beaker_1", x + 0.6 * SPOT_M, y, z - 0.004, frame="world"))).T_world_object(
        "beaker_1"
    )
    assert found.position_m == pytest.approx((x + 0.6 * SPOT_M, y, z))
    far = grounded(seen(at("beaker_1", x + 1.1 * SPOT_M, y, z, frame="world"))).find("beaker_1")
    assert far is not None
    assert far.place == ""


def test_an_absent_object_is_nowhere_and_told():
    found, said = ground(bench(), (seen(Observation("rack_1", is_absent=True)),))
    assert found is not None
    assert found.find("rack_1") is None
    in_it = [item.name for item in world().objects if item.place.startswith("rack_1.")]
    assert in_it
    assert all(found.find(name) is None for name in in_it)
    assert {item.code for item in said} == {"XEI0660"}
    assert len(said) == 1 + len(in_it)


def test_who_said_that_it_is_absent_is_told():
    observed, _ = read(scene("tube_1: {absent: true}"))
    assert observed is not None
    _, (one,) = ground(bench(), (observed,))
    assert one.code == "XEI0660"
    assert one.message == "`tube_1` is not there: scene_file scene.yaml says that `tube_1` is absent"
    assert one.span is not None
    text = scene("tube_1: {absent: true}")
    assert (one.span.file, text[one.span.start : one.span.end]) == ("scene.yaml", "tube_1")
    _, said = ground(bench(), (seen(Observation("rack_1", is_absent=True)),))
    tube = next(one for one in said if one.message.startswith("`tube_1`"))
    assert tube.notes[0] == "its prior has it in `rack_1`"


@pytest.mark.parametrize("name", ["table", "floor", "table_b"])
def test_furniture_cannot_be_absent(name):
    world_, (one,) = ground(bench(), (seen(Observation(name, is_absent=True)),))
    assert world_ is None
    assert (one.code, one.message) == ("XEI0664", f"`{name}` cannot be absent: it belongs to the room")


def test_a_pose_after_an_absence_brings_it_back():
    gone = seen(Observation("beaker_1", is_absent=True))
    assert grounded(gone).find("beaker_1") is None
    assert grounded(gone, seen(at("beaker_1", 0.1, -0.33))).find("beaker_1") is not None


@pytest.mark.parametrize(
    ("observation", "code"),
    [
        (at("tube_99", 0.1, 0.1), "XEI0655"),
        (at("beaker_1", 0.1, -0.33, frame="tabel"), "XEI0655"),
        (at("beaker_1", 0.1, -0.33, frame="left_tool"), "XEI0655"),
        (Observation("tube_1", states=(("lid", "open"),)), "XEI0655"),
        (Observation("tube_1", states=(("cap", "ajar"),)), "XEI0655"),
        (Observation("rack_1", size_m=(250.0, 190.0, 70.0)), "XEI0656"),
        (Observation("rack_1", size_m=(0.00025, 0.00019, 0.00007)), "XEI0656"),
        (at("beaker_1", 0.12, -0.135), "XEI0658"),
        (at("beaker_1", 0.3, -0.3, -0.2), "XEI0658"),
        (at("beaker_1", 5.0, 0.0), "XEI0658"),
        (at("rack_1", 0.12, 0.135, yaw=QUARTER), "XEI0658"),
    ],
)
def test_what_cannot_be_is_refused(observation, code):
    assert set(codes(seen(observation))) == {code}


def test_two_things_in_one_slot_are_told_once():
    x, y, z = world().T_world_object("tube_2").position_m
    world_, found = ground(bench(), (seen(at("tube_1", x, y, z, frame="world")),))
    assert world_ is None
    (one,) = (item for item in found if item.severity == "error")
    assert one.message == '`tube_1` was seen in `rack_1.slot("A2")`, where `tube_2` is'
    assert one.help == ("look for `tube_2` too, or say that it is absent: only its prior has it there",)


def test_one_source_sees_a_thing_once():
    assert codes(seen(at("beaker_1", 0.1, -0.33), at("beaker_1", 0.1, -0.34))) == ["XEI0655"]


def test_another_size_is_a_warning():
    found, said = ground(bench(), (seen(Observation("rack_1", size_m=(0.2, 0.19, 0.07))),))
    assert found is not None
    assert [(item.code, item.severity) for item in said] == [("XEI0657", "warning")]


def test_sources_see_the_same_in_whatever_order_they_list_it():
    items = (at("rack_1", 0.13, -0.135, yaw=QUARTER), free("tube_1"), at("beaker_1", 0.09, -0.33))
    assert grounded(seen(*items)) == grounded(seen(*reversed(items)))


@pytest.mark.parametrize("lift_m", [-0.004, 0.004])
def test_what_stands_by_its_prior_on_a_table_that_was_seen_stands_on_it_as_it_was_seen(lift_m):
    """Eyes see a table a little higher or lower, and leaning: nothing then stands in it or floats over it."""
    x, y, z = world().T_world_object("table").position_m
    leaning = Pose.from_rpy((x, y, z + lift_m), (0.0005, -0.0007, 0.001))
    found = grounded(seen(Observation("table", leaning, "world", 0.9)))
    T_table_world = found.T_world_object("table").inverse()
    table, beaker = bench().object("table"), found.find("beaker_1")
    assert table is not None
    assert beaker is not None
    above = T_table_world.apply(found.T_world_object("beaker_1").position_m)[2] - table.size_m[2]
    assert above == pytest.approx(0.0, abs=1e-9)
    assert dict(beaker.provenance)["pose"] == "usage_profile prior, moved with table"


@pytest.mark.parametrize(("x", "y", "yaw"), [(0.015, 0.0, 0.0), (-0.04, 0.06, 0.09), (0.0, -0.08, -0.15)])
def test_what_has_its_prior_in_the_frame_of_a_table_that_was_seen_moves_with_the_table(x, y, yaw):
    """A base that docks a little beside sees its table elsewhere, and all that stands on it with it."""
    T_table_before = world().T_world_object("table")
    px, py, pz = T_table_before.position_m
    there = Pose.from_rpy((px + x, py + y, pz), (0.0, 0.0, yaw))
    found = grounded(seen(Observation("table", there, "world", 0.9)))
    on_table = [
        item for item in bench().objects if item.prior and item.prior.frame == "table" and not item.system
    ]
    assert len(on_table) > 5
    for item in on_table:
        before = T_table_before.inverse() @ world().T_world_object(item.name)
        after = there.inverse() @ found.T_world_object(item.name)
        assert after.position_m == pytest.approx(before.position_m, abs=1e-9)
        assert after.quaternion == pytest.approx(before.quaternion, abs=1e-9)
        told = found.find(item.name)
        assert told is not None
        assert dict(told.provenance)["pose"].endswith(", moved with table")
    rack, tube = (found.T_world_object(name).position_m for name in ("rack_1", "tube_1"))
    assert math.dist(rack, tube) == pytest.approx(
        math.dist(world().T_world_object("rack_1").position_m, world().T_world_object("tube_1").position_m)
    )


def test_a_small_lean_does_not_hide_a_contradiction():
    x, y, z = world().T_world_object("rack_1").position_m
    leaning = Observation("beaker_1", Pose.from_rpy((x, y, z), (0.01, 0.0, 0.0)), "world", 0.9)
    assert set(codes(seen(leaning))) == {"XEI0658"}
