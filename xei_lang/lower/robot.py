"""What lowering needs of the robot's body: where its shoulders are, and how long its arms."""

from __future__ import annotations

import math
from functools import cache

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.skill_plan import Side
from xei_lang.profiles.model import Profile, RobotDescription


def shoulder_xy(profile: Profile, side: Side) -> tuple[float, float]:
    """The shoulder's centre in the base frame, from above (the slide is upright, so its height does not
    matter).

    It lies on the second joint's axis, where the first three axes meet; that joint's own origin is near
    enough here.
    """
    x, y, _ = _shoulder(profile.robot, side)
    return (x, y)


def shoulder_height_m(profile: Profile, side: Side) -> float:
    """The shoulder's height over the base with the slide at its lower end."""
    return _shoulder(profile.robot, side)[2]


@cache
def _shoulder(robot: RobotDescription, side: Side) -> Vec3:
    by_child = {item.child: item for item in robot.joints}
    point, joint = (0.0, 0.0, 0.0), robot.joint(f"openarm_{side}_joint2")
    while joint is not None:
        point = joint.T_parent_joint.apply(point)
        joint = by_child.get(joint.parent)
    return point


def arm_length_m(profile: Profile, side: Side) -> float:
    """A bound on how far a tool is from its shoulder: all parts of the arm on one line; infinite for a robot
    that is not described so far.
    """
    return _arm_length(profile.robot, side)


@cache
def _arm_length(robot: RobotDescription, side: Side) -> float:
    by_child = {item.child: item for item in robot.joints}
    joint, length = by_child.get(f"openarm_{side}_grasp"), 0.0
    while joint is not None:
        # Counted from the second joint's origin, as the shoulder is; the first one may turn that about.
        if joint.name == f"openarm_{side}_joint2":
            return length + math.hypot(*joint.T_parent_joint.position_m)
        length += math.hypot(*joint.T_parent_joint.position_m)
        joint = by_child.get(joint.parent)
    return math.inf


def reach_direction(profile: Profile, side: Side, T_base_object: Pose) -> tuple[float, float]:
    """The level unit vector from the shoulder to an object, in the base frame; straight ahead where they
    coincide.
    """
    x, y = shoulder_xy(profile, side)
    dx, dy = T_base_object.position_m[0] - x, T_base_object.position_m[1] - y
    norm = math.hypot(dx, dy)
    return (dx / norm, dy / norm) if norm > 1e-9 else (1.0, 0.0)
