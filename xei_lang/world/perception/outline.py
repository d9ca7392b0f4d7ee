"""The outline of a silhouette, side by side: what tells a pose from one that has slid along its own surface.

A flat top that is shifted in its plane still lies on itself, but for the side that it was shifted to: there
the camera sees past the object. So each side of the outline must be borne out, not only most of the surface.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.world.perception.silhouette import Silhouette

SIDES = 8
Mask = NDArray[np.bool_]


def outline_sides(seen: Silhouette, width_px: float, shape: tuple[int, int]) -> NDArray[np.intp]:
    """For each pixel of a silhouette the side of its outline, 0 to 7, or -1 further than `width_px` inside.

    Where the picture (height, width) ends is no outline. Sides are directions from the middle of the
    silhouette, as it is when it is stretched to be as wide as high.
    """
    step = seen.step
    rows, columns = seen.pixels.T
    origin = seen.pixels.min(axis=0)
    cells = (seen.pixels - origin) // step
    drawn = np.zeros(cells.max(axis=0) + 1, dtype=np.bool_)
    drawn[cells[:, 0], cells[:, 1]] = True
    at_edge = (
        bool(rows.min() < step), bool(rows.max() + step >= shape[0]),
        bool(columns.min() < step), bool(columns.max() + step >= shape[1]),
    )  # fmt: skip
    inner = drawn
    for _ in range(max(1, round(width_px / step))):
        inner = _eroded(inner, at_edge)
    band = ~inner[cells[:, 0], cells[:, 1]]
    return np.where(band, _directions(seen.pixels), -1)


def _eroded(mask: Mask, at_edge: tuple[bool, bool, bool, bool]) -> Mask:
    """The mask without its outermost cells; beyond an edge that is the picture's, it is taken to go on."""
    top, bottom, left, right = at_edge
    padded = np.pad(mask, 1)
    padded[0, 1:-1] = mask[0] & top
    padded[-1, 1:-1] = mask[-1] & bottom
    padded[1:-1, 0] = mask[:, 0] & left
    padded[1:-1, -1] = mask[:, -1] & right
    return mask & padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]


def _directions(pixels: NDArray[np.intp]) -> NDArray[np.intp]:
    away = pixels - pixels.mean(axis=0)
    spread = np.cov(away.T) + 1e-9 * np.eye(2)
    # In the coordinates of the spread's own axes, each made as long as the other.
    values, axes = np.linalg.eigh(spread)
    round_ = (away @ axes) / np.sqrt(np.maximum(values, 1e-9))
    angles = np.arctan2(round_[:, 0], round_[:, 1]) + np.pi
    return np.minimum((angles * (SIDES / (2.0 * np.pi))).astype(np.intp), SIDES - 1)
