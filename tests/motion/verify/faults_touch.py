"""Faults of touch: objects in the way, paths into objects, contacts that nothing allows."""

from __future__ import annotations

from dataclasses import replace

import coal
import numpy as np
import pinocchio as pin

from tests.motion.verify.fault_bench import Bench, Fault, base_of, carries, free_objects
from tests.motion.verify.fault_paths import bump, middle_time, resampled
from xei_lang.ir.geometry import Box, Cylinder, Pose, Sphere
from xei_lang.ir.goals import Attach


def object_in_path(bench: Bench) -> Fault | None:
    """An object that nobody holds or may touch is put where a shape of a moving link passes, centre on
    centre: two convex shapes that share a point overlap."""
    free = free_objects(bench)
    if not free:
        return None
    goal, item = bench.random.choice(bench.moving), bench.random.choice(free)
    assert goal.knots is not None
    time = goal.start_s + bench.random.uniform(0.2, 0.8) * goal.knots.times_s[-1]
    q = bench.arm.vector(bench.joints_at(time))
    geometry = _geometry(bench)
    placements = geometry.createData()
    pin.updateGeometryPlacements(bench.arm.model, bench.arm.data, geometry, placements, q)
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    shapes = [
        k
        for k, shape in enumerate(geometry.geometryObjects)
        if joints.intersection(bench.arm.model.supports[shape.parentJoint])
    ]
    point = placements.oMg[bench.random.choice(shapes)].translation
    T_base_shape = Pose(tuple(map(float, point)))
    T_world_object = base_of(bench, goal) @ T_base_shape @ item.geometry[0].T_object_shape.inverse()
    T_frame_object = bench.world.T_world_frame(item.frame_id).inverse() @ T_world_object
    objects = tuple(
        replace(o, T_frame_object=T_frame_object) if o.name == item.name else o for o in bench.world.objects
    )
    return bench.fault("object in the path", "collision", world=replace(bench.world, objects=objects))


def path_into_body(bench: Bench) -> Fault | None:
    """A bump bends the path, half way, at least 2 mm deep (coal) into an object that nobody holds or may
    touch."""
    free = free_objects(bench)
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    geometry = _geometry(bench)
    data = geometry.createData()
    joints = {bench.arm.names.index(joint) + 1 for joint in goal.joints}
    moved = [
        k
        for k, s in enumerate(geometry.geometryObjects)
        if joints.intersection(bench.arm.model.supports[s.parentJoint])
    ]
    T_base_world = base_of(bench, goal).inverse()
    for _ in range(40):
        column, height = bench.random.randrange(len(goal.joints)), bench.random.uniform(-1.2, 1.2)
        plan = bench.with_goal(resampled(goal, bump(goal.knots, column, height)))
        q = bench.arm.vector(bench.joints_at(goal.start_s + middle_time(goal.knots), plan))
        pin.updateGeometryPlacements(bench.arm.model, bench.arm.data, geometry, data, q)
        for item in free:
            T_base_object = T_base_world @ bench.world.T_world_object(item.name)
            for primitive in item.geometry:
                pose = _se3(T_base_object @ primitive.T_object_shape)
                if any(
                    _depth(geometry.geometryObjects[k].geometry, data.oMg[k], _coal(primitive.shape), pose)
                    < -2e-3
                    for k in moved
                ):
                    return bench.fault("path into a body", "collision", plan)
    return None


def contact_not_allowed(bench: Bench) -> Fault | None:
    """The allowed contact of a held object with what it stands in is taken away from a goal that moves the
    object, where coal finds the two at least 0.1 mm in each other as the goal starts or ends."""
    choices = []
    held = {item.object for goal in bench.plan.goals for item in goal.attached}
    for goal in (goal for goal in bench.moving if carries(bench, goal)):
        for item in goal.attached:
            for pair in goal.allowed_contacts:
                other = bench.world.find(pair[0] if pair[1] == item.object else pair[1])
                if item.object in pair and other is not None and other.name not in held:
                    choices.append((goal, item, pair, other))
    if not choices:
        return None
    goal, item, pair, other = bench.random.choice(choices)
    found = bench.world.find(item.object)
    assert found is not None
    assert goal.knots is not None
    T_base_world = base_of(bench, goal).inverse()
    for time in (goal.start_s, goal.end_s):
        T_base_object = bench.arm.tool(bench.joints_at(time), item.link) @ item.T_link_object
        T_base_other = T_base_world @ bench.world.T_world_object(other.name)
        deep = any(
            _depth(
                _coal(a.shape),
                _se3(T_base_object @ a.T_object_shape),
                _coal(b.shape),
                _se3(T_base_other @ b.T_object_shape),
            )
            < -1e-4
            for a in found.geometry
            for b in other.geometry
        )
        if deep:
            kept = tuple(p for p in goal.allowed_contacts if p != pair)
            return bench.fault(
                "contact not allowed", "collision", bench.with_goal(replace(goal, allowed_contacts=kept))
            )
    return None


def thinner_than_the_grip(bench: Bench) -> Fault | None:
    """What a hand takes is round, and 6 to 12 mm thinner than the jaws closed: each stays 3 to 6 mm off."""
    taken = sorted({goal.action.object for goal in bench.graph.goals if isinstance(goal.action, Attach)})
    if not taken:
        return None
    name, less = bench.random.choice(taken), bench.random.uniform(0.003, 0.006)

    def thinner(part):
        assert isinstance(part.shape, Cylinder)
        return replace(part, shape=replace(part.shape, radius_m=part.shape.radius_m - less))

    objects = tuple(
        replace(item, geometry=tuple(map(thinner, item.geometry))) if item.name == name else item
        for item in bench.world.objects
    )
    return bench.fault("thinner than the grip", "grip", world=replace(bench.world, objects=objects))


def _geometry(bench: Bench):
    return pin.buildGeomFromUrdfString(bench.arm.model, bench.robot.urdf_text, pin.GeometryType.COLLISION)


def _se3(pose: Pose):
    matrix = np.array(pose.matrix())
    return pin.SE3(matrix[:3, :3], matrix[:3, 3])


def _coal(shape):
    if isinstance(shape, Box):
        return coal.Box(*shape.size_m)
    if isinstance(shape, Sphere):
        return coal.Sphere(shape.radius_m)
    kind = coal.Cylinder if isinstance(shape, Cylinder) else coal.Capsule
    return kind(shape.radius_m, shape.height_m)


def _depth(a, pose_a, b, pose_b) -> float:
    poses = [coal.Transform3s(pose.rotation, pose.translation) for pose in (pose_a, pose_b)]
    return float(coal.distance(a, poses[0], b, poses[1], coal.DistanceRequest(), coal.DistanceResult()))
