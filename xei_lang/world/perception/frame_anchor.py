"""Where a frame of the profile stands before a camera: all its tags together, or a reason why not.

An image is refused rather than used where the pixels contradict the layout. Whoever anchors a table by it
moves a robot by it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Tag, TagLayout
from xei_lang.world.perception.detect_tags import CORNERS, TagDetection
from xei_lang.world.perception.joint_pose import JointPose, joint_pose, size_ratio
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Array, Optics, matrix_of, pose_of
from xei_lang.world.perception.refusal import Refused

DOUBT_PX = 0.1
"""Error of a corner's coordinate that is reckoned with where a wrong tilt would fit nearly as well as the
right one (Schweighofer and Pinz, PAMI 28(12), 2006): light and print move corners that agree with each other.
"""
MIN_EVIDENCE = 25.0
"""How much larger the second solution's sum of squares must be, in variances of `DOUBT_PX`: five sigma."""
MAX_TILT_STD_RAD = float(np.radians(1.0))
"""A frame whose tilt is known worse than this, at `DOUBT_PX`, is not anchored."""
SIZE_SLACK = 0.02
"""A tag's size may be off by this, or by three of its standard deviations, before it is called wrong."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameAnchor:
    """A frame found by its tags: `T_camera_frame` in the camera's body frame (x forward, z up).

    `covariance` (6, 6) is that of a small motion in the frame's own axes, translation (m) before rotation
    (rad); `tag_rms_px` has one entry for each of `tag_ids`. `size_ratio` is how large the tags look against
    their stated size, 1.0 where one tag cannot say it.
    """

    frame: str
    T_camera_frame: Pose
    tag_ids: tuple[int, ...]
    tag_rms_px: tuple[float, ...]
    rms_px: float
    covariance: Array
    size_ratio: float

    @property
    def position_std_m(self) -> float:
        """Standard deviation of the origin's position along its least certain direction."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[:3, :3])[-1]))

    @property
    def rotation_std_rad(self) -> float:
        """Standard deviation of the rotation about its least certain axis."""
        return float(np.sqrt(np.linalg.eigvalsh(self.covariance[3:, 3:])[-1]))


def anchor_frame(
    detections: Sequence[TagDetection], layout: TagLayout, frame: str, optics: Optics
) -> FrameAnchor | Refused:
    """The pose of `frame` from the tags that the layout has in it.

    Tags of other frames, and ids that the layout does not have, are left aside; where nothing else is seen,
    they are the reason of the refusal.
    """
    known = {tag.id: tag for tag in layout.tags if tag.frame == frame}
    own = [found for found in detections if found.id in known]
    refused = _unusable(detections, own, layout, frame)
    if refused is not None:
        return refused
    tags = [known[found.id] for found in own]
    points, centres = _points(tags)
    pixels = np.concatenate([found.corners_px for found in own])
    pose = joint_pose(points, pixels, optics)
    if pose is None:
        ids = tuple(tag.id for tag in tags)
        return Refused("residual", f"no pose of `{frame}` explains where its tags are seen", _LAYOUT, ids)
    ratio, deviation = size_ratio(pose, centres, points, pixels, optics)
    doubt = _doubt(pose, tags, ratio, deviation, layout, frame)
    if doubt is not None:
        return doubt
    per_tag = np.sqrt((pose.errors_px**2).sum(axis=1).reshape(-1, 4).mean(axis=1))
    return FrameAnchor(
        frame=frame,
        T_camera_frame=T_CAMERA_OPTICAL @ pose_of(pose.T_optical_frame),
        tag_ids=tuple(tag.id for tag in tags),
        tag_rms_px=tuple(float(value) for value in per_tag),
        rms_px=pose.rms_px,
        covariance=pose.covariance,
        size_ratio=ratio,
    )


_LAYOUT = "measure the tags' places and sizes again, and write them under `apriltags`"


def _points(tags: Sequence[Tag]) -> tuple[Array, Array]:
    """Corners (4n, 3) of tags in their frame, in the order of `CORNERS`, and for each its tag's centre."""
    corners = np.hstack([CORNERS, np.zeros((4, 1))])
    points: list[Array] = []
    for tag in tags:
        T = matrix_of(tag.T_frame_tag)
        points.append(tag.size_m * corners @ T[:3, :3].T + T[:3, 3])
    centres = np.repeat([tag.T_frame_tag.position_m for tag in tags], 4, axis=0)
    return np.concatenate(points), np.asarray(centres, dtype=np.float64)


def _unusable(
    detections: Sequence[TagDetection], own: Sequence[TagDetection], layout: TagLayout, frame: str
) -> Refused | None:
    ids = [found.id for found in own]
    wanted = ", ".join(str(tag.id) for tag in layout.tags if tag.frame == frame)
    if not detections:
        return Refused("no_tags", f"no tag of {layout.family} is seen", f"show the camera tags {wanted}")
    if not own:
        seen = tuple(sorted({found.id for found in detections}))
        shown = ", ".join(str(number) for number in seen)
        message = f"the tags that are seen ({shown}) are none of `{frame}`"
        return Refused("unknown_tags", message, f"`{frame}` has the tags {wanted}", seen)
    twice = tuple(sorted({number for number in ids if ids.count(number) > 1}))
    if twice:
        message = f"tag {twice[0]} is seen in two places"
        return Refused("duplicate_tags", message, "cover the tag that is not part of the layout", twice)
    if len(own) < layout.minimum_tags:
        message = f"{len(own)} of the tags of `{frame}` is seen, and {layout.minimum_tags} are needed"
        help_ = f"clear the view of the tags {wanted}"
        return Refused("too_few_tags", message.replace(" is seen", " are seen") if len(own) > 1 else message,
                       help_, tuple(ids))  # fmt: skip
    return None


def _doubt(
    pose: JointPose, tags: Sequence[Tag], ratio: float, deviation: float, layout: TagLayout, frame: str
) -> Refused | None:
    ids = tuple(tag.id for tag in tags)
    if abs(ratio - 1.0) > max(SIZE_SLACK, 3.0 * deviation):
        stated = 1e3 * tags[0].size_m
        message = (
            f"the tags of `{frame}` look {100 * ratio:.1f} % as large as the profile says, as {stated:g} mm "
            f"is {stated * ratio:.1f} mm"
        )
        return Refused(
            "wrong_tag_size", message, "measure the black square's edge and write it as `size`", ids
        )
    if pose.rms_px > layout.residual_px:
        errors = np.sqrt((pose.errors_px**2).sum(axis=1).reshape(-1, 4).mean(axis=1))
        worst = ids[int(errors.argmax())]
        message = (
            f"the corners of the tags of `{frame}` are {pose.rms_px:.2f} px from any one pose, and "
            f"{layout.residual_px:g} px are allowed; tag {worst} is the worst, {errors.max():.2f} px off"
        )
        return Refused("residual", message, _LAYOUT, ids)
    noise = max(pose.noise_px, DOUBT_PX)
    evidence = len(pose.errors_px) * (pose.other_rms_px**2 - pose.rms_px**2) / noise**2
    if evidence < MIN_EVIDENCE:
        message = (
            f"two poses of `{frame}` explain its tags about as well ({pose.rms_px:.2f} and "
            f"{pose.other_rms_px:.2f} px)"
        )
        return Refused("ambiguous", message, _MORE, ids)
    tilt = noise / pose.noise_px * float(np.sqrt(np.linalg.eigvalsh(pose.covariance[3:, 3:])[-1]))
    if tilt > MAX_TILT_STD_RAD:
        message = f"the tags of `{frame}` say its tilt to {np.degrees(tilt):.1f} deg only"
        return Refused("ambiguous", message, _MORE, ids)
    return None


_MORE = "show more of its tags, further apart, or look at them from nearer by"
