"""Transforms between any two frames of a world: the value, the way to it, and how well it is known.

A link that is turned wrongly by an angle moves what is told through it by that angle times the distance from
the link's frame, its lever. Bounds of all links add up: the error is at most their sum. Standard deviations
of links are those of independent errors and add in quadrature, which to first order is never less than the
deviation along any direction. Of a way with both, the bounds' sum and `SIGMAS` standard deviations add up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.ir.geometry import IDENTITY, Pose, Vec3
from xei_lang.ir.tolerance import SIGMAS, as_bound
from xei_lang.ir.world import Frame, World

ROOT = "world"
_STATUSES = ("measured", "estimated", "placeholder")
"""From the best known to the least."""


@dataclass(frozen=True, slots=True)
class Share:
    """What one link adds to the error of a way: its own tolerance, and the lever (m) of its rotation."""

    link: Frame
    lever_m: float

    @property
    def position_m(self) -> float:
        """What it moves the point by: a bound or a standard deviation, as the link's tolerance is."""
        turned_m = self.link.rotation_tolerance_rad * self.lever_m
        if self.link.tolerance_as == "std":
            return math.hypot(self.link.position_tolerance_m, turned_m)
        return self.link.position_tolerance_m + turned_m

    @property
    def most_m(self) -> float:
        """The same as a bound."""
        return as_bound(self.position_m, self.link.tolerance_as)


@dataclass(frozen=True, slots=True)
class Transform:
    """`T_target_source`, and what it rests on.

    `path` names the frames from `target` to `source`, up to the frame that both hang on and down again;
    `shares` are the frames of the tree whose own transforms were used, in that order, each with what it adds
    to the error of the source's origin (or of the point that was asked about) in `target`.
    """

    T_target_source: Pose
    path: tuple[str, ...]
    shares: tuple[Share, ...]

    @property
    def links(self) -> tuple[Frame, ...]:
        """The frames whose own transforms were used."""
        return tuple(share.link for share in self.shares)

    @property
    def position_bound_m(self) -> float:
        """What the links that state bounds move the point by at most."""
        return sum(share.position_m for share in self.shares if share.link.tolerance_as == "bound")

    @property
    def position_std_m(self) -> float:
        """Standard deviation of the point by the links that state one, along the least certain direction."""
        return math.hypot(*(one.position_m for one in self.shares if one.link.tolerance_as == "std"))

    @property
    def rotation_bound_rad(self) -> float:
        """What the links that state bounds turn the source by at most."""
        return sum(link.rotation_tolerance_rad for link in self.links if link.tolerance_as == "bound")

    @property
    def rotation_std_rad(self) -> float:
        """Standard deviation of the source's orientation by the links that state one."""
        return math.hypot(*(one.rotation_tolerance_rad for one in self.links if one.tolerance_as == "std"))

    @property
    def position_tolerance_m(self) -> float:
        """What the point's error is taken to be at most: the bound and `SIGMAS` standard deviations."""
        return self.position_bound_m + SIGMAS * self.position_std_m

    @property
    def rotation_tolerance_rad(self) -> float:
        """What the error of the orientation is taken to be at most."""
        return self.rotation_bound_rad + SIGMAS * self.rotation_std_rad

    @property
    def status(self) -> str:
        """The status of the least known link: `measured`, `estimated` or `placeholder`."""
        known = [_STATUSES.index(link.status) for link in self.links if link.status in _STATUSES]
        return _STATUSES[max(known, default=0)]


@dataclass(frozen=True, slots=True)
class Deviation:
    """How far a measured transform is from the stated one, and whether its tolerance admits that."""

    position_m: float
    rotation_rad: float
    within: bool


def lookup(world: World, target: str, source: str, point_m: Vec3 = (0.0, 0.0, 0.0)) -> Transform:
    """The transform from `source` to `target`; `point_m`, in `source`, is the point whose error is bounded.

    Raises KeyError for a frame that the world does not have.
    """
    up, down = _to_root(world, target), _to_root(world, source)
    while up and down and up[-1].name == down[-1].name:
        up.pop()
        down.pop()
    T_target_common = _chain(up).inverse()
    T_target_source = T_target_common @ _chain(down)
    point = T_target_source.apply(point_m)
    shares = (*_shares(up, T_target_common, point), *_shares(down, T_target_common, point)[::-1])
    common = (up or down or [None])[-1]
    parent = common.parent if common else target
    path = (*(link.name for link in up), parent, *(link.name for link in reversed(down)))
    return Transform(T_target_source, path, shares)


def _shares(way: list[Frame], T_target_common: Pose, point_m: Vec3) -> tuple[Share, ...]:
    """The shares of the links from a frame up to the common one; the point is told in the target."""
    found: list[Share] = []
    T_target_frame = T_target_common
    for link in reversed(way):
        T_target_frame = T_target_frame @ link.T_parent_frame
        found.append(Share(link, math.dist(T_target_frame.position_m, point_m)))
    return tuple(found[::-1])


def verify_transform(frame: Frame, T_parent_measured: Pose) -> Deviation:
    """Whether a measurement of a frame agrees with what the calibration says: within its bound, or within
    `SIGMAS` of its standard deviations.
    """
    T_frame_measured = frame.T_parent_frame.inverse() @ T_parent_measured
    position_m = math.hypot(*T_frame_measured.position_m)
    rotation_rad = 2.0 * math.acos(min(1.0, abs(T_frame_measured.quaternion[3])))
    kind = frame.tolerance_as
    within = position_m <= as_bound(frame.position_tolerance_m, kind)
    turned = rotation_rad <= as_bound(frame.rotation_tolerance_rad, kind)
    return Deviation(position_m, rotation_rad, within and turned)


def _to_root(world: World, name: str) -> list[Frame]:
    """The frames from this one to the root, which is left out."""
    way: list[Frame] = []
    while name != ROOT:
        frame = world.frame(name)
        if frame is None or frame in way:
            raise KeyError(name)
        way.append(frame)
        name = frame.parent
    return way


def _chain(way: list[Frame]) -> Pose:
    """The first frame's pose in the parent of the last."""
    pose = IDENTITY
    for frame in way:
        pose = frame.T_parent_frame @ pose
    return pose
