"""The calibration profile, from the validated model to dataclasses; ranges left out are the robot's."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.profiles.build_objects import pose, vec3
from xei_lang.profiles.model import (
    CalibratedFrame,
    Calibration,
    Camera,
    CarryPose,
    Lidar,
    MapFiles,
    Placeholder,
    PlanningLimit,
    RobotDescription,
    RobotJoint,
    SceneOrigin,
    Status,
    Tag,
    TagLayout,
)
from xei_lang.profiles.schema.calibration import CalibrationProfile, LimitModel
from xei_lang.profiles.yaml_tree import Node
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import ANGLE, LENGTH


def build_calibration(
    model: CalibrationProfile, robot: RobotDescription, root: Node, found: list[Diagnostic]
) -> Calibration:
    """The calibration of a deployment; what does not fit the robot is said in `found`."""
    docking = model.base.docking
    return Calibration(
        frames=tuple(_frames(model, root)),
        limits=tuple(_limits(model, robot, root, found)),
        stations=tuple(_stations(model, root)),
        start_station=model.start_station,
        table_height_m=model.table.height.si,
        table_height_status=model.table.status,
        table_bounds_m=(vec3(model.table.bounds.lower), vec3(model.table.bounds.upper)),
        workspace_bounds_m=(vec3(model.workspace.lower), vec3(model.workspace.upper)),
        map_frame=model.map.frame,
        docking_position_tolerance_m=docking.position.si,
        docking_rotation_tolerance_rad=docking.rotation.si,
        base_speed_m_s=model.base.speed.si,
        base_turn_rad_s=model.base.turn.si,
        payload_kg=model.payload.si,
        spill_tilt_rad=model.spill_tilt.si,
        clearance_m=model.clearance.si,
        placeholders=tuple(_placeholders(model, root)),
        robot_frames=tuple(model.robot_frames.items()),
        carry=tuple(_carry(model, root)),
        apriltags=_tag_layout(model, root),
        cameras=tuple(_cameras(model, root)),
        lidars=tuple(
            Lidar(name, one.frame, one.status, tuple(one.topics.items()), root.key_span("lidars", name))
            for name, one in model.lidars.items()
        ),
        map=_map(model, root),
    )


def _map(model: CalibrationProfile, root: Node) -> MapFiles:
    stated = model.map
    return MapFiles(
        stated.yaml or "",
        stated.image or "",
        stated.sha256 or "",
        stated.status,
        stated.measured_on or "",
        root.key_span("map"),
        root.span_of("map", "sha256"),
    )


def _frames(model: CalibrationProfile, root: Node) -> Iterator[CalibratedFrame]:
    for name, frame in model.frames.items():
        yield CalibratedFrame(
            name=name,
            parent=frame.parent,
            T_parent_frame=pose(frame.position, frame.rpy),
            status=frame.status,
            measured_on=frame.measured_on or "",
            method=frame.method,
            position_tolerance_m=frame.tolerance.position.si,
            rotation_tolerance_rad=frame.tolerance.rotation.si,
            span=root.key_span("frames", name),
        )


def _stations(model: CalibrationProfile, root: Node) -> Iterator[SceneOrigin]:
    for name, station in model.stations.items():
        yield SceneOrigin(
            name=name,
            aliases=tuple(station.aliases),
            T_world_base=pose(station.base.position, station.base.rpy),
            status=station.status,
            ground_frame=station.ground_frame,
            slide_m=station.slide.si,
            span=root.key_span("stations", name),
        )


def _carry(model: CalibrationProfile, root: Node) -> Iterator[CarryPose]:
    for arm, carry in model.carry.items():
        yield CarryPose(arm, vec3(carry.position), carry.status, carry.reason, root.key_span("carry", arm))


def _tag_layout(model: CalibrationProfile, root: Node) -> TagLayout:
    layout = model.apriltags
    tags = tuple(
        Tag(
            tag.id,
            tag.size.si,
            tag.frame,
            pose(tag.position, tag.rpy),
            root.span_of("apriltags", "tags", index),
        )
        for index, tag in enumerate(layout.tags)
    )
    return TagLayout(layout.family, layout.status, tags, layout.minimum_tags, layout.residual_px)


def _cameras(model: CalibrationProfile, root: Node) -> Iterator[Camera]:
    for name, camera in model.cameras.items():
        seen = camera.intrinsics
        yield Camera(
            name=name,
            frame=camera.frame,
            status=camera.status,
            fx=seen.fx,
            fy=seen.fy,
            cx=seen.cx,
            cy=seen.cy,
            width=seen.width,
            height=seen.height,
            distortion=tuple(seen.distortion),
            topics=tuple(camera.topics.items()),
            span=root.key_span("cameras", name),
        )


def _limits(
    model: CalibrationProfile, robot: RobotDescription, root: Node, found: list[Diagnostic]
) -> Iterator[PlanningLimit]:
    movable = [joint.name for joint in robot.joints if joint.kind != "fixed" and not joint.mimic]
    for index, limit in enumerate(model.limits):
        for position, name in enumerate(limit.joints):
            span = root.span_of("limits", index, "joints", position)
            joint = robot.joint(name)
            if joint is None or name not in movable:
                near = did_you_mean(name, movable)
                help_ = (
                    f"did you mean `{near[0]}`?"
                    if near
                    else "joints that can be planned: " + ", ".join(movable)
                )
                found.append(
                    Diagnostic(
                        "XEI0620",
                        f"the robot has no joint `{name}` that can be planned",
                        span,
                        label="unknown joint",
                        help=(help_,),
                    )
                )
            elif _units_fit(limit, joint, root, index, found):
                yield _limit(limit, joint, span)


def _limit(limit: LimitModel, joint: RobotJoint, span: Span) -> PlanningLimit:
    effort = limit.torque or limit.force
    return PlanningLimit(
        joint=joint.name,
        lower=limit.lower.si if limit.lower else joint.lower,
        upper=limit.upper.si if limit.upper else joint.upper,
        velocity=limit.velocity.si,
        acceleration=limit.acceleration.si,
        torque=effort.si if effort else joint.effort,
        reason=limit.reason,
        span=span,
    )


def _units_fit(limit: LimitModel, joint: RobotJoint, root: Node, index: int, found: list[Diagnostic]) -> bool:
    base = LENGTH if joint.kind == "prismatic" else ANGLE
    quantities: dict[str, Quantity | None] = {
        "lower": limit.lower,
        "upper": limit.upper,
        "velocity": limit.velocity,
        "acceleration": limit.acceleration,
    }
    for key, value in quantities.items():
        if value is None:
            continue
        wrong = value.dimension.angle != base.angle
        if wrong:
            wanted = "metres" if base == LENGTH else "radians or degrees"
            message = f"`{joint.name}` is {joint.kind}, and `{value}` does not measure its {key}"
            found.append(
                Diagnostic("XEI0610", message, root.span_of("limits", index, key), label=f"expected {wanted}")
            )
            return False
    wrong_effort = (
        "torque"
        if joint.kind == "prismatic" and limit.torque
        else "force"
        if base == ANGLE and limit.force
        else ""
    )
    if wrong_effort:
        other = "force" if wrong_effort == "torque" else "torque"
        message = f"`{joint.name}` is {joint.kind}, and has a {other}, no {wrong_effort}"
        found.append(
            Diagnostic(
                "XEI0610", message, root.key_span("limits", index, wrong_effort), label=f"expected `{other}`"
            )
        )
        return False
    return True


def _placeholders(model: CalibrationProfile, root: Node) -> Iterator[Placeholder]:
    """Everything that nobody has measured, in the order of the file's sections."""
    for status, measure, path in _facts(model):
        if status == "placeholder":
            yield Placeholder(".".join(path), measure, root.key_span(*path))


def _facts(model: CalibrationProfile) -> Iterator[tuple[Status, str, tuple[str, ...]]]:
    """The status of each calibrated fact, how to measure it, and where it stands."""
    for name, frame in model.frames.items():
        yield frame.status, frame.method, ("frames", name)
    for name, station in model.stations.items():
        yield station.status, "drive there and record the base's pose", ("stations", name)
    for arm, carry in model.carry.items():
        yield carry.status, "hold each kind of object there and look", ("carry", arm)
    yield model.base.docking.status, "measure it over repeated drives", ("base", "docking")
    yield model.table.status, model.table.method, ("table",)
    files = (model.map.yaml, model.map.image, model.map.sha256)
    yield "placeholder" if None in files else model.map.status, "build and record a map", ("map",)
    yield model.apriltags.status, "stick the tags on and measure their places", ("apriltags",)
    for name, camera in model.cameras.items():
        yield camera.status, "calibrate its intrinsics", ("cameras", name)
    for name, lidar in model.lidars.items():
        yield lidar.status, "confirm its mount and topics", ("lidars", name)
