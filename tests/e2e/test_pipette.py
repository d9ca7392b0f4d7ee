"""The pipette of `pipette_sample`, followed through the planned motion: vessels and boxes are solid to the
collision checks that let it in, so that what is inside them is held here against their openings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import pytest

from tests.e2e.made import PROTOCOLS, compiled
from xei_lang.ir.geometry import Cylinder, Pose
from xei_lang.ir.timed import TimedPlan
from xei_lang.pipeline import Handoffs
from xei_lang.profiles.grid import T_object_slot
from xei_lang.world.frames import T_base_link

PIPETTE, TOOL = "pipette_1", "openarm_right_grasp"


@pytest.fixture(scope="module")
def made() -> Handoffs:
    _, outcome = compiled(next(path for path in PROTOCOLS if path.stem == "pipette_sample"))
    assert outcome.stopped_at is None, outcome.diagnostics
    return outcome.made


def poses(made: Handoffs) -> Iterator[tuple[str, Pose]]:
    """Every sample in which the hand holds the pipette: the goal's id, and the pipette in the base."""
    assert made.profile is not None and made.world is not None
    timed: TimedPlan | None = made.timed
    assert timed is not None
    joints = dict(made.world.robot.joints)
    for goal in timed.goals:
        held = next((item for item in goal.attached if item.object == PIPETTE), None)
        for row in goal.samples.positions if goal.samples is not None else ():
            joints.update(zip(goal.joints, row, strict=True))
            if held is not None:
                assert held.link == TOOL
                T_base_tool = T_base_link(made.profile.robot, TOOL, joints)
                yield goal.id, T_base_tool @ held.T_link_object


@pytest.mark.parametrize(
    ("vessel", "command", "depth_m"), [("beaker_3", "6", 0.05), ("tube_4", "11", 0.0099)]
)
def test_the_tip_goes_down_inside_its_vessel_and_touches_nothing_of_it(
    made: Handoffs, vessel: str, command: str, depth_m: float
) -> None:
    assert made.profile is not None and made.world is not None
    known, pipette = made.profile.object(vessel), made.profile.object(PIPETTE)
    assert known is not None and known.liquid is not None and pipette is not None
    T_base_vessel = made.world.robot.T_world_base.inverse() @ made.world.T_world_object(vessel)
    rim, opening = known.size_m[2], known.liquid.inner_diameter_m / 2
    wall = known.size_m[0] / 2 - opening
    inside: set[str] = set()
    lowest = rim
    for goal, T_base_pipette in poses(made):
        T_vessel_pipette = T_base_vessel.inverse() @ T_base_pipette
        for part in pipette.geometry:
            shape = part.shape
            assert isinstance(shape, Cylinder)
            pose = T_vessel_pipette @ part.T_object_shape
            end = pose.apply((0.0, 0.0, -shape.height_m / 2))
            away = math.hypot(end[0], end[1])
            if end[2] < rim and away < known.size_m[0] / 2 + shape.radius_m and end[2] > -0.001:
                inside.add(goal.rpartition("/")[2])
                assert away + shape.radius_m < opening
                assert pose.axes()[2][2] > 1.0 - 1e-5
                assert end[2] > wall + 0.0025
                lowest = min(lowest, end[2])
    number = int(command)
    assert inside == {str(number), str(number + 3)}
    assert rim - lowest >= depth_m


def test_the_nose_comes_down_on_the_axis_of_its_tip(made: Handoffs) -> None:
    assert made.profile is not None and made.world is not None
    box, pipette = made.profile.object("tip_box_1"), made.profile.object(PIPETTE)
    assert box is not None and pipette is not None and pipette.tip is not None
    T_box_slot = T_object_slot(box, "A1")
    assert T_box_slot is not None
    T_base_slot = (
        made.world.robot.T_world_base.inverse() @ made.world.T_world_object("tip_box_1") @ T_box_slot
    )
    nose = (0.0, 0.0, pipette.tip.length_m - pipette.tip.seat_m)
    way = [
        T_base_slot.inverse().apply(T_base_pipette.apply(nose))
        for goal, T_base_pipette in poses(made)
        if goal.endswith("sample#1/2")
    ]
    assert all(math.hypot(x, y) < 0.0008 for x, y, _ in way)
    assert way[-1][2] == pytest.approx(-pipette.tip.seat_m, abs=1e-3)
    assert way[0][2] > pipette.tip.length_m


def test_the_pipette_stays_upright(made: Handoffs) -> None:
    assert made.profile is not None
    tilts = [math.acos(min(1.0, pose.axes()[2][2])) for _, pose in poses(made)]
    assert len(tilts) > 500
    assert max(tilts) <= made.profile.calibration.spill_tilt_rad + 1e-3
