"""Recordings on the bench whose answer is known: the left hand holds a board before the head camera.

Joint positions are random; the camera is pretended to see the board wherever that puts it, also behind other
things, because it is the algebra that is tested and not the light.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.world.perception.views import bench, camera
from xei_lang.ir.geometry import Pose
from xei_lang.world.calibration.carriers import carried, joints_between
from xei_lang.world.perception.detect_tags import CORNERS
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics, matrix_of

CAMERA_TRUTH = Pose.from_rpy((0.0642, -0.0031, 0.7968), (0.004, 0.71, -0.012))
"""Where the head camera really is, in the frame `slide`."""
T_TOOL_BOARD = Pose.from_rpy((0.01, 0.03, 0.06), (0.2, -2.9, 0.4))
BOARD = [
    {
        "id": 100 + k,
        "size_m": 0.04,
        "position_m": [0.06 * (k % 2), 0.06 * (k // 2), 0.0],
        "rpy_rad": [0.0] * 3,
    }
    for k in range(4)
]


def recorded(seed: int, count: int, *, form: str = "tags", noise_px: float = 0.0) -> dict[str, Any]:
    """A recording as a document, with samples in which the board lies before the camera."""
    profile, random = bench(), np.random.default_rng(seed)
    slide, tool = carried(profile, "slide"), carried(profile, "left_tool")
    assert slide is not None
    assert tool is not None
    moving = joints_between(profile.robot, slide.link, tool.link)
    samples: list[dict[str, Any]] = []
    while len(samples) < count:
        joints = {joint.name: round(float(random.uniform(joint.lower, joint.upper)), 6) for joint in moving}
        joints["slide_joint"] = 0.15
        T_slide_tool = slide.T_base_frame(profile.robot, joints).inverse() @ tool.T_base_frame(
            profile.robot, joints
        )
        T_optical_board = (CAMERA_TRUTH @ T_CAMERA_OPTICAL).inverse() @ T_slide_tool @ T_TOOL_BOARD
        seen = seen_by(T_optical_board, random, noise_px)
        if seen is None:
            continue
        if form == "tags":
            samples.append({"joints": joints, "tags": seen})
        else:
            pose = {
                "position_m": list(T_optical_board.position_m),
                "quaternion_xyzw": list(T_optical_board.quaternion),
            }
            samples.append({"joints": joints, "pose": pose})
    document = {"version": 1, "recorded_on": "2026-11-20", "camera": "head", "target": "left_tool"}
    return {**document, **({"board": BOARD} if form == "tags" else {}), "samples": samples}


def seen_by(
    T_optical_board: Pose, random: np.random.Generator, noise_px: float
) -> list[dict[str, Any]] | None:
    """The board's tags in the image, or None where it is not before the camera and turned towards it."""
    T, lens = matrix_of(T_optical_board), Optics.of(camera())
    tags: list[dict[str, Any]] = []
    for tag in BOARD:
        flat = tag["size_m"] * np.hstack([CORNERS, np.zeros((4, 1))]) + np.array(tag["position_m"])
        points = flat @ T[:3, :3].T + T[:3, 3]
        if points[:, 2].min() < 0.2 or T[2, 2] > -0.5:
            return None
        pixels, _ = lens.project(points)
        if (pixels < 0).any() or (pixels > lens.size_px).any():
            return None
        noisy = pixels + random.normal(0.0, noise_px, (4, 2)) if noise_px else pixels
        tags.append({"id": tag["id"], "corners_px": noisy.tolist()})
    return tags
