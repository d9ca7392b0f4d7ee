"""What stands on a table, cut out of a depth image: the table's plane is known, so nothing is fitted.

Pixels whose point lies above the table's top belong to things; those that touch, and are about as far away,
belong to one thing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Array, Optics, matrix_of

Bounds = tuple[Vec3, Vec3]
Mask = NDArray[np.bool_]

MIN_PIXELS = 60
JUMP_M = 0.02
"""Neighbouring pixels whose depths differ by more belong to different things, one behind the other."""


@dataclass(frozen=True, slots=True, eq=False)
class Proposal:
    """A thing on the table: its `mask` (h, w), and the box around its seen points in the table's frame, m.

    Only its side towards the camera is seen, so the box may be smaller than the thing. `is_cut` where it
    goes on past the edge of the picture.
    """

    mask: Mask
    lower_m: Array
    upper_m: Array
    is_cut: bool


def table_points(depth_m: Array, optics: Optics, T_table_camera: Pose) -> Array:
    """The points (h, w, 3) of a depth image in the table's frame, m; NaN where the depth is."""
    height, width = depth_m.shape
    v, u = np.mgrid[0:height, 0:width]
    rays = optics.rays(np.stack([u, v], axis=-1).reshape(-1, 2).astype(np.float64)).reshape(height, width, 2)
    points = np.concatenate([rays, np.ones((height, width, 1))], axis=2) * depth_m[..., None]
    T = matrix_of(T_table_camera @ T_CAMERA_OPTICAL)
    return points @ T[:3, :3].T + T[:3, 3]


def propose(depth_m: Array, points_m: Array, bounds_m: Bounds, clearance_m: float) -> tuple[Proposal, ...]:
    """Masks of what stands more than `clearance_m` above the table within its bounds, the largest first."""
    lower, upper = np.array(bounds_m[0]), np.array(bounds_m[1])
    lower[2] += clearance_m
    with np.errstate(invalid="ignore"):
        above: Mask = np.all((points_m >= lower) & (points_m <= upper), axis=2)
    inner = (above & ~_jumps(depth_m)).astype(np.uint8)
    count, labels = cv2.connectedComponents(inner, connectivity=4)
    labels = _grown(np.asarray(labels, dtype=np.int32), above)
    sizes = np.bincount(labels.reshape(-1), minlength=count)
    found: list[Proposal] = []
    for number in range(1, count):
        if sizes[number] < MIN_PIXELS:
            continue
        mask = labels == number
        seen = points_m[mask]
        cut = bool(mask[0].any() or mask[-1].any() or mask[:, 0].any() or mask[:, -1].any())
        # Noise of single pixels does not widen a box.
        low, high = np.percentile(seen, (0.5, 99.5), axis=0)
        found.append(Proposal(mask, low, high, cut))
    return tuple(sorted(found, key=lambda one: -int(one.mask.sum())))


def assign(
    proposals: Sequence[Proposal], sizes_m: Sequence[Vec3], slack_m: float = 0.012
) -> tuple[Proposal | None, ...]:
    """For each object, by the size of its bounding box, the one proposal that can be it; else None.

    Two proposals that can be the same object, or two objects that can be the same proposal, are not told
    apart by their size, so none of them is assigned.
    """
    fits = np.array([[_fits(one, size, slack_m) for one in proposals] for size in sizes_m], dtype=np.bool_)
    fits = fits.reshape(len(sizes_m), len(proposals))
    chosen: list[Proposal | None] = []
    for row in fits:
        columns = np.flatnonzero(row)
        is_sure = len(columns) == 1 and fits[:, columns[0]].sum() == 1
        chosen.append(proposals[int(columns[0])] if is_sure else None)
    return tuple(chosen)


def _fits(one: Proposal, size_m: Vec3, slack_m: float) -> bool:
    """Whether a thing of this size, upright and turned about the vertical, can have given this box.

    Its height is seen whole, for it stands on the table. Of its plan at least what faces the camera is seen:
    no more than its diagonal, and no less than its narrower side.
    """
    if one.is_cut or abs(float(one.upper_m[2]) - size_m[2]) > slack_m:
        return False
    wide = float(max(one.upper_m[0] - one.lower_m[0], one.upper_m[1] - one.lower_m[1]))
    diagonal = float(np.hypot(size_m[0], size_m[1]))
    return min(size_m[:2]) - slack_m <= wide <= diagonal + slack_m


def _jumps(depth_m: Array) -> Mask:
    """Pixels at which the depth leaps to that of a neighbour to the right or below."""
    jumps = np.zeros(depth_m.shape, dtype=np.bool_)
    with np.errstate(invalid="ignore"):
        jumps[:, :-1] |= np.abs(np.diff(depth_m, axis=1)) > JUMP_M
        jumps[:-1] |= np.abs(np.diff(depth_m, axis=0)) > JUMP_M
    return jumps


def _grown(labels: NDArray[np.int32], above: Mask) -> NDArray[np.int32]:
    """Labels with the pixels at jumps given back to a neighbour that is labelled."""
    widest = cv2.dilate(labels.astype(np.float32), np.ones((3, 3), np.uint8)).astype(np.int32)
    return np.where((labels == 0) & above, widest, labels)
