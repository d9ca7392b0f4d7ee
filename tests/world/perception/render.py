"""Images of tags whose poses are known: each pixel is an average over rays through it.

The tag's own bitmap is looked up where a ray meets its plane, so nothing of the detector, and no pixel of a
warp, has a part in the truth. Blur is a Gaussian point spread, noise that of a sensor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from xei_lang.profiles.model import Tag
from xei_lang.world.perception.optics import Optics, matrix_of

SUPER = 6
MODULES = {"tag16h5": 6, "tag25h9": 7, "tag36h11": 8}
_DICTIONARIES = {
    "tag16h5": cv2.aruco.DICT_APRILTAG_16h5,
    "tag25h9": cv2.aruco.DICT_APRILTAG_25h9,
    "tag36h11": cv2.aruco.DICT_APRILTAG_36h11,
}


@dataclass(frozen=True)
class Sensor:
    """What a camera adds: point spread (px), noise (grey values), paper and ink (grey values)."""

    blur_px: float = 0.7
    noise: float = 3.0
    paper: float = 210.0
    ink: float = 35.0
    background: float = 120.0


def bitmap(family: str, number: int) -> np.ndarray:
    """The modules of a tag with its white margin, 1 is white, upright as AprilTag publishes it."""
    dictionary = cv2.aruco.getPredefinedDictionary(_DICTIONARIES[family])
    width = MODULES[family]
    drawn = cv2.aruco.generateImageMarker(dictionary, number, 10 * width)[5::10, 5::10] > 0
    return np.pad(np.rot90(drawn, 2), 1, constant_values=True).astype(np.float64)


def render(
    tags: Sequence[Tag],
    T_optical_frame: np.ndarray,
    optics: Optics,
    *,
    seed: int = 0,
    sensor: Sensor | None = None,
    family: str = "tag36h11",
) -> np.ndarray:
    """Grey image (h, w) of tags that all stand in one frame, seen from `T_optical_frame` (4, 4)."""
    sensor = sensor or Sensor()
    random = np.random.default_rng(seed)
    width, height = optics.size_px
    v, u = np.mgrid[0:height, 0:width]
    shade = 1.0 + 0.1 * np.sin(u / 310.0 + random.uniform(0, 6)) * np.cos(v / 230.0)
    image = sensor.background * shade
    for tag in tags:
        _draw(image, shade, tag, T_optical_frame, optics, sensor, family)
    if sensor.blur_px > 0:
        image = cv2.GaussianBlur(image, (0, 0), sensor.blur_px)
    return np.clip(np.rint(image + random.normal(0.0, sensor.noise, image.shape)), 0, 255).astype(np.uint8)


def _draw(image, shade, tag, T_optical_frame, optics, sensor, family) -> None:
    T = T_optical_frame @ matrix_of(tag.T_frame_tag)
    modules = MODULES[family]
    half = 0.5 * tag.size_m * (modules + 2) / modules
    corners = np.array([[x, y, 0.0] for x in (-half, half) for y in (-half, half)]) @ T[:3, :3].T + T[:3, 3]
    if (corners[:, 2] <= 0.05).any():
        return
    pixels, _ = optics.project(corners)
    height, width = image.shape
    low = np.maximum(np.floor(pixels.min(axis=0)).astype(int) - 3, 0)
    high = np.minimum(np.ceil(pixels.max(axis=0)).astype(int) + 4, (width, height))
    if (low >= high).any():
        return
    # Sub-pixels at the centres of a SUPER x SUPER grid of each pixel; a pixel's centre has whole coordinates.
    inside = (np.arange(SUPER) + 0.5) / SUPER - 0.5
    us = (np.arange(low[0], high[0])[:, None] + inside).reshape(-1)
    vs = (np.arange(low[1], high[1])[:, None] + inside).reshape(-1)
    grid = np.stack(np.meshgrid(us, vs), axis=-1)
    rays = np.concatenate([optics.rays(grid.reshape(-1, 2)), np.ones((us.size * vs.size, 1))], axis=1)
    # The ray meets the tag's plane where its z is zero.
    inverse = np.linalg.inv(T)
    direction = rays @ inverse[:3, :3].T
    origin = inverse[:3, 3]
    meet = origin + direction * (-origin[2] / direction[:, 2])[:, None]
    scale = modules / tag.size_m
    column = np.floor(meet[:, 0] * scale + modules / 2 + 1).astype(int)
    row = np.floor(modules / 2 + 1 - meet[:, 1] * scale).astype(int)
    code = bitmap(family, tag.id)
    on = (column >= 0) & (column < code.shape[1]) & (row >= 0) & (row < code.shape[0])
    value = np.where(code[np.clip(row, 0, code.shape[0] - 1), np.clip(column, 0, code.shape[1] - 1)] > 0,
                     sensor.paper, sensor.ink)  # fmt: skip
    shape = (vs.size // SUPER, SUPER, us.size // SUPER, SUPER)
    cover = on.reshape(shape).mean(axis=(1, 3))
    tint = np.where(on, value, 0.0).reshape(shape).mean(axis=(1, 3))
    part = (slice(low[1], high[1]), slice(low[0], high[0]))
    image[part] = image[part] * (1.0 - cover) + tint * shade[part]
