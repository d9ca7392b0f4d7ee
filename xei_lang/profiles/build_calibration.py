"""The calibration profile, from the validated model to dataclasses; each section has a module of its own."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.build_frames import build_frames
from xei_lang.profiles.build_limits import build_limits
from xei_lang.profiles.build_objects import pose, vec3
from xei_lang.profiles.build_placeholders import build_placeholders
from xei_lang.profiles.build_sensors import build_cameras, build_lidars, build_tags
from xei_lang.profiles.model import Calibration, CarryPose, MapFiles, RobotDescription, SceneOrigin
from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.yaml_tree import Node


def build_calibration(
    model: CalibrationProfile, robot: RobotDescription, root: Node, found: list[Diagnostic]
) -> Calibration:
    """The calibration of a deployment; what does not fit the robot is said in `found`."""
    docking = model.base.docking
    return Calibration(
        frames=tuple(build_frames(model, root)),
        limits=tuple(build_limits(model, robot, root, found)),
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
        placeholders=tuple(build_placeholders(model, root)),
        robot_frames=tuple(model.robot_frames.items()),
        carry=tuple(_carry(model, root)),
        apriltags=build_tags(model, root),
        cameras=tuple(build_cameras(model, root)),
        lidars=tuple(build_lidars(model, root)),
        map=_map(model, root),
        docking_tolerance_as=docking.kind,
        max_age_s=model.max_age.si if model.max_age else None,
        payload_span=root.span_of("payload"),
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
