"""Images of the bench, as files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from tests.world.perception.render import render
from tests.world.perception.views import bench, camera, optics
from xei_lang.ir.geometry import Pose
from xei_lang.world.perception.frame_anchor import FrameAnchor
from xei_lang.world.perception.look import verify
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, matrix_of


def image_of_the_table(path: Path, moved: Pose | None = None, scale: float = 1.0) -> Path:
    """What the head camera sees at bench_a, with the table somewhat away from where the profile has it."""
    nominal = verify(bench(), camera(), FrameAnchor("table", Pose(), (), (), 0.0, np.eye(6), 1.0))
    assert nominal is not None
    T_camera_table = nominal.T_base_frame.inverse() @ nominal.expected_T_base_frame
    T = T_CAMERA_OPTICAL.inverse() @ T_camera_table @ (moved or Pose())
    tags = [tag for tag in bench().calibration.apriltags.tags if tag.frame == "table"]
    tags = [replace(tag, size_m=scale * tag.size_m) for tag in tags]
    cv2.imwrite(str(path), render(tags, matrix_of(T), optics(), seed=1))
    return path
