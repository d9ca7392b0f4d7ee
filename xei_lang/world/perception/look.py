"""One image, looked at: the tags in it, and each frame of the layout that they fix or fail to fix."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import Frame, World
from xei_lang.profiles.model import Camera, Profile, TagLayout
from xei_lang.world.frames import frame_tree, slide_joint, start_state
from xei_lang.world.perception.cameras import is_carried
from xei_lang.world.perception.detect_tags import TagDetection, detect_tags
from xei_lang.world.perception.frame_anchor import FrameAnchor, anchor_frame
from xei_lang.world.perception.image import gray_image
from xei_lang.world.perception.optics import Optics
from xei_lang.world.perception.refusal import Refused
from xei_lang.world.transforms import Deviation, lookup, verify_transform


@dataclass(frozen=True, slots=True, eq=False)
class Sighting:
    """What one image shows: all tags, and for each frame whose tags are seen its anchor or a refusal."""

    detections: tuple[TagDetection, ...]
    frames: tuple[tuple[str, FrameAnchor | Refused], ...]


@dataclass(frozen=True, slots=True)
class Verified:
    """An anchor beside the profile: `T_base_frame` as found and as expected, and how far they are apart.

    `stated` is the frame as the profile has it, `T_parent_found` what its `T_parent_frame` would be by this.
    `station` is where the base is taken to stand, with the slide at that station's height; it decides what is
    found only where the robot carries the camera (`by_base`).
    """

    station: str
    by_base: bool
    T_base_frame: Pose
    expected_T_base_frame: Pose
    stated: Frame
    T_parent_found: Pose
    deviation: Deviation


def look(image: NDArray[Any], layout: TagLayout, camera: Camera, default_frame: str) -> Sighting | Refused:
    """The tags of an image (see `gray_image`) and the frames that they fix.

    `default_frame` is the frame that is reported as missing where the image has no tag of any frame.
    """
    optics = Optics.of(camera)
    gray = gray_image(image, optics.size_px)
    if isinstance(gray, Refused):
        return gray
    detections = detect_tags(gray, optics, layout.family)
    if not detections and detect_tags(np.ascontiguousarray(gray[:, ::-1]), optics, layout.family):
        return Refused("mirrored", "the image is mirrored: its tags can be read from behind only",
                       "turn the mirroring of the camera's driver off")  # fmt: skip
    frame_of = {tag.id: tag.frame for tag in layout.tags}
    seen = sorted({frame_of[found.id] for found in detections if found.id in frame_of}) or [default_frame]
    anchors = tuple((frame, anchor_frame(detections, layout, frame, optics)) for frame in seen)
    return Sighting(detections, anchors)


def verify(profile: Profile, camera: Camera, anchor: FrameAnchor) -> Verified | None:
    """The anchor beside what the profile says of its frame; None for a frame that no station grounds.

    The base is taken to stand at the station that grounds the frame, and the slide at its height.
    """
    calibration = profile.calibration
    station = next((one for one in calibration.stations if one.ground_frame == anchor.frame), None)
    if station is None:
        return None
    moved = slide_joint(profile)
    start = start_state(profile)
    joints = tuple((name, station.slide_m if name == moved else value) for name, value in start.joints)
    state = replace(start, joints=joints, station=station.name, T_world_base=station.T_world_base)
    world = World(frame_tree(profile, state), (), state)
    stated = world.frame(anchor.frame)
    if stated is None:
        return None
    T_base_found = lookup(world, "robot_base", camera.frame).T_target_source @ anchor.T_camera_frame
    T_parent_found = lookup(world, stated.parent, "robot_base").T_target_source @ T_base_found
    expected = lookup(world, "robot_base", anchor.frame).T_target_source
    return Verified(
        station.name,
        is_carried(profile, camera),
        T_base_found,
        expected,
        stated,
        T_parent_found,
        verify_transform(stated, T_parent_found),
    )
