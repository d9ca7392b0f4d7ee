"""Where held objects and fingertips go, over random sizes and poses: out of slots, onto surfaces, about a
lip, along a screen and over an area.
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.lower.hands import apart_m, body
from tests.lower.plans import bench, moved, obj, spot, surface, with_object, with_skill
from tests.lower.works import holding, step_of, work_of
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive
from xei_lang.ir.skill_plan import Fact, Side
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.lower.operations.lift import LIFT
from xei_lang.lower.operations.place import PLACE
from xei_lang.lower.operations.pour import POUR
from xei_lang.lower.operations.tap import SWIPE, TAP
from xei_lang.lower.operations.wipe import WIPE
from xei_lang.lower.refusal import Refusal
from xei_lang.lower.walk import Scene
from xei_lang.profiles.model import Element, LabObject, Profile
from xei_lang.quantity import parse_quantity

SIDES = st.sampled_from(["left", "right"])
YAWS = st.floats(-math.pi, math.pi)


def found(profile: Profile, name: str) -> LabObject:
    item = profile.object(name)
    assert item is not None
    return item


def shaped(profile: Profile, name: str, shape: Box | Cylinder, **fields: object) -> Profile:
    """The profile with an object in this shape."""
    size = (
        shape.size_m if isinstance(shape, Box) else (2 * shape.radius_m, 2 * shape.radius_m, shape.height_m)
    )
    parts = (Primitive(shape, Pose((0.0, 0.0, size[2] / 2))),)
    item = replace(found(profile, name), shape=shape, size_m=size, geometry=parts, **fields)
    return with_object(profile, name, item)


def moved_by(target: ToolTarget) -> Pose:
    """Where the reference is."""
    x, y, z = (a + b for a, b in zip(target.T_base_reference.position_m, target.offset_base_m, strict=True))
    return Pose((x, y, z), target.T_base_reference.quaternion)


@given(st.floats(-0.15, 0.15), st.floats(-0.15, 0.15), YAWS, st.floats(0.02, 0.065), SIDES, st.booleans())
@settings(max_examples=40, deadline=None)
def test_a_lift_takes_the_object_out_of_its_slot_along_the_axis(
    roll: float, pitch: float, yaw: float, depth_m: float, arm: Side, stated: bool
) -> None:
    profile, world = bench()
    pick = profile.bank.skill("pick")
    assert pick is not None
    if not stated:
        others = tuple(item for item in pick.parameters if item.name != "lift")
        profile = with_skill(profile, replace(pick, parameters=others))
    rack = found(profile, "rack_1")
    assert rack.slots is not None
    profile = with_object(profile, "rack_1", replace(rack, slots=replace(rack.slots, depth_m=depth_m)))
    T_world_rack = Pose.from_rpy((0.62, 0.135, 0.75), (roll, pitch, yaw))
    mouth = rack.slots.origin_m
    T_world_tube = T_world_rack @ Pose((mouth[0], mouth[1], mouth[2] - depth_m))
    world = moved(moved(world, "rack_1", T_world_rack), "tube_1", T_world_tube)
    scene = Scene.of(world, profile)
    there = replace(scene.standing["tube_1"], place='rack_1.slot("A1")', support="rack_1")
    scene = holding("tube_1", replace(scene, standing={**scene.standing, "tube_1": there}), arm, profile)
    step = step_of("pick", {"object": obj("tube_1"), "arm": arm})
    aim = LIFT.plan(work_of(step, obj("tube_1"), "tube_1", scene, arm, profile)).aims["lift"]
    T_world_lifted = scene.epoch.T_world_base @ moved_by(aim.target)
    x, y, z = T_world_rack.locate(T_world_lifted.position_m)
    assert (x, y) == pytest.approx(mouth[:2], abs=1e-9)
    assert z >= mouth[2] + 0.0199, "its bottom is clear of the mouth"
    assert T_world_lifted.quaternion == pytest.approx(T_world_tube.quaternion)


@given(st.floats(0.55, 0.9), st.floats(-0.4, 0.4), YAWS, SIDES)
@settings(max_examples=30, deadline=None)
def test_a_lift_from_a_surface_goes_straight_up(x: float, y: float, yaw: float, arm: Side) -> None:
    profile, world = bench()
    world = moved(world, "wipe_1", Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)))
    scene = holding("wipe_1", Scene.of(world, profile), arm)
    step = step_of("pick", {"object": obj("wipe_1"), "arm": arm})
    target = LIFT.plan(work_of(step, obj("wipe_1"), "wipe_1", scene, arm)).aims["lift"].target
    assert target.offset_base_m[:2] == (0.0, 0.0)
    assert target.offset_base_m[2] >= 0.02
    assert target.offset_tool_m == (0.0, 0.0, 0.0)


ON_TABLE = st.tuples(st.floats(0.55, 0.95), st.floats(-0.45, 0.45), YAWS)
THINGS = st.one_of(
    st.builds(Cylinder, st.floats(0.01, 0.042), st.floats(0.06, 0.2)),
    st.builds(
        lambda x, y, z: Box((x, y, z)), st.floats(0.01, 0.08), st.floats(0.01, 0.08), st.floats(0.06, 0.2)
    ),
)


@given(THINGS, ON_TABLE, ON_TABLE, SIDES)
@settings(max_examples=30, deadline=None)
def test_free_room_is_on_the_surface_and_away_from_everything_on_it(
    shape: Box | Cylinder, one: tuple[float, ...], two: tuple[float, ...], arm: Side
) -> None:
    profile, world = bench()
    profile = shaped(profile, "wipe_1", shape)
    for name, (x, y, yaw) in (("beaker_1", one), ("bottle_1", two)):
        world = moved(world, name, Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)))
    scene = holding("wipe_1", Scene.of(world, profile), arm, profile)
    step = step_of("place", {"object": obj("wipe_1"), "on": surface("table"), "arm": arm})
    placed = PLACE.plan(work_of(step, surface("table"), "wipe_1", scene, arm, profile))
    pose, table = placed.T_world_placed, found(profile, "table")
    assert pose is not None
    x, y, z = scene.standing["table"].T_world_object.locate(pose.position_m)
    radius = math.hypot(*found(profile, "wipe_1").size_m[:2]) / 2
    assert z == pytest.approx(table.size_m[2]), "it stands on the top"
    assert pose.axes()[2] == pytest.approx((0.0, 0.0, 1.0))
    assert abs(x) + radius <= table.size_m[0] / 2 - 0.0199 or x == 0.0
    assert abs(y) + radius <= table.size_m[1] / 2 - 0.0199 or y == 0.0
    around = Cylinder(radius, found(profile, "wipe_1").size_m[2])
    for name, other in scene.standing.items():
        thing = found(profile, name)
        if name in ("table", "floor") or not isinstance(thing.shape, (Box, Cylinder)):
            continue
        assert apart_m([body(around, pose)], [body(thing.shape, other.T_world_object)]) > 0.0499, name


@settings(max_examples=60, deadline=None)
@given(
    st.floats(0.012, 0.042), st.floats(0.06, 0.18), st.floats(0.01, 0.06), st.floats(0.05, 0.2),
    st.floats(0.05, 0.95), st.floats(0.02, 1.0), ON_TABLE, SIDES,
)  # fmt: skip
def test_a_pour_clears_the_rim_and_stays_over_the_opening_on_its_whole_arc(
    radius: float, height: float, opening_r: float, high: float, fill: float, share: float,
    where: tuple[float, ...], arm: Side,
) -> None:  # fmt: skip
    profile, world = bench()
    liquid = found(profile, "beaker_3").liquid
    assert liquid is not None
    inner_r = radius - 0.001
    capacity = 0.95 * math.pi * inner_r**2 * (height - 0.001)
    source = replace(liquid, inner_diameter_m=2 * inner_r, capacity_m3=capacity, dead_volume_m3=0.0)
    target = replace(liquid, inner_diameter_m=2 * opening_r)
    profile = shaped(profile, "beaker_3", Cylinder(radius, height), liquid=source)
    profile = shaped(profile, "beaker_1", Cylinder(opening_r + 0.001, high), liquid=target)
    x, y, yaw = where
    world = moved(world, "beaker_1", Pose.from_rpy((x, y, 0.75), (0.0, 0.0, yaw)))
    scene = holding("beaker_3", Scene.of(world, profile), arm, profile)
    inside_ml = max(1.0, round(capacity * fill * 1e6, 1))
    volume = parse_quantity(f"{max(0.5, round(inside_ml * share - 0.05, 1))} mL")
    assume(volume.si < inside_ml * 1e-6 and inside_ml * 1e-6 <= capacity)
    known = Fact("volume", "beaker_3", parse_quantity(f"{inside_ml} mL"))
    args = {"source": obj("beaker_3"), "target": obj("beaker_1"), "volume": volume, "arm": arm}
    work = work_of(step_of("pour", args, known), obj("beaker_1"), "beaker_3", scene, arm, profile)
    planned = POUR.plan(work)
    axis, angle = planned.axes["pour_lip"], planned.settings["pour_angle"].si("Angle")
    T_base_target = scene.T_base_object("beaker_1")
    lip_x, lip_y, lip_z = T_base_target.locate(axis.point_m)
    assert math.hypot(lip_x, lip_y) < opening_r, "the lip is over the opening"
    assert lip_z >= high + 0.0149, "and above the rim"
    upright = planned.aims["pour_above"].target.T_base_reference
    rim = [(radius * math.cos(k * math.pi / 18), radius * math.sin(k * math.pi / 18)) for k in range(36)]
    for step in range(9):
        turned = Turn(axis.point_m, axis.direction, angle * step / 8).end() @ upright
        lowest = min(T_base_target.locate(turned.apply((x, y, z)))[2] for x, y in rim for z in (0.0, height))
        assert lowest >= high + 0.0149, "the whole vessel clears the rim"
        lip = turned.locate(axis.point_m)
        assert (math.hypot(lip[0], lip[1]), lip[2]) == pytest.approx((radius, height), abs=1e-9)
    tilted = planned.aims["pour_tilt"].target.T_base_reference
    assert tilted.position_m == pytest.approx(turned.position_m, abs=1e-9)
    mouth = tilted.apply((0.0, 0.0, height))
    assert mouth[2] > axis.point_m[2] - 1e-9, "it tilts over the lip, not away from it"


FACE_M = (0.10, 0.08)
SCREENS = st.builds(
    lambda x, y, z, yaw: Pose.from_rpy((x, y, z), (0.0, 0.0, yaw)),
    st.floats(0.65, 0.85), st.floats(-0.4, 0.4), st.floats(0.78, 1.1), st.floats(-0.7, 0.7),
)  # fmt: skip
SHARES = st.floats(0.05, 0.95)


def fingertips(scene: Scene, planned, name: str) -> list[tuple[float, float, float]]:
    """For each way to point, where the fingertips are at a point: into the face, to the right and up from its
    lower left corner.
    """
    target, profile = planned.aims[name].target, bench()[0]
    depth, width, _ = found(profile, "incubator_screen").size_m
    back = Pose(target.offset_tool_m)
    tips: list[tuple[float, float, float]] = []
    for member in planned.family.members:
        T_base_tool = target.T_base_reference @ member.T_reference_tool @ back
        tip = T_base_tool.apply((0.0, 0.0, 0.0155))
        x, y, z = scene.T_base_object("incubator_screen").locate(tip)
        tips.append((x + depth / 2, width / 2 - y, z))
    return tips


def screen_with(center: tuple[float, float], size: tuple[float, float]) -> Profile:
    profile = bench()[0]
    screen = found(profile, "incubator_screen")
    element = Element("spot", center, size, screen.span)
    return with_object(profile, "incubator_screen", replace(screen, elements=(element,)))


def on_face(center: tuple[float, float], size: tuple[float, float]) -> bool:
    """Whether the whole element lies on the screen, to a micrometre."""
    face = found(bench()[0], "incubator_screen").size_m[1:]
    return all(
        half - 1e-6 <= middle <= long - half + 1e-6
        for middle, half, long in zip(center, (size[0] / 2, size[1] / 2), face, strict=True)
    )


@given(SCREENS, SHARES, SHARES, st.floats(0.004, 0.02), st.floats(0.004, 0.02), SIDES)
@settings(max_examples=40, deadline=None)
def test_a_tap_comes_down_the_elements_normal_or_aslant_and_ends_on_it(
    T_world_screen: Pose, right: float, up: float, width: float, height: float, arm: Side
) -> None:
    _, face_w, face_h = found(bench()[0], "incubator_screen").size_m
    center = (right * face_w, up * face_h)
    profile = screen_with(center, (width, height))
    scene = Scene.of(moved(bench()[1], "incubator_screen", T_world_screen), profile)
    step = step_of("tap", {"screen": obj("incubator_screen"), "element": "spot", "arm": arm})
    work = work_of(step, obj("incubator_screen"), "incubator_screen", scene, arm, profile)
    if not on_face(center, (width, height)):
        with pytest.raises(Refusal, match="is not on the face"):
            TAP.plan(work)
        return
    planned = TAP.plan(work)
    ends, starts = fingertips(scene, planned, "tap"), fingertips(scene, planned, "tap_above")
    straight = 0
    for (into, x, z), (before, sx, sz) in zip(ends, starts, strict=True):
        assert into == pytest.approx(0.0, abs=1e-9)
        assert abs(x - center[0]) <= width / 2
        assert abs(z - center[1]) <= height / 2
        assert -before >= 0.05 * math.cos(math.radians(60.0)) * math.cos(math.radians(40.0)) - 1e-9
        straight += math.hypot(sx - x, sz - z) < 1e-9
    assert straight == 2, "once along the normal, and rolled"


@given(
    SCREENS, SHARES, SHARES, st.floats(0.005, 0.15), st.sampled_from(["left", "right", "up", "down"]), SIDES
)
@settings(max_examples=60, deadline=None)
def test_a_swipe_stays_on_the_screen_or_is_refused(
    T_world_screen: Pose, right: float, up: float, length_m: float, direction: str, arm: Side
) -> None:
    _, face_w, face_h = found(bench()[0], "incubator_screen").size_m
    center = (right * face_w, up * face_h)
    profile = screen_with(center, (0.01, 0.01))
    scene = Scene.of(moved(bench()[1], "incubator_screen", T_world_screen), profile)
    distance = parse_quantity(f"{length_m * 1000:.2f} mm")
    args = {"screen": obj("incubator_screen"), "element": "spot", "direction": direction, "arm": arm}
    step = step_of("swipe", {**args, "distance": distance})
    work = work_of(step, obj("incubator_screen"), "incubator_screen", scene, arm, profile)
    room = {"left": center[0], "right": face_w - center[0], "up": face_h - center[1], "down": center[1]}
    if distance.si > room[direction] or not on_face(center, (0.01, 0.01)):
        with pytest.raises(Refusal) as refused:
            SWIPE.plan(work)
        assert refused.value.diagnostic.code == "XEI0720"
        return
    planned = SWIPE.plan(work)
    way = {"left": (-1, 0), "right": (1, 0), "up": (0, 1), "down": (0, -1)}[direction]
    starts, ends = (fingertips(scene, planned, name) for name in ("swipe_start", "swipe_end"))
    for (into, x, z), (still, to_x, to_z) in zip(starts, ends, strict=True):
        assert (into, still) == pytest.approx((0.0, 0.0), abs=1e-9), "on the face all along"
        assert (x, z) == pytest.approx(center, abs=1e-9)
        assert (to_x - x, to_z - z) == pytest.approx((way[0] * distance.si, way[1] * distance.si), abs=1e-9)
        assert -1e-9 <= to_x <= face_w + 1e-9
        assert -1e-9 <= to_z <= face_h + 1e-9


TOOLS = st.builds(lambda x, y: Box((x, y, 0.08)), st.floats(0.02, 0.08), st.floats(0.02, 0.08))


@given(TOOLS, st.integers(60, 120), st.integers(60, 180), YAWS, SIDES)
@settings(max_examples=60, deadline=None)
def test_a_wipe_covers_its_area_and_nothing_else(
    tool: Box, length_mm: int, width_mm: int, yaw: float, arm: Side
) -> None:
    profile, world = bench()
    profile = shaped(profile, "wipe_1", tool)
    # Grasped turned as it may stand; it wipes along the surface's axes all the same.
    world = moved(world, "wipe_1", Pose.from_rpy((0.6, 0.3, 0.75), (0.0, 0.0, yaw)))
    scene = holding("wipe_1", Scene.of(world, profile), arm, profile)
    place = spot("table", "front")
    size = {"length": parse_quantity(f"{length_mm} mm"), "width": parse_quantity(f"{width_mm} mm")}
    step = step_of("wipe", {"object": obj("wipe_1"), "on": place, **size, "arm": arm})
    work = work_of(step, place, "wipe_1", scene, arm, profile)
    try:
        planned, code = WIPE.plan(work), ""
    except Refusal as refused:
        planned, code = None, refused.diagnostic.code
    if planned is None:
        assert code == "XEI0721"
        assert min(length_mm, width_mm) < 1000 * max(tool.size_m[:2]) + 1e-6, "there is room either way"
        return
    area, pitch = planned.areas["wipe_area"], planned.settings["lane_pitch"].si("Length")
    raster = Raster(area.corner_m, area.along_m, area.across_m, pitch)
    T_base_table = scene.T_base_object("table")
    front = next(item for item in found(profile, "table").spots if item.name == "front")
    T_base_front = T_base_table @ Pose(front.T_object_spot.position_m)
    start = planned.aims["wipe_start"].target.T_base_reference
    turned = T_base_front.inverse() @ Pose(T_base_front.position_m, start.quaternion)
    cos = abs(turned.axes()[0][0])
    assert min(cos, 1.0 - cos) < 1e-9, "along the surface's axes"
    half = [edge / 2 for edge in (tool.size_m[:2] if cos > 0.5 else tool.size_m[1::-1])]
    bounds = (length_mm / 2000, width_mm / 2000)
    lanes = [
        tuple(
            T_base_front.locate(
                tuple(
                    c + end * a + b * k / max(1, raster.lanes - 1)
                    for c, a, b in zip(raster.corner_m, raster.along_m, raster.across_m, strict=True)
                )
            )
            for end in (0.0, 1.0)
        )
        for k in range(raster.lanes)
    ]
    for lane in lanes:
        for x, y, z in lane:
            assert z == pytest.approx(0.0, abs=1e-9), "on the surface"
            assert abs(x) + half[0] <= bounds[0] + 1e-9
            assert abs(y) + half[1] <= bounds[1] + 1e-9
    for i in range(13):
        for j in range(13):
            point = (bounds[0] * (i / 6 - 1), bounds[1] * (j / 6 - 1))
            assert any(under(point, lane, half) for lane in lanes), point


def under(point: tuple[float, float], lane, half: list[float]) -> bool:
    """Whether the tool's outline passes over a point on its way along a lane."""
    return all(
        min(a[k], b[k]) - half[k] - 1e-9 <= point[k] <= max(a[k], b[k]) + half[k] + 1e-9
        for a, b in (lane,)
        for k in (0, 1)
    )
