"""Corners of tags to a few hundredths of a pixel: where the lines through the edges of the black square meet.

Each edge is crossed by many short profiles. A profile's step is placed by its area (moment-preserving edge
location: Tabatabai and Mitchell, IEEE PAMI 6(2), 1984, for the first moment only), which a symmetric blur
leaves alone; the lines are fitted in undistorted coordinates, where an edge is straight.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from xei_lang.world.perception.image import Gray
from xei_lang.world.perception.optics import Array, Optics

_PROFILES = 24
_INSET = 0.1
"""Share of an edge left out at each of its ends, where the blur of the corner rounds it."""
_STEPS = 17
_MAX_REACH_PX = 3.0
_ROUNDS = 3
_MIN_STEP = 10.0
"""Grey values between paper and black below which an edge is not trusted."""


def refine_corners(gray: Gray, corners_px: Array, optics: Optics, modules: int) -> Array:
    """Corners (n, 4, 2), clockwise in the image, moved to where the edges of n tags meet.

    `modules` is how many modules wide the black square is: a profile stays inside its one-module border and
    the one-module white margin. A tag with an edge that does not stand out keeps its corners.
    """
    refined = corners_px.astype(np.float64).copy()
    for _ in range(_ROUNDS):
        refined = _once(gray, refined, optics, modules)
    moved = np.linalg.norm(refined - corners_px, axis=2).max(axis=1)
    lost = ~(moved < _MAX_REACH_PX)
    refined[lost] = corners_px[lost]
    return refined


def _once(gray: Gray, corners: Array, optics: Optics, modules: int) -> Array:
    begin, end = corners, np.roll(corners, -1, axis=1)
    along = end - begin
    length = np.linalg.norm(along, axis=2)
    outward = np.stack([along[..., 1], -along[..., 0]], axis=2) / length[..., None]
    # The height of the quadrilateral over each edge, not the edge itself, says how wide a module is there.
    across = np.einsum("nek,nek->ne", outward, begin - corners.mean(axis=1, keepdims=True)) * 2.0
    reach = np.minimum(0.75 * across / modules, _MAX_REACH_PX)[..., None, None]
    share = np.linspace(_INSET, 1.0 - _INSET, _PROFILES)[:, None]
    base = begin[:, :, None, :] + share * along[:, :, None, :]
    offsets = np.linspace(-1.0, 1.0, _STEPS) * reach
    where = base[:, :, :, None, :] + offsets[..., None] * outward[:, :, None, None, :]
    levels = _sample(gray, where)
    black = levels[..., :3].mean(axis=(2, 3))[..., None]
    white = levels[..., -3:].mean(axis=(2, 3))[..., None]
    step = white - black
    filled = ((levels - black[..., None]) / np.maximum(step, 1.0)[..., None]).mean(axis=3)
    shift = reach[..., 0] * (1.0 - 2.0 * filled)
    edges = base + np.clip(shift, -reach[..., 0], reach[..., 0])[..., None] * outward[:, :, None, :]
    moved = _meet(edges, optics)
    kept = (step[..., 0].min(axis=1) < _MIN_STEP) | ~np.isfinite(moved).all(axis=(1, 2))
    moved[kept] = corners[kept]
    return moved


def _sample(gray: Gray, where: Array) -> Array:
    """Grey values, bilinear, at pixels (..., 2); those outside of the image are the nearest inside."""
    height, width = gray.shape
    u = np.clip(where[..., 0], 0.0, width - 1.001)
    v = np.clip(where[..., 1], 0.0, height - 1.001)
    column, row = u.astype(np.intp), v.astype(np.intp)
    right, down = u - column, v - row
    above = gray[row, column] * (1.0 - right) + gray[row, column + 1] * right
    below = gray[row + 1, column] * (1.0 - right) + gray[row + 1, column + 1] * right
    return above * (1.0 - down) + below * down


def _meet(edges: Array, optics: Optics) -> Array:
    """Pixels (n, 4, 2) where neighbouring lines meet; `edges` (n, 4, m, 2) are pixels on each edge."""
    rays = optics.rays(edges.reshape(-1, 2)).reshape(edges.shape)
    lines = _fit_lines(rays)
    meeting = np.cross(np.roll(lines, 1, axis=1), lines)
    with np.errstate(divide="ignore", invalid="ignore"):
        plane = meeting[..., :2] / meeting[..., 2:]
    plane[~np.isfinite(plane)] = 1e3
    points = np.concatenate([plane, np.ones((*plane.shape[:2], 1))], axis=2)
    pixels, _ = optics.project(points.reshape(-1, 3))
    return pixels.reshape(plane.shape)


def _fit_lines(points: NDArray[np.float64]) -> Array:
    """Homogeneous lines (n, 4, 3) by total least squares, each point weighted once more by its distance."""
    weights = np.ones(points.shape[:3])
    lines = np.empty((*points.shape[:2], 3))
    for _ in range(2):
        total = weights.sum(axis=2)[..., None]
        centre = (weights[..., None] * points).sum(axis=2) / total
        apart = points - centre[:, :, None, :]
        scatter = np.einsum("nem,nemi,nemj->neij", weights, apart, apart)
        normal = np.linalg.eigh(scatter)[1][..., :, 0]
        lines[..., :2] = normal
        lines[..., 2] = -np.einsum("nek,nek->ne", normal, centre)
        distance = np.abs(np.einsum("nemk,nek->nem", apart, normal))
        scale = 1.5 * np.median(distance, axis=2, keepdims=True) + 1e-12
        weights = 1.0 / (1.0 + (distance / (2.0 * scale)) ** 2)
    return lines
