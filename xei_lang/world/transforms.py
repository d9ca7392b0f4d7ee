"""Transforms between any two frames of a world: the value, the way to it, and how well it is known.

Tolerances are bounds: the error of a whole way is at most the sum of what each link can contribute. A link
that is turned wrongly by an angle moves what is told through it by that angle times the distance from the
link's frame.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.ir.geometry import IDENTITY, Pose, Vec3
from xei_lang.ir.world import Frame, World

ROOT = "world"
_STATUSES = ("measured", "estimated", "placeholder")
"""From the best known to the least."""


@dataclass(frozen=True, slots=True)
class Transform:
    """`T_target_source`, and what it rests on.

    `path` names the frames from `target` to `source`, up to the frame that both hang on and down again;
    `links` are the frames of the tree whose own transforms were used, in that order. `position_tolerance_m`
    bounds the error of the source's origin (or of the point that was asked about) in `target`,
    `rotation_tolerance_rad` that of its orientation.
    """

    T_target_source: Pose
    path: tuple[str, ...]
    links: tuple[Frame, ...]
    position_tolerance_m: float
    rotation_tolerance_rad: float

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
    position = rotation = 0.0
    for links, T_target_start in ((up, T_target_common), (down, T_target_common)):
        T_target_frame = T_target_start
        for link in reversed(links):
            T_target_frame = T_target_frame @ link.T_parent_frame
            lever_m = math.dist(T_target_frame.position_m, point)
            position += link.position_tolerance_m + link.rotation_tolerance_rad * lever_m
            rotation += link.rotation_tolerance_rad
    common = (up or down or [None])[-1]
    parent = common.parent if common else target
    path = (*(link.name for link in up), parent, *(link.name for link in reversed(down)))
    return Transform(T_target_source, path, (*up, *reversed(down)), position, rotation)


def verify_transform(frame: Frame, T_parent_measured: Pose) -> Deviation:
    """Whether a measurement of a frame agrees with what the calibration says, within its tolerance."""
    T_frame_measured = frame.T_parent_frame.inverse() @ T_parent_measured
    position_m = math.hypot(*T_frame_measured.position_m)
    rotation_rad = 2.0 * math.acos(min(1.0, abs(T_frame_measured.quaternion[3])))
    within = position_m <= frame.position_tolerance_m and rotation_rad <= frame.rotation_tolerance_rad
    return Deviation(position_m, rotation_rad, within)


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
