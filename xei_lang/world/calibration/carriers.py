"""What the robot moves between two frames of a calibration profile: links, and the joints on the way.

A frame that hangs on `world` is told from the base, which stands still at a station.
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.geometry import IDENTITY, Pose
from xei_lang.ir.world import World
from xei_lang.profiles.model import Profile, RobotDescription, RobotJoint
from xei_lang.world.frames import T_base_link
from xei_lang.world.transforms import lookup

BASE = "robot_base"


@dataclass(frozen=True, slots=True)
class Carried:
    """A frame that is fixed to a link of the robot."""

    frame: str
    link: str
    T_link_frame: Pose

    def T_base_frame(self, robot: RobotDescription, joints: dict[str, float]) -> Pose:
        """Pose of the frame in the robot's root link, at joint positions by name (rad, m)."""
        return T_base_link(robot, self.link, joints) @ self.T_link_frame


def carried(profile: Profile, frame: str) -> Carried | None:
    """How the robot carries a frame; None for one that hangs on `world`, or that does not exist."""
    links = dict(profile.calibration.robot_frames)
    frames = {one.name: one for one in profile.calibration.frames}
    pose, name = IDENTITY, frame
    while name not in links:
        if name not in frames:
            return None
        pose = frames[name].T_parent_frame @ pose
        name = frames[name].parent
    return Carried(frame, links[name], pose)


def before_base(profile: Profile, frame: str, standing: World) -> Carried:
    """A frame that the robot does not carry, as it stands before the base. KeyError for one that is not
    there.
    """
    link = dict(profile.calibration.robot_frames)[BASE]
    return Carried(frame, link, lookup(standing, BASE, frame).T_target_source)


def joints_between(robot: RobotDescription, first: str, second: str) -> tuple[RobotJoint, ...]:
    """The joints that move one link against another, in the description's order; of a mimic its model."""
    ways = [_way(robot, first), _way(robot, second)]
    moving = ways[0] ^ ways[1]
    by_name = {joint.name: joint for joint in robot.joints}
    sources = {by_name[name].mimic or name for name in moving if by_name[name].kind != "fixed"}
    return tuple(joint for joint in robot.joints if joint.name in sources)


def _way(robot: RobotDescription, link: str) -> set[str]:
    by_child = {joint.child: joint for joint in robot.joints}
    way: set[str] = set()
    while link != robot.root:
        way.add(by_child[link].name)
        link = by_child[link].parent
    return way
