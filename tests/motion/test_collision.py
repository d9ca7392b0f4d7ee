from __future__ import annotations

import itertools

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive, Sphere, Vec3
from xei_lang.motion.collision import AttachedBody, CollisionScene, Contact, StaticBody, collision_scene
from xei_lang.motion.collision.bodies import robot_links, scene_geometry
from xei_lang.motion.collision.edges import MotionBound, edge_is_free, motion_bound
from xei_lang.motion.robot import SIDES, Array, Robot, Side

TUBE = (Primitive(Cylinder(0.0085, 0.118), Pose((0.0, 0.0, 0.059))),)


def table(height_m: float, edge_x_m: float = 0.49) -> StaticBody:
    top = Primitive(Box((0.8, 1.6, 0.03)), Pose((0.4, 0.0, -0.015)))
    return StaticBody("table", (top,), Pose((edge_x_m, 0.0, height_m)))


def fingers(side: Side) -> list[str]:
    return [f"openarm_{side}_{finger}_finger" for finger in SIDES]


def at_grasp(robot: Robot, q: Array, point: Vec3, side: Side = "right") -> Pose:
    """The pose in the base frame of a frame with the grasp frame's axes at a point of it."""
    T = robot.T_base_frame(q, f"openarm_{side}_grasp")
    origin, *axes = (T @ [*point, 1.0])[:3], *T[:3, :3].T
    vectors = [(float(x), float(y), float(z)) for x, y, z in (origin, *axes)]
    return Pose.from_axes(vectors[0], vectors[1], vectors[2], vectors[3])


@pytest.mark.parametrize("state", ["home", "ready", "transport"])
@pytest.mark.parametrize("opening", ["open", "half_closed", "closed"])
def test_named_poses_clear_tables_at_every_slide_height(robot: Robot, state: str, opening: str) -> None:
    q = robot.configuration(opening, onto=robot.configuration(state))
    for height in (0.70, 0.76, 0.80):
        scene = collision_scene(robot, (table(height),), padding_m=0.02)
        for slide in np.linspace(0.0, 0.6, 13):
            q[robot.slide_index] = slide
            assert scene.first_contact(q) is None


def test_a_link_in_the_table_is_named(robot: Robot) -> None:
    q = robot.configuration("ready")
    scene = collision_scene(robot, (table(0.93),))
    assert scene.in_collision(q)
    contact = scene.first_contact(q)
    assert contact is not None
    assert contact.body_b == "table"
    assert contact.body_a.startswith("openarm_")
    assert scene.distance(q)[0] < 0.0


def test_the_arms_are_checked_against_each_other(robot: Robot) -> None:
    q = robot.configuration("home")
    for side, sign in (("left", 1.0), ("right", -1.0)):
        q[robot.arm(side).span] = [-sign * 0.5, -sign * 0.0, sign * 1.2, 1.9, 0.0, 0.0, 0.0]
    contact = collision_scene(robot).first_contact(q)
    assert contact is not None
    assert "left" in contact.body_a
    assert "right" in contact.body_b


def test_distance_is_the_least_over_all_pairs(robot: Robot) -> None:
    q = robot.configuration("ready")
    ball = StaticBody("ball", (Primitive(Sphere(0.01)),), at_grasp(robot, q, (0.0, 0.0, 0.0455)))
    distance, first, second = collision_scene(robot, (ball,)).distance(q)
    assert second == "ball"
    assert first in fingers("right")
    assert 0.0 < distance < 0.04


def test_padding_keeps_what_moves_from_what_stands(robot: Robot) -> None:
    q = robot.configuration("ready")
    ball = StaticBody("ball", (Primitive(Sphere(0.01)),), at_grasp(robot, q, (0.0, 0.0, 0.0455)))
    distance = collision_scene(robot, (ball,)).distance(q)[0]
    assert not collision_scene(robot, (ball,), padding_m=distance - 1e-3).in_collision(q)
    assert collision_scene(robot, (ball,), padding_m=distance + 1e-3).in_collision(q)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("gap_m", [0.0, 0.004, 0.017, 0.06])
def test_the_jaws_are_as_far_apart_as_told(robot: Robot, side: Side, gap_m: float) -> None:
    """A slab on the grasp plane fits between the pads exactly when it is thinner than the opening."""
    q = robot.with_opening(robot.configuration("ready"), side, gap_m)
    pose = at_grasp(robot, q, (0.0, 0.0, 0.0), side)
    for thickness, fits in ((gap_m - 0.001, True), (gap_m + 0.001, False)):
        if thickness > 0.0:
            slab = StaticBody("slab", (Primitive(Box((0.01, thickness, 0.01))),), pose)
            assert collision_scene(robot, (slab,)).in_collision(q) is not fits


def test_closed_fingers_do_not_overlap(robot: Robot) -> None:
    links = robot_links(robot)
    data = pin.GeometryData(links)
    q = robot.configuration("closed")
    pin.updateGeometryPlacements(robot.model, robot.model.createData(), links, data, q)
    for side in SIDES:
        rows = [
            [
                k
                for k, item in enumerate(links.geometryObjects)
                if robot.model.frames[item.parentFrame].name == name
            ]
            for name in fingers(side)
        ]
        assert [len(row) for row in rows] == [6, 6]
        for pair in itertools.product(*rows):
            index = pin.CollisionPair(*sorted(pair))
            links.addCollisionPair(index)
    data = pin.GeometryData(links)
    pin.updateGeometryPlacements(robot.model, robot.model.createData(), links, data, q)
    pin.computeDistances(links, data)
    assert min(result.min_distance for result in data.distanceResults) > -1e-9


def test_a_held_object_may_touch_its_fingers_and_nothing_else(robot: Robot) -> None:
    q = robot.with_opening(robot.configuration("ready"), "right", 0.016)
    tube = AttachedBody("tube_a", TUBE, "right", Pose.from_rpy((0.059, 0.0, 0.0), (0.0, -np.pi / 2, 0.0)))
    scene = collision_scene(robot).with_attached(tube)
    assert scene.first_contact(q) is None
    block = StaticBody("block", (Primitive(Box((0.02, 0.02, 0.02))),), at_grasp(robot, q, (0.05, 0.0, 0.0)))
    assert scene.with_standing(block).first_contact(q) == Contact("block", "tube_a")
    assert not scene.with_standing(block).with_allowed((("tube_a", "block"),)).in_collision(q)
    assert not scene.with_standing(block).without("tube_a").in_collision(q)


def test_taking_an_object_up_removes_the_standing_one(robot: Robot) -> None:
    standing = StaticBody("tube_a", TUBE, Pose((0.7, 0.0, 0.9)))
    scene = collision_scene(robot, (standing,)).with_attached(AttachedBody("tube_a", TUBE, "left", Pose()))
    assert [body.name for body in scene.standing] == []
    back = scene.with_standing(standing)
    assert [body.name for body in back.attached] == []
    assert [body.name for body in scene.attached] == ["tube_a"]


def test_rows_are_checked_as_single_configurations(robot: Robot) -> None:
    rng = np.random.default_rng(5)
    scene = collision_scene(robot, (table(0.75),))
    q = rng.uniform(robot.lower, robot.upper, (200, robot.nq))
    many = scene.in_collision_many(q)
    assert many.tolist() == [scene.in_collision(row) for row in q]
    assert many.tolist() == [scene.distance(row)[0] <= 0.0 for row in q]
    assert 0 < many.sum() < 200


def bound_of(scene: CollisionScene) -> MotionBound:
    geometry = scene_geometry(scene.robot, robot_links(scene.robot), scene.standing, scene.attached)
    return motion_bound(scene.robot, geometry, np.triu(geometry.joint[:, None] != geometry.joint, 1))


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 10_000), step=st.floats(1e-3, 1.0))
def test_no_point_moves_further_than_the_bound(robot: Robot, seed: int, step: float) -> None:
    rng = np.random.default_rng(seed)
    tube = AttachedBody("tube_a", TUBE, "right", Pose.from_rpy((0.059, 0.0, 0.0), (0.0, -1.5, 0.0)))
    bound = bound_of(collision_scene(robot, (table(0.75),), (tube,)))
    q_start = rng.uniform(robot.lower, robot.upper)
    q_end = q_start + step * (rng.uniform(robot.lower, robot.upper) - q_start)
    T_start, T_end = (robot.T_base_frame(q, "openarm_right_grasp") for q in (q_start, q_end))
    for point in ([0.0, 0.0, 0.0154], [0.0, 0.0, 0.0], [0.118, 0.0, 0.0]):
        moved = np.linalg.norm((T_end - T_start) @ [*point, 1.0])
        assert moved <= bound.closing_m(q_start, q_end) + 1e-12


def sweep(robot: Robot) -> tuple[Array, Array]:
    """Half a radian of the right shoulder with the arm stretched out: the hand swings through about 0.3 m."""
    q_start, q_end = robot.configuration("ready"), robot.configuration("ready")
    q_start[robot.arm("right").span] = [0.95, 0.2, 0.0, 0.3, 0.0, 0.0, 0.0]
    q_end[robot.arm("right").span] = [1.45, 0.2, 0.0, 0.3, 0.0, 0.0, 0.0]
    return q_start, q_end


def test_a_wire_across_the_edge_is_found_where_sampling_is_blind(robot: Robot) -> None:
    q_start, q_end = sweep(robot)
    empty = collision_scene(robot)
    assert empty.edge_is_free(q_start, q_end)
    found, blind = 0, 0
    for share in np.linspace(0.05, 0.95, 19):
        q = q_start + share * (q_end - q_start)
        wire = StaticBody(
            "wire", (Primitive(Capsule(0.0005, 0.003)),), at_grasp(robot, q, (0.0, 0.004, 0.013))
        )
        scene = empty.with_standing(wire)
        found += not scene.edge_is_free(q_start, q_end)
        blind += scene.edge_is_free_sampled(q_start, q_end, 0.05)
    assert found == 19
    assert blind > 0


@settings(max_examples=15, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_a_free_edge_has_no_sample_in_collision(robot: Robot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = collision_scene(robot, (table(0.75),))
    q_start, q_end = robot.configuration("ready"), robot.configuration("ready")
    for q in (q_start, q_end):
        q[robot.arm("left").span] = rng.uniform(robot.lower, robot.upper)[robot.arm("left").span]
    if scene.edge_is_free(q_start, q_end):
        samples = q_start + np.linspace(0.0, 1.0, 400)[:, None] * (q_end - q_start)
        assert max(-scene.distance(row)[0] for row in samples) <= 0.0005


def test_an_edge_of_no_length_is_its_configuration(robot: Robot) -> None:
    q = robot.configuration("ready")
    assert collision_scene(robot).edge_is_free(q, q)
    assert not collision_scene(robot, (table(0.93),)).edge_is_free(q, q)


def test_an_edge_is_refused_at_the_first_touch() -> None:
    asked: list[float] = []

    def is_clear(q: Array, margin_m: float) -> bool:
        asked.append(margin_m)
        return False

    assert not edge_is_free(MotionBound(np.ones((1, 1))), np.zeros(1), np.ones(1), is_clear)
    assert asked == [0.04, 0.0]
