"""Pipetting on the bench and on vessels of any size: where the tip's end goes, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.lower.plans import bench, obj, plan, slot
from tests.motion.sequence.bench import moved
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Cylinder, Pose, Primitive
from xei_lang.ir.goals import Instrument, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Fact
from xei_lang.ir.verify_goals import verify_goals
from xei_lang.lower import lower
from xei_lang.lower.operations.pipette import goes_in_m
from xei_lang.profiles.model import LabObject, Profile
from xei_lang.quantity import parse_quantity, quantity

PICK = ("pick", {"object": obj("pipette_1"), "arm": "right"})
TIP_M, SEAT_M = 0.078, 0.008
SHAFT_M, BODY_M = 0.012 / 2, 0.034 / 2
SHAFT_FROM_M, BODY_FROM_M = 0.078, 0.130
"""The pipette of the bench, from the end of its tip up."""


def attach(key: str = "A1", box: str = "tip_box_1"):
    return ("attach_tip", {"pipette": obj("pipette_1"), "tip": slot(box, key), "arm": "right"})


def draw(skill: str, vessel: str, volume: str):
    name = "source" if skill == "aspirate" else "target"
    args = {"pipette": obj("pipette_1"), name: obj(vessel), "volume": parse_quantity(volume), "arm": "right"}
    return (skill, args)


def try_it(*calls, profile: Profile | None = None, world=None, facts=()):
    own, seen = bench()
    made = plan(*calls)
    steps = tuple(replace(step, state_before=tuple(facts)) for step in made.steps)
    return lower(replace(made, steps=steps), profile or own, world or seen)


def lowered(*calls, **given_) -> MotionGoalGraph:
    graph, problems = try_it(*calls, **given_)
    assert graph is not None, problems
    assert verify_goals(graph) == ()
    return graph


def moves(graph: MotionGoalGraph, step: str) -> list[tuple[MotionGoal, MoveTo, Pose]]:
    """The moves of a step, and where the object in the hand is after each."""
    found: list[tuple[MotionGoal, MoveTo, Pose]] = []
    for goal in graph.goals:
        if goal.step_id == step and isinstance(goal.action, MoveTo):
            assert isinstance(goal.action.target, ToolTarget)
            x, y, z = goal.action.target.T_base_reference.position_m
            dx, dy, dz = goal.action.target.offset_base_m
            at = Pose((x + dx, y + dy, z + dz), goal.action.target.T_base_reference.quaternion)
            found.append((goal, goal.action, at))
    return found


def changed(name: str, **fields) -> Profile:
    profile = bench()[0]
    objects = tuple(replace(item, **fields) if item.name == name else item for item in profile.objects)
    return replace(profile, objects=objects)


def vessel_of(radius_m: float, wall_m: float, height_m: float) -> Profile:
    beaker = bench()[0].object("beaker_3")
    assert beaker is not None and beaker.liquid is not None
    capacity = math.pi * (radius_m - wall_m) ** 2 * (height_m - wall_m) * 0.95
    liquid = replace(
        beaker.liquid, inner_diameter_m=2 * (radius_m - wall_m), capacity_m3=capacity, dead_volume_m3=1e-9
    )
    shape, size = Cylinder(radius_m, height_m), (2 * radius_m, 2 * radius_m, height_m)
    parts = (Primitive(shape, Pose((0.0, 0.0, height_m / 2))),)
    return changed("beaker_3", shape=shape, size_m=size, geometry=parts, liquid=liquid)


def fact(profile: Profile, share: float) -> tuple[Fact, float]:
    """That a share of its capacity is in the vessel, and how high it stands above the vessel's origin."""
    beaker = profile.object("beaker_3")
    assert beaker is not None and beaker.liquid is not None
    microlitres = math.floor(beaker.liquid.capacity_m3 * 1e9 * share)
    radius = beaker.liquid.inner_diameter_m / 2
    level = beaker.size_m[0] / 2 - radius + microlitres * 1e-9 / (math.pi * radius**2)
    return Fact("volume", "beaker_3", quantity(microlitres, "uL")), level


def inside(beaker: LabObject, tip_end: Pose, T_base_beaker: Pose) -> float:
    """Height of the tip's end above the vessel's origin, having held pipette and opening apart."""
    assert beaker.liquid is not None
    x, y, z = T_base_beaker.inverse().apply(tip_end.position_m)
    wall = beaker.size_m[0] / 2 - beaker.liquid.inner_diameter_m / 2
    rim, opening = beaker.size_m[2], beaker.liquid.inner_diameter_m / 2
    assert math.hypot(x, y) < 1e-9
    assert tip_end.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert z >= wall + 0.003 - 2e-6
    for from_m, radius in ((0.0, 0.009 / 2), (SHAFT_FROM_M, SHAFT_M), (BODY_FROM_M, BODY_M)):
        assert z + from_m >= rim + 0.005 - 2e-6 or radius <= opening - 0.0005 + 1e-9
    return z


SIZES = (st.floats(0.006, 0.05), st.floats(0.0005, 0.0009), st.floats(0.03, 0.2))


@settings(max_examples=60, deadline=None)
@given(*SIZES, st.floats(0.02, 0.99), st.integers(10, 1000), st.floats(-0.03, 0.03), st.booleans())
def test_a_tip_is_in_the_liquid_above_the_bottom_and_the_pipette_clear_of_the_rim(
    radius: float, wall: float, height: float, share: float, volume_ul: int, shift: float, known: bool
) -> None:
    profile, world = vessel_of(radius, wall, height), moved(bench()[1], "beaker_3", shift, -shift)
    said, level = fact(profile, share)
    calls = (PICK, draw("aspirate", "beaker_3", f"{volume_ul} uL"))
    graph, problems = try_it(*calls, profile=profile, world=world, facts=(said,) if known else ())
    if graph is None:
        assert problems[0].code in ("XEI0719", "XEI0726")
        assume(False)
    beaker = profile.object("beaker_3")
    assert graph is not None and beaker is not None and beaker.liquid is not None
    T_base_beaker = world.robot.T_world_base.inverse() @ world.T_world_object("beaker_3")
    above, into, out = moves(graph, "aspirate#1")
    z = inside(beaker, into[2], T_base_beaker)
    if known:
        left = level - volume_ul * 1e-9 / (math.pi * (beaker.liquid.inner_diameter_m / 2) ** 2)
        assert z <= left + 2e-6
    for leave in (above[2], out[2]):
        assert leave.position_m[2] >= T_base_beaker.position_m[2] + height + 0.03 - 2e-6
        assert leave.position_m[:2] == pytest.approx(into[2].position_m[:2])
    assert all(move.keep_upright for _, move, _ in (above, into, out))


@settings(max_examples=60, deadline=None)
@given(*SIZES, st.floats(0.0, 0.98), st.integers(10, 1000), st.booleans())
def test_a_tip_dispenses_inside_the_opening_and_above_the_liquid(
    radius: float, wall: float, height: float, share: float, volume_ul: int, known: bool
) -> None:
    profile, world = vessel_of(radius, wall, height), bench()[1]
    said, level = fact(profile, share)
    calls = (PICK, draw("dispense", "beaker_3", f"{volume_ul} uL"))
    graph, problems = try_it(*calls, profile=profile, facts=(said,) if known else ())
    if graph is None:
        assert problems[0].code in ("XEI0719", "XEI0726")
        assume(False)
    beaker = profile.object("beaker_3")
    assert graph is not None and beaker is not None and beaker.liquid is not None
    T_base_beaker = world.robot.T_world_base.inverse() @ world.T_world_object("beaker_3")
    z = inside(beaker, moves(graph, "dispense#1")[1][2], T_base_beaker)
    assert z >= height - 0.010 - 2e-6
    if known:
        after = level + volume_ul * 1e-9 / (math.pi * (beaker.liquid.inner_diameter_m / 2) ** 2)
        assert z >= after + 0.005 - 2e-6
    else:
        assert z == pytest.approx(height - 0.010)


@pytest.mark.parametrize("key", ["A1", "H12", "D7"])
def test_the_nose_sits_in_the_tip_of_its_slot(key: str) -> None:
    graph, world = lowered(PICK, attach(key)), bench()[1]
    above, on, away = moves(graph, "attach_tip#1")
    row, column = "ABCDEFGH".index(key[0]), int(key[1:]) - 1
    mouth = (0.012 + 0.009 * column - 0.0615, 0.0115 + 0.009 * row - 0.043, 0.1)
    T_base_box = world.robot.T_world_base.inverse() @ world.T_world_object("tip_box_1")
    nose = on[2].apply((0.0, 0.0, TIP_M - SEAT_M))
    assert T_base_box.inverse().apply(nose) == pytest.approx((*mouth[:2], mouth[2] - SEAT_M), abs=1e-9)
    assert above[2] == away[2]
    assert above[2].position_m[2] - on[2].position_m[2] == pytest.approx(TIP_M + 0.020)
    assert on[1].path == "linear" and on[1].tool_speed_m_s == pytest.approx(0.02)
    said = {item.name: item.value for item in on[0].parameters}
    assert said["press_force"] == "8 N" and said["alignment_tolerance"] == "0.8 mm"
    assert said["tool_point"] == "70 mm"


def test_a_pipette_may_touch_only_what_it_has_gone_into() -> None:
    graph = lowered(PICK, attach(), draw("aspirate", "beaker_3", "200 uL"))
    touched = [
        [pair[1] for pair in goal.allowed_contacts if not pair[1].startswith("openarm")]
        for goal in graph.goals
        if goal.step_id in ("attach_tip#1", "aspirate#1")
    ]
    box, vessel = ["tip_box_1"], ["beaker_3"]
    assert touched == [[], box, box, box, [], vessel, vessel, vessel, vessel]


def test_a_tip_in_a_tube_may_be_below_the_top_of_its_rack() -> None:
    opened = (Fact("cap", "tube_3", "open"),)
    graph = lowered(PICK, draw("aspirate", "tube_3", "200 uL"), facts=opened)
    into = moves(graph, "aspirate#1")[1]
    assert ("pipette_1", "rack_1") in into[0].allowed_contacts
    assert ("pipette_1", "tube_3") in into[0].allowed_contacts
    graph = lowered(PICK, draw("dispense", "tube_3", "200 uL"), facts=opened)
    assert ("pipette_1", "rack_1") not in moves(graph, "dispense#1")[1][0].allowed_contacts


def test_a_transfer_is_its_four_skills_in_one() -> None:
    pipette, arm, volume = obj("pipette_1"), "right", parse_quantity("0.5 mL")
    args = {"pipette": pipette, "tip": slot("tip_box_1", "B2"), "source": obj("beaker_3"), "arm": arm}
    more = {"target": obj("beaker_1"), "volume": volume, "waste": obj("waste_bin")}
    whole = lowered(PICK, ("transfer_sample", {**args, **more}))
    parts = lowered(
        PICK,
        attach("B2"),
        draw("aspirate", "beaker_3", "0.5 mL"),
        draw("dispense", "beaker_1", "0.5 mL"),
        ("eject_tip", {"pipette": pipette, "waste": obj("waste_bin"), "arm": arm}),
    )

    def after_pick(graph: MotionGoalGraph) -> list:
        return [goal.action for goal in graph.goals if not goal.step_id.startswith(("scene", "pick"))]

    assert after_pick(whole) == after_pick(parts)
    commands = [item.command for item in after_pick(whole) if isinstance(item, Instrument)]
    assert commands == ["aspirate", "dispense", "eject_tip"]
    world = bench()[1]
    over = moves(whole, "transfer_sample#1")[-1][2]
    T_base_bin = world.robot.T_world_base.inverse() @ world.T_world_object("waste_bin")
    assert T_base_bin.inverse().apply(over.position_m) == pytest.approx((0.0, 0.0, 0.170), abs=1e-9)


@pytest.mark.parametrize(
    ("code", "calls", "given_"),
    [
        ("XEI0707", (attach(),), {}),
        ("XEI0726", (PICK, attach(box="rack_1", key="C1")), {}),
        ("XEI0725", (PICK, draw("aspirate", "tube_3", "200 uL")), {}),
        ("XEI0726", (PICK, draw("aspirate", "incubator", "200 uL")), {}),
        ("XEI0719", (PICK, draw("dispense", "beaker_3", "1.5 mL")), {}),
        (
            "XEI0719",
            (PICK, draw("aspirate", "beaker_3", "1 mL")),
            {"facts": (Fact("volume", "beaker_3", parse_quantity("1.5 mL")),)},
        ),
        (
            "XEI0719",
            (PICK, draw("dispense", "beaker_3", "1 mL")),
            {"facts": (Fact("volume", "beaker_3", parse_quantity("249.5 mL")),)},
        ),
        (
            "XEI0726",
            (PICK, draw("aspirate", "beaker_3", "1 mL")),
            {
                "profile": vessel_of(0.010, 0.001, 0.2),
                "facts": (Fact("volume", "beaker_3", parse_quantity("3 mL")),),
            },
        ),
    ],
)
def test_what_cannot_be_pipetted_is_refused(code: str, calls, given_) -> None:
    graph, problems = try_it(*calls, **given_)
    assert graph is None
    assert problems[0].code == code


@pytest.mark.parametrize(("force", "fits"), [("9.8 N", True), ("9.9 N", False), ("0 N", False)])
def test_a_tip_is_pressed_on_with_no_more_than_the_arm_bears(force: str, fits: bool) -> None:
    pipette = bench()[0].object("pipette_1")
    assert pipette is not None
    written = replace(pipette.grasp[0], name="press_force", value=parse_quantity(force))
    profile = changed("pipette_1", grasp=(*pipette.grasp, written))
    graph, problems = try_it(PICK, attach(), profile=profile)
    assert (graph is not None) == fits
    assert [item.code for item in problems] == ([] if fits else ["XEI0702"])


def test_an_object_goes_in_up_to_its_first_part_that_is_too_wide() -> None:
    def part(radius: float, lower: float, upper: float) -> Primitive:
        return Primitive(Cylinder(radius, upper - lower), Pose((0.0, 0.0, (lower + upper) / 2)))

    parts = (part(0.004, 0.0, 0.07), part(0.006, 0.07, 0.13), part(0.017, 0.13, 0.30))
    for radius, depth in ((0.003, 0.0), (0.005, 0.07), (0.010, 0.13), (0.02, math.inf)):
        assert goes_in_m(parts, radius) == pytest.approx(depth)
    askew = Primitive(Cylinder(0.004, 0.06), Pose.from_rpy((0.0, 0.0, 0.2), (0.3, 0.0, 0.0)))
    assert goes_in_m((*parts[:1], askew), 0.01) <= 0.2 - 0.03
