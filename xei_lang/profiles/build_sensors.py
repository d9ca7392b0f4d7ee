"""Tags, cameras and lidars of a deployment, from the validated model."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.profiles.build_objects import pose
from xei_lang.profiles.model import Camera, Lidar, Tag, TagLayout
from xei_lang.profiles.schema.calibration import CalibrationProfile
from xei_lang.profiles.yaml_tree import Node


def build_tags(model: CalibrationProfile, root: Node) -> TagLayout:
    """The AprilTags of the deployment."""
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


def build_cameras(model: CalibrationProfile, root: Node) -> Iterator[Camera]:
    """The cameras, each with the place of its key."""
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


def build_lidars(model: CalibrationProfile, root: Node) -> Iterator[Lidar]:
    """The lidars, each with the place of its key."""
    for name, one in model.lidars.items():
        yield Lidar(name, one.frame, one.status, tuple(one.topics.items()), root.key_span("lidars", name))
