"""How far each arm comes at most: a bound by the lengths of its links, without any inverse kinematics.

What is out of this bound is out of reach. What is within may still have no grasp: planning tells.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile, RobotDescription, RobotJoint
from xei_lang.world.frames import T_base_link, slide_joint

_TOOL = "_tool"


@dataclass(frozen=True, slots=True)
class ArmReach:
    """Spheres of `radius_m` about the shoulder, in the robot's root frame, with the slide at its lowest and
    its highest.
    """

    arm: str
    lowest_m: Vec3
    highest_m: Vec3
    radius_m: float

    def holds(self, point_m: Vec3) -> bool:
        """Whether a point of the root frame is within reach at some height of the slide."""
        return self.miss_m(point_m) <= 0.0

    def miss_m(self, point_m: Vec3) -> float:
        """How far a point of the root frame lies beyond reach (m); at most 0 where it is within."""
        low, high = self.lowest_m[2], self.highest_m[2]
        nearest = (self.lowest_m[0], self.lowest_m[1], min(max(point_m[2], low), high))
        return math.dist(nearest, point_m) - self.radius_m


@dataclass(frozen=True, slots=True)
class StationReach:
    """The arms that may reach a point from a station; none where it is out of reach."""

    station: str
    arms: tuple[str, ...]


def arm_reaches(profile: Profile) -> tuple[ArmReach, ...]:
    """The reach of each arm that has a tool frame, in the order of those; empty for a robot without tools."""
    slide = profile.robot.joint(slide_joint(profile))
    ends = (slide.lower, slide.upper) if slide is not None else (0.0, 0.0)
    found: list[ArmReach] = []
    for name, tool in profile.calibration.robot_frames:
        chain = _turning_chain(profile.robot, tool) if name.endswith(_TOOL) else []
        if chain:
            length_m = sum(math.hypot(*joint.T_parent_joint.position_m) for joint in chain[1:])
            shoulders = [
                T_base_link(profile.robot, chain[0].child, {slide.name: height} if slide else {}).position_m
                for height in ends
            ]
            found.append(ArmReach(name.removesuffix(_TOOL), shoulders[0], shoulders[1], length_m))
    return tuple(found)


def stations_that_reach(profile: Profile, world: World, name: str) -> tuple[StationReach, ...]:
    """The stations from which an arm may come to the middle of an object, with the arms, in their order.

    Raises KeyError for an object that is not in the world.
    """
    item = world.find(name)
    if item is None:
        raise KeyError(name)
    middle = world.T_world_object(name).apply((0.0, 0.0, item.size_m[2] / 2))
    return reached_from(profile, arm_reaches(profile), middle)


def reached_from(profile: Profile, arms: tuple[ArmReach, ...], point_m: Vec3) -> tuple[StationReach, ...]:
    """The stations from which these arms may come to a point of `world`, in their order."""
    found: list[StationReach] = []
    for station in profile.calibration.stations:
        T_base_world: Pose = station.T_world_base.inverse()
        reach = tuple(arm.arm for arm in arms if arm.holds(T_base_world.apply(point_m)))
        if reach:
            found.append(StationReach(station.name, reach))
    return tuple(found)


def _turning_chain(robot: RobotDescription, link: str) -> list[RobotJoint]:
    """The joints from the first that turns down to a link."""
    by_child = {joint.child: joint for joint in robot.joints}
    chain: list[RobotJoint] = []
    while link != robot.root:
        chain.append(by_child[link])
        link = chain[-1].parent
    chain.reverse()
    first = next((i for i, joint in enumerate(chain) if joint.kind not in ("fixed", "prismatic")), len(chain))
    return chain[first:]
