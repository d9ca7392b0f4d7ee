"""Whether a pose that a service gives is to be believed: by the picture, not by the service's own confidence.

Scores of pose estimators rank their hypotheses; they are no probabilities (Wen et al., FoundationPose, CVPR
2024, rank by a network). What can be computed is whether the depth image bears a pose out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose, Primitive, Vec3
from xei_lang.world.perception.optics import Array, Optics, matrix_of
from xei_lang.world.perception.outline import SIDES, outline_sides
from xei_lang.world.perception.pose_request import ObjectPose, Picture
from xei_lang.world.perception.service_fault import PoseRefused, RefusalReason
from xei_lang.world.perception.silhouette import Silhouette, half_size, silhouette
from xei_lang.world.sources.rigid import pose_of_matrix

Bounds = tuple[Vec3, Vec3]
Mask = NDArray[np.bool_]
_ELSEWHERE = "look from somewhere else, or move what stands before it"


@dataclass(frozen=True, slots=True)
class Criteria:
    """What a pose must meet.

    `residual_m` is how far a measured depth may be from the expected one to count as the object's; at least
    `agreeing` of the pixels at which something else does not stand before it must, and `side_agreeing` of
    those on each side of its outline, `outline_m` wide. `visible` of its silhouette and `pixels` pixels must
    be free of other things and measured, and so must `sides` sides. `overlap` is the least intersection over
    union with a mask.
    """

    residual_m: float = 0.008
    agreeing: float = 0.7
    outline_m: float = 0.01
    side_agreeing: float = 0.5
    sides: int = 3
    visible: float = 0.1
    pixels: int = 40
    overlap: float = 0.5
    age_ns: int = 2_000_000_000
    ahead_ns: int = 50_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """What is known beside the answer: the depth (h, w) in m, NaN where unknown, and a mask if there is one.

    `workspace_m` bounds where the robot works, in the frame that `T_workspace_output` leads to.
    """

    picture: Picture
    optics: Optics
    depth_m: Array
    mask: NDArray[np.bool_] | None
    workspace_m: Bounds
    T_workspace_output: Pose


@dataclass(frozen=True, slots=True)
class Accepted:
    """A pose that is believed: in the output frame, with the numbers that speak for it.

    `agreeing` is the share of pixels whose depth fits, `residual_m` the median of how far these are off,
    `overlap` that with the mask, or None without one.
    """

    name: str
    T_output_object: Pose
    agreeing: float
    residual_m: float
    overlap: float | None


def stale(stamp_ns: int, now_ns: int, criteria: Criteria) -> tuple[RefusalReason, str] | None:
    """The reason and the words where a picture of this time is not to be used any more, or not yet."""
    age = now_ns - stamp_ns
    if age > criteria.age_ns:
        return (
            "stale",
            f"is for a picture of {age / 1e9:.1f} s ago, and {criteria.age_ns / 1e9:g} s are allowed",
        )
    if age < -criteria.ahead_ns:
        return "from_the_future", f"is for a picture of {-age / 1e9:.1f} s ahead of this machine's clock"
    return None


def accept(
    item: ObjectPose, shape: Sequence[Primitive], evidence: Evidence, criteria: Criteria
) -> Accepted | PoseRefused:
    """The pose of one object held against the picture; `shape` is what the profile says the object is."""
    if item.status != "ok" or item.T_output_object is None:
        return _not_found(item)
    if item.frame_id != evidence.picture.output_frame:
        said = f"is in `{item.frame_id[:60]}`, and was asked for in `{evidence.picture.output_frame}`"
        return _refused(item, "other_frame", said, "mend the service: it does not keep to the contract")
    pose = pose_of_matrix(item.T_output_object)
    if isinstance(pose, str):
        return _refused(item, "not_rigid", f"is no pose: {pose}",
                        "mend the service: a pose is a rotation and metres, 4 x 4 by rows")  # fmt: skip
    if not _reaches(shape, evidence.T_workspace_output @ pose, evidence.workspace_m):
        return _refused(item, "outside_workspace", f"lies outside of the workspace, at {_text(pose)}",
                        "look whether the camera stands right; if so, bring the object nearer")  # fmt: skip
    T_camera_object = evidence.picture.T_output_camera.inverse() @ pose
    seen = silhouette(shape, T_camera_object, evidence.optics)
    if seen is None:
        return _refused(item, "out_of_view", "puts it where the camera does not see",
                        "turn the camera to it, or let another source place it")  # fmt: skip
    return _borne_out(item, pose, seen, evidence, criteria)


def _borne_out(
    item: ObjectPose, pose: Pose, seen: Silhouette, evidence: Evidence, criteria: Criteria
) -> Accepted | PoseRefused:
    rows, columns = seen.pixels.T
    behind = evidence.depth_m[rows, columns] - seen.depths_m
    measured = np.isfinite(behind)
    free = measured & (behind > -criteria.residual_m)
    fits = free & (behind < criteria.residual_m)
    each = seen.step**2
    if free.sum() * each < criteria.pixels or free.sum() < criteria.visible * len(free):
        shown = f"{int(free.sum()) * each} of {len(free) * each} pixels"
        words = f"cannot be held against the picture, which shows {shown} of it"
        return _refused(item, "hidden", words, _ELSEWHERE)
    agreeing = float(fits.sum() / free.sum())
    if agreeing < criteria.agreeing:
        off = float(np.median(np.abs(behind[free])))
        words = (
            f"does not fit the depth image: {100 * agreeing:.0f} % of its surface is measured where it would "
            f"be, and {100 * criteria.agreeing:.0f} % are needed; half of it is off by {1e3 * off:.0f} mm or "
            "more"
        )
        return _refused(item, "depth_residual", words, "look at the picture: something else may stand there")
    doubt = _side_doubt(seen, free, fits, evidence, criteria)
    if doubt is not None:
        return _refused(item, *doubt)
    overlap = None if evidence.mask is None else _overlap(seen, free, evidence.mask)
    if overlap is not None and overlap < criteria.overlap:
        words = f"covers its mask by {100 * overlap:.0f} %, and {100 * criteria.overlap:.0f} % are needed"
        return _refused(item, "mask_overlap", words, "look at the mask: it may be of something else")
    return Accepted(item.name, pose, agreeing, float(np.median(np.abs(behind[fits]))), overlap)


def _side_doubt(
    seen: Silhouette, free: Mask, fits: Mask, evidence: Evidence, criteria: Criteria
) -> tuple[RefusalReason, str, str] | None:
    """What speaks against a pose on one side of its outline, or that too few sides can be seen."""
    width_px = criteria.outline_m * float(evidence.optics.matrix[0, 0]) / float(np.median(seen.depths_m))
    height, width = evidence.depth_m.shape
    sides = outline_sides(seen, width_px, (height, width))
    shares: list[float] = []
    for side in range(SIDES):
        on = sides == side
        open_ = int((on & free).sum())
        if open_ * seen.step**2 >= criteria.pixels / SIDES and open_ >= 0.5 * int(on.sum()):
            shares.append(float((on & fits).sum()) / open_)
    if len(shares) < criteria.sides:
        words = f"cannot be held against the picture, which shows {len(shares)} of {SIDES} sides of it"
        return "hidden", words, _ELSEWHERE
    if min(shares) < criteria.side_agreeing:
        words = (
            f"reaches past what the depth image shows: {100 * min(shares):.0f} % of one side of its outline "
            f"is measured where it would be, and {100 * criteria.side_agreeing:.0f} % are needed"
        )
        return "depth_residual", words, "look at the picture: it may stand a little beside that"
    return None


def _overlap(seen: Silhouette, free: NDArray[np.bool_], mask: NDArray[np.bool_]) -> float:
    """Intersection over union of a mask and of what of the silhouette is free to be seen, on its grid."""
    rows, columns = seen.pixels[free].T
    drawn = np.zeros(mask.shape, dtype=np.bool_)
    drawn[rows, columns] = True
    each = seen.step**2
    both = float((drawn & mask).sum()) * each
    either = float(drawn.sum()) * each + float(mask.sum()) - both
    return both / either if either > 0 else 0.0


def _reaches(shape: Sequence[Primitive], T_workspace_object: Pose, workspace_m: Bounds) -> bool:
    """Whether the box around the object, along the workspace's axes, has a part within its bounds."""
    T = matrix_of(T_workspace_object)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for part in shape:
        placed = T @ matrix_of(part.T_object_shape)
        extent = np.abs(placed[:3, :3]) @ half_size(part)
        low, high = np.minimum(low, placed[:3, 3] - extent), np.maximum(high, placed[:3, 3] + extent)
    return bool((high >= workspace_m[0]).all() and (low <= workspace_m[1]).all())


def _not_found(item: ObjectPose) -> PoseRefused:
    if item.status == "low_quality":
        return _refused(item, "low_quality", "is called uncertain by the service", "look from nearer by")
    if item.status == "no_object":
        return _refused(item, "no_object", "was not found", "look whether the camera sees it")
    return _refused(item, "service_error", "could not be computed", "look at what the service says itself")


def _refused(item: ObjectPose, reason: RefusalReason, words: str, help_: str) -> PoseRefused:
    return PoseRefused(item.name, reason, f"the pose of `{item.name}` {words}", help_)


def _text(pose: Pose) -> str:
    return ", ".join(f"{value:.3f}" for value in pose.position_m) + " m"
