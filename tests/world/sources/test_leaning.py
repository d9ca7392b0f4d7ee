"""Objects that were seen leaning, lying or on their head are held against everything, as what stands is."""

from __future__ import annotations

import math

import pytest

from tests.world.bench import bench
from tests.world.sources.scenes import codes, grounded, read, scene, seen
from xei_lang.diagnostics import Diagnostic, has_errors
from xei_lang.ir.geometry import Pose
from xei_lang.world.ground import ground
from xei_lang.world.sources import Observation


def turned(name: str, x: float, y: float, z: float, roll: float, pitch: float = 0.0) -> Observation:
    rpy = (math.radians(roll), math.radians(pitch), 0.0)
    return Observation(name, Pose.from_rpy((x, y, z), rpy), "table", 0.9)


def warned(*items: Observation) -> list[Diagnostic]:
    world, said = ground(bench(), (seen(*items),))
    assert world is not None, said
    return [one for one in said if one.code == "XEI0659"]


@pytest.mark.parametrize(
    "observation",
    [
        turned("beaker_1", 0.12, -0.135, 0.040, 180),
        turned("beaker_1", 0.08, -0.33, 0.0, 180),
        turned("beaker_1", 0.08, -0.33, 0.0, 90),
        turned("tube_1", 0.12, -0.135, 0.035, 90),
        turned("wipe_1", 0.12, -0.135, 0.060, 30, 40),
    ],
)
def test_what_leans_into_something_is_refused(observation):
    assert set(codes(seen(observation))) == {"XEI0658"}


def test_a_rack_that_leans_into_the_table_is_refused():
    pose = Pose.from_rpy((0.12, -0.135, 0.0), (math.radians(45), 0.0, math.radians(-90)))
    _, said = ground(bench(), (seen(Observation("rack_1", pose, "table", 0.9)),))
    first = next(one for one in said if one.code == "XEI0658")
    assert first.message == "`rack_1` would reach 67.2 mm below the top of `table`"
    assert any("45 deg off the vertical" in note for note in first.notes)


def test_a_quaternion_with_w_first_turns_a_beaker_over_and_is_told():
    line = (
        "beaker_1: {frame: table, position: [80 mm, -330 mm, 0 mm], quaternion: [1, 0, 0, 0], confidence: 1}"
    )
    observed, said = read(scene(line))
    assert observed is not None, said
    _, said = ground(bench(), (observed,))
    first = next(one for one in said if one.code == "XEI0658")
    assert first.message == "`beaker_1` would reach 95 mm below the top of `table`"
    assert "x, y, z, w is 1, 0, 0, 0" in " ".join(first.notes)


@pytest.mark.parametrize(
    ("observation", "said", "bottom_m"),
    [
        (turned("beaker_1", 0.08, -0.33, 0.098, 180), "is upside down", 0.095),
        (turned("beaker_1", 0.08, -0.30, 0.033, 90), "lies on its side", 0.035),
        (turned("beaker_1", 0.08, -0.33, 0.035 * math.sin(math.radians(30)), 30), "leans by 30 deg", 0.0175),
    ],
)
def test_what_lies_on_a_table_rests_on_it_by_its_lowest_point_and_is_warned_of(observation, said, bottom_m):
    (one,) = warned(observation)
    assert one.message == f"`beaker_1` {said}"
    assert (one.severity, "x, y, z, w" in one.help[0]) == ("warning", True)
    found = grounded(seen(observation)).find("beaker_1")
    assert found is not None
    assert found.T_frame_object.position_m[2] == pytest.approx(bottom_m, abs=1e-9)
    assert found.frame_id == "table"


def test_a_fixture_that_is_seen_on_its_side_is_warned_of():
    assert [one.message for one in warned(turned("waste_bin", 0.16, -0.52, 0.060, 90))] == [
        "`waste_bin` lies on its side"
    ]


def test_what_stands_is_not_warned_of():
    assert warned(turned("beaker_1", 0.08, -0.33, 0.0, 4)) == []
    assert not has_errors(ground(bench())[1])
