"""Points of a file, before anything is known of their unit and place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_LARGEST = 1e9
_FLAT = 1e-6


class UnreadableError(Exception):
    """Why a file is no mesh or no point cloud, as words that follow its name; stays inside of this room."""


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """Points (n x 3) in the unit of their file; `is_closed` says of a mesh whether it bounds a volume."""

    points: Array
    is_closed: bool | None = None


def require_body(points: Array) -> None:
    """Raises UnreadableError where points make no body: too few, no numbers, or all in a plane."""
    bad = int((~np.isfinite(points)).any(axis=1).sum())
    if bad:
        raise UnreadableError(f"has {bad} of {len(points)} points that are no numbers")
    if len(points) < 4:
        raise UnreadableError(f"has {len(points)} points, and a body takes at least 4")
    if float(np.abs(points).max()) > _LARGEST:
        raise UnreadableError("has numbers beyond any size")
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    if spread[2] <= _FLAT * spread[0]:
        raise UnreadableError("is flat: all its points lie in a plane")
