"""Bodies of a collision scene as coal geometry: links, objects that stand, objects that a hand holds."""

from __future__ import annotations

import importlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Box, Capsule, Cylinder, Pose, Primitive, Shape, Sphere
from xei_lang.motion.robot import Array, Robot, Side

pin: Any = importlib.import_module("pinocchio")  # ships no type information
coal: Any = importlib.import_module("coal")


@dataclass(frozen=True, slots=True)
class StaticBody:
    """An object that stands still in the base frame while the arms move. `name` is what messages quote."""

    name: str
    primitives: tuple[Primitive, ...]
    T_base_object: Pose


@dataclass(frozen=True, slots=True)
class AttachedBody:
    """An object fixed in an arm's tool frame. It may touch the fingers that hold it; where it `rides_on`
    another one that they hold, it may touch that one, and what else rides there, but not the fingers.
    """

    name: str
    primitives: tuple[Primitive, ...]
    side: Side
    T_tool_object: Pose
    rides_on: str = ""


@dataclass(frozen=True, slots=True)
class Geometry:
    """All geometry of a scene, one row each: coal objects in pinocchio's model, the body's name and its
    joint.

    joint: (g,) pinocchio's joint index, 0 for what stands still. held: (g,) bool, held by a hand.
    """

    model: Any = field(repr=False)
    names: tuple[str, ...]
    joint: NDArray[np.int64]
    held: NDArray[np.bool_]


def scene_geometry(
    robot: Robot, links: Any, standing: tuple[StaticBody, ...], attached: tuple[AttachedBody, ...]
) -> Geometry:
    """Geometry of robot and bodies. `links` is the robot's own geometry model as `robot_links` makes it."""
    model = links.copy()
    names = [str(robot.model.frames[item.parentFrame].name) for item in model.geometryObjects]
    count = len(names)
    for body in standing:
        names += _add(model, body, 0, pin.SE3(np.array(body.T_base_object.matrix())))
    for body in attached:
        tool = robot.model.frames[robot.model.getFrameId(robot.arm(body.side).tool_frame)]
        placement = tool.placement * pin.SE3(np.array(body.T_tool_object.matrix()))
        names += _add(model, body, tool.parentJoint, placement)
    held_names = {body.name for body in attached}
    return Geometry(
        model=model,
        names=tuple(names),
        joint=np.array([item.parentJoint for item in model.geometryObjects], dtype=np.int64),
        held=np.array([row >= count and name in held_names for row, name in enumerate(names)]),
    )


def robot_links(robot: Robot) -> Any:
    """The links' collision geometry, read from the URDF."""
    return pin.buildGeomFromUrdfString(robot.model, robot.urdf_text, pin.GeometryType.COLLISION)


def _add(model: Any, body: StaticBody | AttachedBody, joint: int, T_joint_object: Any) -> list[str]:
    for index, primitive in enumerate(body.primitives):
        placement = T_joint_object * pin.SE3(np.array(primitive.T_object_shape.matrix()))
        model.addGeometryObject(
            pin.GeometryObject(f"{body.name}#{index}", joint, 0, placement, coal_shape(primitive.shape))
        )
    return [body.name] * len(body.primitives)


def coal_shape(shape: Shape) -> Any:
    """The collision shape of a primitive."""
    match shape:
        case Box(size_m):
            return coal.Box(*size_m)
        case Cylinder(radius_m, height_m):
            return coal.Cylinder(radius_m, height_m)
        case Sphere(radius_m):
            return coal.Sphere(radius_m)
        case Capsule(radius_m, height_m):
            return coal.Capsule(radius_m, height_m)


def ball(item: Any) -> tuple[Array, float]:
    """Centre (3,) in the joint's frame and radius in metres of a ball around a geometry object."""
    item.geometry.computeLocalAABB()
    center = np.asarray(item.placement.act(item.geometry.aabb_center))
    return center.copy(), float(item.geometry.aabb_radius)
