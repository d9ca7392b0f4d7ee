"""Links of the robot and objects of the world as one pinocchio geometry model, whose bodies can change
carriers."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np

from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive, Shape, Sphere
from xei_lang.ir.world import World
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.options import RobotDescription
from xei_lang.motion.verify.robot import Robot
from xei_lang.motion.verify.timeline import Scene
from xei_lang.motion.verify.torque import to_se3

pin: Any = importlib.import_module("pinocchio")  # ships no type information
coal: Any = importlib.import_module("coal")  # ships no type information


@dataclass(frozen=True, slots=True)
class Body:
    """A link or an object: its shapes' indices in the geometry model, and its bounds in its own frame.

    `center` and `radius` bound all shapes by one sphere; `low` and `high` by a box along the frame's axes.
    """

    name: str
    is_link: bool
    shapes: tuple[int, ...]
    center: Array
    radius: float
    low: Array
    high: Array


class Bodies:
    """The geometry model with all bodies and, for every pair of them that may be checked, its pairs of
    shapes."""

    def __init__(self, robot: Robot, about: RobotDescription, world: World) -> None:
        self.robot = robot
        self.geometry: Any = pin.buildGeomFromUrdfString(
            robot.model, about.urdf_text, pin.GeometryType.COLLISION
        )
        by_frame: dict[str, list[int]] = {}
        for index, shape in enumerate(self.geometry.geometryObjects):
            by_frame.setdefault(str(robot.model.frames[shape.parentFrame].name), []).append(index)
        self.bodies: dict[str, Body] = {}
        self._local: dict[int, Any] = {}
        for link, indices in by_frame.items():
            self._add_link(link, indices)
        for item in world.objects:
            if item.geometry:
                self._add_object(item.name, item.geometry)
        self.disabled = disabled_pairs(about.srdf_text)
        self._pairs: dict[tuple[str, str], tuple[int, ...]] = {}
        self.model, self.data = robot.model, robot.model.createData()
        self.geometry_data: Any = None

    def _add_link(self, link: str, indices: list[int]) -> None:
        frame = self.robot.model.frames[self.robot.model.getFrameId(link)]
        for index in indices:
            self._local[index] = frame.placement.actInv(self.geometry.geometryObjects[index].placement)
        self.bodies[link] = self._body(link, True, tuple(indices))

    def _add_object(self, name: str, primitives: tuple[Primitive, ...]) -> None:
        indices: list[int] = []
        for number, primitive in enumerate(primitives):
            local = to_se3(primitive.T_object_shape)
            shape = pin.GeometryObject(f"{name}/{number}", 0, 0, local, coal_shape(primitive.shape))
            index = int(self.geometry.addGeometryObject(shape))
            self._local[index] = local
            indices.append(index)
        self.bodies[name] = self._body(name, False, tuple(indices))

    def _body(self, name: str, is_link: bool, shapes: tuple[int, ...]) -> Body:
        corners: list[Array] = []
        for index in shapes:
            shape = self.geometry.geometryObjects[index].geometry
            shape.computeLocalAABB()
            low, high = np.array(shape.aabb_local.min_), np.array(shape.aabb_local.max_)
            signs = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
            local = self._local[index]
            corners.append((low + signs * (high - low)) @ np.array(local.rotation).T + local.translation)
        points = np.concatenate(corners)
        low, high = points.min(axis=0), points.max(axis=0)
        center = 0.5 * (low + high)
        radius = float(np.linalg.norm(points - center, axis=1).max())
        return Body(name, is_link, shapes, center, radius, low, high)

    def add_pair(self, pair: tuple[str, str]) -> None:
        """Make the shapes of a pair of bodies known as pairs whose distance can be asked for."""
        if pair in self._pairs:
            return
        first = len(self.geometry.collisionPairs)
        for i in self.bodies[pair[0]].shapes:
            for j in self.bodies[pair[1]].shapes:
                self.geometry.addCollisionPair(pin.CollisionPair(min(i, j), max(i, j)))
        self._pairs[pair] = tuple(range(first, len(self.geometry.collisionPairs)))
        self.geometry_data = None

    def shape_pairs(self, pair: tuple[str, str]) -> tuple[int, ...]:
        """Indices of a body pair's shape pairs."""
        return self._pairs[pair]

    def arrange(self, scene: Scene) -> None:
        """Put every object where the scene has it: on its carrier, or standing in the base frame."""
        carriers = {held.object: held for held in scene.held}
        for body in self.bodies.values():
            if body.is_link:
                continue
            joint, pose = 0, to_se3(scene.objects[body.name])
            if body.name in carriers:
                held = carriers[body.name]
                frame = self.model.frames[self.model.getFrameId(held.link)]
                joint, pose = frame.parentJoint, frame.placement * to_se3(held.T_link_object)
            for index in body.shapes:
                shape = self.geometry.geometryObjects[index]
                shape.parentJoint = joint
                shape.placement = pose * self._local[index]

    def move(self, q: Array) -> None:
        """Place all shapes for a configuration."""
        if self.geometry_data is None:
            self.geometry_data = self.geometry.createData()
        pin.updateGeometryPlacements(self.model, self.data, self.geometry, self.geometry_data, q)

    def distance(self, shape_pair: int) -> float:
        """Signed distance between two shapes, m (negative: how deep they are in each other)."""
        return float(pin.computeDistance(self.geometry, self.geometry_data, shape_pair).min_distance)


def coal_shape(shape: Shape) -> Any:
    """The collision shape of a primitive."""
    if isinstance(shape, Box):
        return coal.Box(*shape.size_m)
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius_m)
    if isinstance(shape, Cylinder):
        return coal.Cylinder(shape.radius_m, shape.height_m)
    return coal.Capsule(shape.radius_m, shape.height_m)


def disabled_pairs(srdf_text: str) -> frozenset[tuple[str, str]]:
    """Pairs of links that are never checked, each in both orders."""
    root = ElementTree.fromstring(srdf_text)
    pairs = [(str(e.get("link1")), str(e.get("link2"))) for e in root.findall("disable_collisions")]
    return frozenset([*pairs, *((b, a) for a, b in pairs)])


def group_links(srdf_text: str, robot: Robot) -> dict[str, tuple[str, ...]]:
    """Links that the joints of each SRDF group move directly, mimic joints with their leader's group."""
    groups: dict[str, tuple[str, ...]] = {}
    for group in ElementTree.fromstring(srdf_text).findall("group"):
        names = [str(joint.get("name")) for joint in group.findall("joint")]
        names += [joint.name for joint in robot.mimics if joint.mimic and joint.mimic[0] in names]
        groups[str(group.get("name"))] = tuple(
            robot.joints[name].child for name in names if name in robot.joints
        )
    return groups


def to_frame(pose: Pose) -> tuple[Array, Array]:
    """Rotation (3, 3) and origin (3,) of a pose."""
    matrix = np.array(pose.matrix())
    return matrix[:3, :3], matrix[:3, 3]
