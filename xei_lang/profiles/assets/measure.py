"""A named file, measured in its object's frame and judged: its unit, its place, its size."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.ir.geometry import Box, Cylinder, Pose, Shape, Sphere, Vec3
from xei_lang.profiles.assets import told
from xei_lang.profiles.assets.fit import Extent, Kind, extent_of, fit, without_strays
from xei_lang.profiles.assets.points import Array, Points
from xei_lang.profiles.assets.told import Named, size_of
from xei_lang.profiles.assets.units import SCALES, likely_unit, matching_unit, plausible
from xei_lang.quantity.lengths import exact_mm

_KINDS: dict[type[Shape], Kind] = {Box: "box", Cylinder: "cylinder", Sphere: "sphere"}


@dataclass(frozen=True, slots=True)
class Slack:
    """How far sizes and places may differ: the larger of `least_m` and a fraction of the length."""

    least_m: float
    fraction: float
    sideways: float

    def of(self, length_m: float) -> float:
        """The slack at this length, metres."""
        return max(self.least_m, self.fraction * length_m)

    @property
    def text(self) -> str:
        """For a note."""
        return f"{exact_mm(self.least_m)} or {100 * self.fraction:g} %, whichever is more"


SLACK = {"mesh": Slack(0.001, 0.02, 0.05), "point_cloud": Slack(0.003, 0.05, 0.08)}
"""Meshes and point clouds against what is stated: clouds are noisy, and often lack the bottom."""


@dataclass(frozen=True, slots=True)
class Measured:
    """A file that a size can be taken from: its unit, and how far it reaches in the object's frame.

    One that `is_placed` stands on the frame; of another, only that is said.
    """

    units: str
    extent: Extent
    is_placed: bool


@dataclass(frozen=True, slots=True)
class Stated:
    """The shape that an object is known to have, and where that is written."""

    shape: Shape
    where: Span

    @property
    def longest_m(self) -> float:
        """Its longest side."""
        return max(size_of(self.shape))


def measured(named: Named, points: Points, stated: Stated | None, found: list[Diagnostic]) -> Measured | None:
    """The measure of a file, with what is wrong with it in `found`; None where it has none.

    With a `stated` shape, an unstated unit is the one in which sizes agree.
    """
    is_noisy = named.what == "point_cloud"
    kept = without_strays(points.points) if is_noisy else points.points
    turned = placed(kept, 1.0, Pose((0.0, 0.0, 0.0), named.T_object_file.quaternion))
    size = extent_of(turned, is_noisy=is_noisy).size_m
    if not max(size) > 0.0:
        found.append(told.unreadable(named, "has no size: its points lie in one place"))
        return None
    units = _units(named, size, stated, found)
    if units is None:
        return None
    extent = extent_of(placed(kept, SCALES[units], named.T_object_file), is_noisy=is_noisy)
    if points.is_closed is False:
        found.append(told.is_open(named))
    is_placed = _is_placed(extent, SLACK[named.what])
    if not is_placed:
        found.append(told.misplaced(named, extent, stated.where if stated else None))
    return Measured(units, extent, is_placed)


def _units(named: Named, size: Vec3, stated: Stated | None, found: list[Diagnostic]) -> str | None:
    """The unit of a file whose numbers span `size`, stated or told by the shape; None where there is none or
    another is meant.
    """
    if stated is None:
        return _units_by_size(named, size, found)
    matching = matching_unit(max(size), stated.longest_m)
    if named.units is None:
        found.append(told.assumed_units(named, matching, stated.where))
        return matching or None
    if matching not in ("", named.units):
        where = (stated.where, stated.longest_m)
        found.append(told.wrong_units(named, _scaled(size, named.units), matching, where))
        return None
    return named.units


def _units_by_size(named: Named, size: Vec3, found: list[Diagnostic]) -> str | None:
    likely = likely_unit(max(size))
    if named.units is None:
        found.append(told.no_units(named, max(size), likely))
        return None
    size_m = _scaled(size, named.units)
    if not plausible(max(size_m)):
        found.append(told.wrong_units(named, size_m, likely))
        return None
    return named.units


def _scaled(size: Vec3, units: str) -> Vec3:
    x, y, z = (value * SCALES[units] for value in size)
    return (x, y, z)


def placed(points: Array, scale: float, T_object_file: Pose) -> Array:
    """Points of a file (n x 3) in the object's frame, m: scaled first, then placed."""
    rotation = np.array([row[:3] for row in T_object_file.matrix()[:3]])
    return scale * points @ rotation.T + np.array(T_object_file.position_m)


def _is_placed(extent: Extent, slack: Slack) -> bool:
    x, y, z = extent.bottom_m
    sideways = max(slack.least_m, slack.sideways * max(extent.size_m[:2]))
    return max(abs(x), abs(y)) <= sideways and abs(z) <= slack.of(extent.size_m[2])


def disagreement(named: Named, one: Measured, stated: Stated) -> Iterator[Diagnostic]:
    """A size that is not the stated one, of a file that stands where it should."""
    kind = _KINDS.get(type(stated.shape))
    if kind is None or not one.is_placed:
        return
    slack, shape = SLACK[named.what], fit(one.extent, kind)
    sides = zip(size_of(shape), size_of(stated.shape), strict=True)
    if any(abs(a - b) > slack.of(b) for a, b in sides):
        yield told.disagrees(named, shape, stated.shape, stated.where, slack.text)
