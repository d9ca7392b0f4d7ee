from __future__ import annotations

import dataclasses
import math

import pytest

from tests.world.bench import BENCH, bench, world
from xei_lang.diagnostics import CATALOGUE
from xei_lang.ir.forms.world_text import to_text
from xei_lang.profiles.grid import T_frame_object
from xei_lang.world.frames import T_base_link, frame_tree, start_state
from xei_lang.world.ground import ground


def test_the_bench_as_it_is_grounded(golden):
    golden("world/openarm_bench.txt", to_text(world()))


def test_a_tube_stands_on_the_floor_of_its_slot_on_the_slot_axis():
    """Row A is nearest to the robot, column 1 at its left; the rack is turned by -90 deg on the table."""
    x, y, z = world().T_world_object("tube_1").position_m
    rack = world().T_world_object("rack_1").position_m
    assert (x, y, z) == pytest.approx((rack[0] - 0.06, rack[1] + 0.09, 0.75 + 0.07 - 0.065))


def test_objects_are_sorted_and_say_who_placed_them():
    names = [item.name for item in world().objects]
    assert names == sorted(names)
    assert set(names) == {item.name for item in bench().objects}
    for item in world().objects:
        source = "object_registry" if item.name in ("floor", "table", "table_b") else "usage_profile"
        assert dict(item.provenance)["pose"] == f"{source} prior"
        assert dict(item.provenance)["roles"] == source


def test_an_object_without_a_prior_is_left_out_and_told():
    objects = tuple(
        dataclasses.replace(item, prior=None) if item.name == "rack_1" else item for item in bench().objects
    )
    grounded, found = ground(dataclasses.replace(bench(), objects=objects))
    assert grounded is not None
    assert [item.code for item in found] == ["XEI0660"] * 7
    assert CATALOGUE["XEI0660"].severity == "info"
    assert grounded.find("rack_1") is None
    assert grounded.find("tube_3") is None
    assert grounded.find("rack_2") is not None


def test_the_robot_starts_at_home_with_the_stations_slide():
    state = start_state(bench())
    joints = dict(state.joints)
    assert state.station == "bench_a"
    assert joints["slide_joint"] == pytest.approx(0.15)
    assert [name for name in joints if name.endswith("joint4")] == [
        "openarm_left_joint4",
        "openarm_right_joint4",
    ]
    assert not any(name.endswith("finger_joint2") for name in joints)
    for name, value in joints.items():
        joint = bench().robot.joint(name)
        assert joint is not None
        assert joint.lower <= value <= joint.upper


def test_every_frame_hangs_on_world():
    for frame in world().frames:
        world().T_world_frame(frame.name)
    assert [frame.name for frame in world().frames] == sorted(frame.name for frame in world().frames)
    assert world().T_world_frame("camera").position_m[2] > world().T_world_frame("slide").position_m[2]


def test_forward_kinematics_agrees_with_pinocchio():
    pin = pytest.importorskip("pinocchio")
    model = pin.buildModelFromUrdf(str(BENCH / bench().bank.urdf))
    data = model.createData()
    joints = {
        joint.name: joint.lower + (joint.upper - joint.lower) * (0.37 + 0.05 * math.sin(index))
        for index, joint in enumerate(bench().robot.joints)
        if joint.kind != "fixed" and not joint.mimic
    }
    q = pin.neutral(model)
    for joint in bench().robot.joints:
        if joint.kind != "fixed":
            q[model.joints[model.getJointId(joint.name)].idx_q] = joints[joint.mimic or joint.name]
    pin.framesForwardKinematics(model, data, q)
    for link in bench().robot.links:
        expected = data.oMf[model.getFrameId(link, pin.FrameType.BODY)].homogeneous
        actual = T_base_link(bench().robot, link, joints).matrix()
        assert max(abs(actual[i][j] - expected[i, j]) for i in range(4) for j in range(4)) < 1e-9, link


def test_the_slide_carries_camera_and_tools():
    low = start_state(bench())
    high = dataclasses.replace(
        low, joints=tuple((name, value + 0.2 * (name == "slide_joint")) for name, value in low.joints)
    )
    for name, lift in (("slide", 0.2), ("left_tool", 0.2), ("robot_base", 0.0)):
        before, after = (
            next(frame for frame in frame_tree(bench(), state) if frame.name == name) for state in (low, high)
        )
        rise = after.T_parent_frame.position_m[2] - before.T_parent_frame.position_m[2]
        assert rise == pytest.approx(lift)


def test_priors_in_a_circle_lead_nowhere():
    table = bench().object("table")
    assert table is not None
    assert T_frame_object(bench(), table) is not None
    assert table.prior is not None
    looped = dataclasses.replace(
        table, prior=dataclasses.replace(table.prior, in_object="table", in_kind="spot", in_key="bottle")
    )
    profile = dataclasses.replace(bench(), objects=(looped,))
    assert T_frame_object(profile, looped) is None
