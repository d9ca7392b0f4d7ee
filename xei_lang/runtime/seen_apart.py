"""How far what is seen stands from where the plan was made for, and how far it may."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from xei_lang.ir.geometry import Cylinder, Pose
from xei_lang.ir.tolerance import SIGMAS
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile
from xei_lang.world.sources.observation import Observation
from xei_lang.world.transforms import Transform, lookup

BASE = "robot_base"


@dataclass(frozen=True, slots=True)
class Apart:
    """A frame or an object that was seen: how far it is from the plan's pose in the base's frame, and what
    the way by which it was seen can be off by (with three standard deviations of the sight itself).
    """

    name: str
    position_m: float
    rotation_rad: float
    allowed_m: float
    allowed_rad: float
    way: str

    @property
    def within(self) -> bool:
        """Whether what is seen does not speak against the plan."""
        return self.position_m <= self.allowed_m and self.rotation_rad <= self.allowed_rad

    @property
    def text(self) -> str:
        """`12.3 mm and 0.20 deg from where the plan has it, and 5.8 mm and 0.30 deg are allowed by ...`"""
        return (
            f"{_text(self.position_m, self.rotation_rad)} from where the plan has it, and "
            f"{_text(self.allowed_m, self.allowed_rad)} are allowed by way of `{self.way}`"
        )

    def to_json(self) -> dict[str, Any]:
        """As the trace keeps it."""
        return {
            "name": self.name,
            "position_m": self.position_m,
            "rotation_rad": self.rotation_rad,
            "allowed_m": self.allowed_m,
            "allowed_rad": self.allowed_rad,
            "way": self.way,
        }


def frame_apart(expected: World, profile: Profile, frame: str, seen: Observation, camera: str) -> Apart:
    """A frame by the object of its name, whose pose in it the world has: a table by its tags."""
    body = expected.find(seen.name)
    assert body is not None
    T_frame_body = expected.T_world_frame(frame).inverse() @ expected.T_world_object(seen.name)
    T_base_frame = _T_base_seen(expected, seen) @ T_frame_body.inverse()
    expected_pose = lookup(expected, BASE, frame).T_target_source
    return _apart(expected, profile, frame, (expected_pose, T_base_frame), seen, camera, upright=False)


def object_apart(expected: World, profile: Profile, seen: Observation, camera: str) -> Apart:
    """An object; one that is round may be turned about its own axis."""
    T_base_world = lookup(expected, BASE, "world").T_target_source
    poses = (T_base_world @ expected.T_world_object(seen.name), _T_base_seen(expected, seen))
    known = profile.object(seen.name)
    upright = known is not None and isinstance(known.shape, Cylinder)
    return _apart(expected, profile, seen.name, poses, seen, camera, upright=upright)


def docked(expected: World, frame: str) -> Transform:
    """The way to a frame over the base as it docks, which is known by the station alone."""
    return lookup(expected, BASE, frame)


def _T_base_seen(expected: World, seen: Observation) -> Pose:
    assert seen.T_frame_object is not None
    return lookup(expected, BASE, seen.frame_id).T_target_source @ seen.T_frame_object


def _apart(
    expected: World,
    profile: Profile,
    name: str,
    poses: tuple[Pose, Pose],
    seen: Observation,
    camera: str,
    *,
    upright: bool,
) -> Apart:
    planned, found = poses
    apart = planned.inverse() @ found
    turned = 2.0 * math.acos(min(1.0, abs(apart.quaternion[3])))
    if upright:
        turned = math.acos(max(-1.0, min(1.0, apart.axes()[2][2])))
    way, end = _way(expected, profile, planned, camera)
    spread = [seen.covariance[7 * k] for k in range(6)] if len(seen.covariance) == 36 else [0.0] * 6
    return Apart(
        name,
        math.dist(planned.position_m, found.position_m),
        turned,
        way.position_tolerance_m + SIGMAS * math.sqrt(sum(spread[:3])),
        way.rotation_tolerance_rad + SIGMAS * math.sqrt(sum(spread[3:])),
        end,
    )


def _way(expected: World, profile: Profile, T_base_point: Pose, camera: str) -> tuple[Transform, str]:
    """The way by the camera that saw it; where none is named the best of all, as plans are weighed."""
    T_world_point = lookup(expected, "world", BASE).T_target_source @ T_base_point
    cameras = profile.calibration.cameras
    named = [one.frame for one in cameras if one.name == camera]
    ends = [end for end in (named or [one.frame for one in cameras]) if expected.frame(end)] or ["world"]
    ways: list[tuple[Transform, str]] = []
    for end in ends:
        point = (expected.T_world_frame(end).inverse() @ T_world_point).position_m
        ways.append((lookup(expected, BASE, end, point), end))
    return min(ways, key=lambda way: way[0].position_tolerance_m)


def _text(position_m: float, rotation_rad: float) -> str:
    return f"{1e3 * position_m:.1f} mm and {math.degrees(rotation_rad):.2f} deg"
