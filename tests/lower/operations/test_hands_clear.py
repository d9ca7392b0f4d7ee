"""The whole hand, as the robot's description has it, keeps clear: of the object before it comes in and when
it has come in open, of the surface that it stands on, and of the other hand where both hold one object.
"""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.lower.hands import apart_m, body, hand
from tests.lower.plans import bench, moved, obj, with_object
from tests.lower.works import grasp_of, holding, step_of, work_of
from xei_lang.ir.families import ToolPose
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive
from xei_lang.ir.skill_plan import Side
from xei_lang.lower.operations import Planned
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.operations.handover import GIVE, TAKE
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Profile

EDGES = st.floats(0.006, 0.08)
SHAPES = st.one_of(
    st.builds(Cylinder, st.floats(0.003, 0.042), st.floats(0.06, 0.25)),
    st.builds(lambda x, y, z: Box((x, y, z)), EDGES, EDGES, st.floats(0.06, 0.25)),
)
POSES = st.builds(
    lambda x, y, yaw: Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)),
    st.floats(0.5, 0.9),
    st.floats(-0.4, 0.4),
    st.floats(-math.pi, math.pi),
)
SIDES = st.sampled_from(["left", "right"])


def made(shape: Box | Cylinder) -> Profile:
    """The bench with `wipe_1` in this shape."""
    profile = bench()[0]
    found = profile.object("wipe_1")
    assert found is not None
    size = (
        shape.size_m if isinstance(shape, Box) else (2 * shape.radius_m, 2 * shape.radius_m, shape.height_m)
    )
    parts = (Primitive(shape, Pose((0.0, 0.0, size[2] / 2))),)
    return with_object(profile, "wipe_1", replace(found, shape=shape, size_m=size, geometry=parts))


def standing(shape: Box | Cylinder, pose: Pose) -> tuple[Profile, Scene]:
    profile = made(shape)
    return profile, Scene.of(moved(bench()[1], "wipe_1", pose), profile)


def members(planned: Planned) -> tuple[ToolPose, ...]:
    assert planned.family is not None
    return planned.family.members


@given(SHAPES, POSES, SIDES)
@settings(max_examples=40, deadline=None)
def test_the_open_hand_is_outside_the_object_before_and_after_it_comes_in(
    shape: Box | Cylinder, pose: Pose, arm: Side
) -> None:
    profile, scene = standing(shape, pose)
    planned = GRASP.plan(grasp_of("wipe_1", scene, arm, profile))
    there = [body(shape, Pose())]
    gap_m = planned.settings["open_width"].si("Length")
    back = Pose(planned.aims["pregrasp"].target.offset_tool_m)
    assert members(planned)
    for member in members(planned)[::5]:
        T_object_tool = member.T_reference_tool
        assert apart_m(hand(T_object_tool @ back, gap_m), there) > 0.0099, member.name
        assert apart_m(hand(T_object_tool, gap_m), there) > 0.0, member.name


@given(SHAPES, POSES, SIDES)
@settings(max_examples=30, deadline=None)
def test_the_closed_fingers_meet_the_object_between_them(
    shape: Box | Cylinder, pose: Pose, arm: Side
) -> None:
    """A tenth of a millimetre tighter than the grasp's width, both fingers touch."""
    profile, scene = standing(shape, pose)
    planned = GRASP.plan(grasp_of("wipe_1", scene, arm, profile))
    width_m = planned.settings["grasp_width"].si("Length")
    there = [body(shape, Pose())]
    for member in members(planned)[::5]:
        for finger in ("left_finger", "right_finger"):
            touching = apart_m(hand(member.T_reference_tool, width_m - 2e-4, finger), there)
            assert touching < 0.0, (member.name, finger)


LONG = st.builds(Cylinder, st.floats(0.008, 0.03), st.floats(0.12, 0.25))


@given(LONG, POSES, SIDES)
@settings(max_examples=6, deadline=None)
def test_for_each_way_to_give_there_is_one_to_take_clear_of_the_giver(
    shape: Cylinder, pose: Pose, arm: Side
) -> None:
    """Both hands mean the same pose of the object, whose frame their grasps are in."""
    profile, scene = standing(shape, pose)
    taker: Side = "left" if arm == "right" else "right"
    holds = holding("wipe_1", scene, arm, profile)
    step = step_of("handover", {"object": obj("wipe_1"), "arm": arm, "to": taker})
    give = GIVE.plan(work_of(step, obj("wipe_1"), "wipe_1", holds, arm, profile))
    take = TAKE.plan(work_of(step, obj("wipe_1"), "wipe_1", holds, taker, profile))
    given_at = give.aims["handover_hold"].target.T_base_reference
    taken_at = take.aims["handover_grasp"].target.T_base_reference
    for point, other in zip(given_at.position_m, taken_at.position_m, strict=True):
        assert abs(point - other) < 1e-9
    width_m = give.settings["release_width"].si("Length")
    open_m = take.settings["open_width"].si("Length")
    for member in members(give)[:: max(1, len(members(give)) // 4)]:
        giver = hand(member.T_reference_tool, width_m)
        assert any(apart_m(hand(other.T_reference_tool, open_m), giver) > 0.0 for other in members(take)), (
            member.name
        )
