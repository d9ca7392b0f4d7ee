"""The backend `apriltag`: objects with tags on them, and tables, from the pixels of the colour image."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from xei_lang.ir.geometry import IDENTITY, Pose
from xei_lang.profiles.grid import T_frame_object
from xei_lang.profiles.model import Profile
from xei_lang.world.perception.detect_tags import detect_tags
from xei_lang.world.perception.frame_anchor import anchor_frame
from xei_lang.world.perception.image import gray_image
from xei_lang.world.perception.optics import Array, matrix_of
from xei_lang.world.perception.pose_request import Mode
from xei_lang.world.perception.refusal import Refused
from xei_lang.world.perception.registry import RegisteredObject, Registry
from xei_lang.world.perception.service.backend import Estimate, Shot, Unable, rows_of

CONFIDENCE = 0.98
"""Of a pose that several tags agree on: wrong ids and wrong layouts were refused before."""


@dataclass(frozen=True, slots=True)
class AprilTagBackend:
    """Objects whose own frame has tags in the profile, and objects that a tagged frame is named after.

    A table's tags stand in its frame, and the profile places the table's body in that frame. What merely
    stands on a table is not found by the table's tags: where it stands there, nobody has looked.
    """

    profile: Profile
    name: str = "apriltag"
    version: str = "apriltag 1"
    modes: tuple[Mode, ...] = ("register", "track")
    needs_masks: bool = False

    def ready(self, registry: Registry) -> str | None:
        """Whether the profile has any tags."""
        return None if self.profile.calibration.apriltags.tags else "the profile has no AprilTags"

    def put(self, item: RegisteredObject) -> Unable | None:
        """Nothing is to be learnt: tags are found by the layout of the profile."""
        return None

    def estimate(self, shot: Shot) -> tuple[Estimate, ...] | Unable:
        """One look for all tags, then each object by its own."""
        layout = self.profile.calibration.apriltags
        gray = gray_image(shot.image, shot.optics.size_px)
        if isinstance(gray, Refused):
            return tuple(Estimate(query.object_id, "low_quality") for query in shot.request.queries)
        detections = detect_tags(gray, shot.optics, layout.family)
        seen = {tag.id for tag in detections}
        placed = _frames_of(self.profile)
        found: list[Estimate] = []
        for query in shot.request.queries:
            T_tags_object = placed.get(query.object_id)
            own = {tag.id for tag in layout.tags if tag.frame == query.object_id}
            if T_tags_object is None or not own & seen:
                found.append(Estimate(query.object_id, "no_object"))
                continue
            anchor = anchor_frame(detections, layout, query.object_id, shot.optics)
            if isinstance(anchor, Refused):
                found.append(Estimate(query.object_id, "low_quality"))
                continue
            T_output = shot.request.picture.T_output_camera @ anchor.T_camera_frame @ T_tags_object
            covariance = _carried(anchor.covariance, T_tags_object)
            rows = tuple(tuple(float(value) for value in row) for row in covariance)
            found.append(Estimate(query.object_id, "ok", rows_of(T_output), CONFIDENCE, rows))
        return tuple(found)


def _frames_of(profile: Profile) -> Mapping[str, Pose]:
    """For each object that tags can find, its pose in the frame that its tags stand in."""
    frames = {frame.name for frame in profile.calibration.frames}
    placed: dict[str, Pose] = {}
    for name in dict.fromkeys(tag.frame for tag in profile.calibration.apriltags.tags):
        item = profile.object(name)
        prior = None if item is None else T_frame_object(profile, item)
        if name not in frames and item is not None:
            placed[name] = IDENTITY
        elif prior is not None and prior[0] == name:
            placed[name] = prior[1]
    return placed


def _carried(covariance: Array, T_tags_object: Pose) -> Array:
    """The covariance of a small motion of the tags' frame, as one of the object's, in its own axes.

    By the adjoint of the object's pose (Lynch and Park, Modern Robotics, 2017, 3.3.2), translation first.
    """
    T = np.linalg.inv(matrix_of(T_tags_object))
    R, (x, y, z) = T[:3, :3], T[:3, 3]
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    adjoint = np.zeros((6, 6))
    adjoint[:3, :3] = adjoint[3:, 3:] = R
    adjoint[:3, 3:] = cross @ R
    return adjoint @ covariance @ adjoint.T
