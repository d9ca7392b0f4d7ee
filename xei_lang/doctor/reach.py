"""Whether the workspace that a profile allows is one that the arms can work in at all."""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.ir.geometry import Vec3
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import Profile, RobotDescription, RobotJoint
from xei_lang.world.frames import T_base_link, slide_joint

Box = tuple[Vec3, Vec3]
_AXES = "xyz"


def reach_blockers(profile: Profile) -> Iterator[Blocker]:
    """Sides of the workspace bounds that lie beyond everything that any hand can come to."""
    lower, upper = profile.calibration.workspace_bounds_m
    reached = tool_bounds(profile)
    if reached is None:
        return
    for name, bound, sign, limit in (("lower", lower, -1.0, reached[0]), ("upper", upper, 1.0, reached[1])):
        for axis, value, far in zip(_AXES, bound, limit, strict=True):
            if sign * (value - far) > 0.0:
                item = f"workspace.{name}.{axis}"
                measure = f"bring it to {far:.2f} m at most: it is {value:.2f} m, and no hand comes that far"
                measure = measure if sign > 0 else measure.replace("at most", "at least")
                yield Blocker(
                    "XEI0675",
                    "calibration_profile",
                    item,
                    "out of reach",
                    "hardware",
                    measure,
                    f"{CALIBRATION}:{item}",
                )


def tool_bounds(profile: Profile) -> Box | None:
    """A box in the robot's root frame, m, that holds every point that a tool frame can come to; None for a
    robot without tools.

    An outer bound: each arm is taken as a chain that stretches straight from the first of its joints that
    turns, at both ends of the slide.
    """
    tools = [link for name, link in profile.calibration.robot_frames if name.endswith("_tool")]
    slide = profile.robot.joint(slide_joint(profile))
    heights = (slide.lower, slide.upper) if slide is not None else (0.0,)
    spheres: list[tuple[Vec3, float]] = []
    for tool in tools:
        chain = _turning_chain(profile.robot, tool)
        if chain:
            length = sum(math.hypot(*joint.T_parent_joint.position_m) for joint in chain[1:])
            for height in heights:
                joints = {slide.name: height} if slide is not None else {}
                spheres.append((T_base_link(profile.robot, chain[0].child, joints).position_m, length))
    if not spheres:
        return None
    lower = tuple(min(center[axis] - radius for center, radius in spheres) for axis in range(3))
    upper = tuple(max(center[axis] + radius for center, radius in spheres) for axis in range(3))
    return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])


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
