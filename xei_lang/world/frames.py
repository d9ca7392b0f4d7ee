"""The frame tree of a deployment at its start: calibrated frames, and those that the robot carries."""

from __future__ import annotations

import math

from xei_lang.ir.geometry import IDENTITY, Pose
from xei_lang.ir.world import Frame, RobotState, World, WorldObject
from xei_lang.profiles.model import Profile, RobotDescription, RobotJoint, SceneOrigin

START_STATE = "home"
_GRIPPER_START = "closed"


def start_state(profile: Profile) -> RobotState:
    """The robot before anything moves: at the start station, slide as the station says, arms at home,
    grippers closed.
    """
    calibration = profile.calibration
    station = next(item for item in calibration.stations if item.name == calibration.start_station)
    return state_at(profile, station)


def state_at(profile: Profile, station: SceneOrigin) -> RobotState:
    """The robot at a station, slide as the station says, arms at home, grippers closed.

    Joints are those that can be planned (not fixed, not mimicking), in the description's order; a joint that
    no state names stands at the point of its range that is nearest to zero.
    """
    named = dict(profile.robot.state(_GRIPPER_START)) | dict(profile.robot.state(START_STATE))
    joints: list[tuple[str, float]] = []
    for joint in profile.robot.joints:
        if joint.kind == "fixed" or joint.mimic:
            continue
        value = named.get(joint.name, min(max(0.0, joint.lower), joint.upper))
        joints.append((joint.name, station.slide_m if joint.name == slide_joint(profile) else value))
    return RobotState(tuple(joints), station.name, station.T_world_base)


def world_at(profile: Profile, station: SceneOrigin, objects: tuple[WorldObject, ...] = ()) -> World:
    """The frames of a deployment with the robot at a station."""
    state = state_at(profile, station)
    return World(frame_tree(profile, state), objects, state)


def slide_joint(profile: Profile) -> str:
    """The joint that carries the frame `slide`, or an empty name where the calibration has no such frame."""
    link = dict(profile.calibration.robot_frames).get("slide", "")
    return next(
        (joint.name for joint in profile.robot.joints if joint.child == link and joint.kind == "prismatic"),
        "",
    )


def frame_tree(profile: Profile, state: RobotState) -> tuple[Frame, ...]:
    """All frames, sorted by name, with the root `world` left out; the robot's are at `state`.

    Frames that the robot carries hang on `robot_base` by forward kinematics of its description. Loading has
    made sure that the frames are one tree.
    """
    calibration = profile.calibration
    frames = [
        Frame(
            frame.name,
            frame.parent,
            frame.T_parent_frame,
            frame.status,
            frame.position_tolerance_m,
            frame.rotation_tolerance_rad,
            frame.tolerance_as,
        )
        for frame in calibration.frames
    ]
    station = next(item for item in calibration.stations if item.name == state.station)
    joints = dict(state.joints)
    for name, link in calibration.robot_frames:
        if name == "robot_base":
            frames.append(
                Frame(
                    name,
                    "world",
                    state.T_world_base,
                    station.status,
                    calibration.docking_position_tolerance_m,
                    calibration.docking_rotation_tolerance_rad,
                    calibration.docking_tolerance_as,
                )
            )
        else:
            frames.append(
                Frame(name, "robot_base", T_base_link(profile.robot, link, joints), "estimated", 0.0, 0.0)
            )
    return tuple(sorted(frames, key=lambda frame: frame.name))


def T_base_link(robot: RobotDescription, link: str, joints: dict[str, float]) -> Pose:
    """Pose of a link in the robot's root link; joints that are not named stand at zero."""
    by_child = {joint.child: joint for joint in robot.joints}
    pose = IDENTITY
    while link != robot.root:
        joint = by_child[link]
        pose = joint.T_parent_joint @ _motion(joint, joints.get(joint.mimic or joint.name, 0.0)) @ pose
        link = joint.parent
    return pose


def _motion(joint: RobotJoint, value: float) -> Pose:
    if joint.kind == "fixed":
        return IDENTITY
    norm = math.sqrt(sum(part * part for part in joint.axis))
    x, y, z = (part / norm for part in joint.axis)
    if joint.kind == "prismatic":
        return Pose((x * value, y * value, z * value))
    s = math.sin(value / 2)
    return Pose((0.0, 0.0, 0.0), (x * s, y * s, z * s, math.cos(value / 2)))
