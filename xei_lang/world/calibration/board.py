"""The tags of a calibration target, and the pose of it that a sample's tags give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.schema.recording import BoardTagModel, SeenTagModel
from xei_lang.profiles.yaml_tree import Node
from xei_lang.world.perception.detect_tags import CORNERS
from xei_lang.world.perception.joint_pose import joint_pose
from xei_lang.world.perception.optics import Array, Optics, matrix_of


@dataclass(frozen=True, slots=True, eq=False)
class Board:
    """Corners (4, 3) of each tag on the board, by its id, and the camera that looks at them."""

    corners_m: Mapping[int, Array]
    optics: Optics

    @staticmethod
    def of(tags: Sequence[BoardTagModel], optics: Optics) -> Board:
        """The board of a recording."""
        return Board({tag.id: _corners(tag) for tag in tags}, optics)


def see_board(
    tags: Sequence[SeenTagModel], board: Board, index: int, root: Node
) -> tuple[Array, Array, Array] | Diagnostic:
    """`T_optical_board` (4, 4), the corners (n, 3) on the board, and the rays (n, 2) that they were seen
    at.
    """
    ids = [tag.id for tag in tags]
    for place, number in enumerate(ids):
        span = root.span_of("samples", index, "tags", place, "id")
        if number not in board.corners_m:
            known = ", ".join(str(known) for known in sorted(board.corners_m)) or "no tag"
            message = f"tag {number} is not on the board"
            return Diagnostic("XEI0684", message, span, help=(f"`board` has {known}",))
        if ids.count(number) > 1:
            return Diagnostic("XEI0684", f"tag {number} stands twice in sample {index + 1}", span)
    points = np.concatenate([board.corners_m[number] for number in ids])
    pixels = np.array([corner for tag in tags for corner in tag.corners_px], dtype=np.float64)
    pose = joint_pose(points, pixels, board.optics)
    if pose is None:
        span = root.span_of("samples", index, "tags")
        message = f"no pose of the board explains where sample {index + 1} sees its tags"
        return Diagnostic("XEI0684", message, span, help=("corners go clockwise from the top left one",))
    return pose.T_optical_frame, points, board.optics.rays(pixels)


def _corners(tag: BoardTagModel) -> Array:
    x, y, z = tag.position_m
    roll, pitch, yaw = tag.rpy_rad
    T = matrix_of(Pose.from_rpy((x, y, z), (roll, pitch, yaw)))
    flat = tag.size_m * np.hstack([CORNERS, np.zeros((4, 1))])
    return flat @ T[:3, :3].T + T[:3, 3]
