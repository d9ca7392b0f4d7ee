"""A recording for hand-eye calibration, from its file to samples: poses by kinematics, and what was seen.

With `A = T_target_parent` by forward kinematics, `X = T_parent_camera` that is looked for, `B` the pose of
the board that the camera saw and `Z = T_target_board` that stays the same: `A X B = Z` for each sample. That
holds for a camera in the hand (the target stands still), and for one on the body or in the room (the hand
holds the target). A camera in the room needs the station that the base stood at.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from pydantic import ValidationError

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, did_you_mean
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.faults import explain
from xei_lang.profiles.model import CalibratedFrame, Camera, Profile, RobotJoint
from xei_lang.profiles.schema.recording import RecordingModel, SampleModel, SeenPoseModel
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.profiles.yaml_tree import Node
from xei_lang.world.calibration.board import Board, see_board
from xei_lang.world.calibration.carriers import Carried, before_base, carried, joints_between
from xei_lang.world.calibration.sample import Sample
from xei_lang.world.frames import world_at
from xei_lang.world.perception.optics import T_CAMERA_OPTICAL, Optics, matrix_of

_CODE = "XEI0684"
_NORM_SLACK = 1e-3
_RANGE_SLACK = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class Recording:
    """What is to be solved: `frame` is the camera's frame, as the profile has it now.

    `standing` are the frames around the base at its station, for a camera that the robot does not carry;
    else None.
    """

    recorded_on: str
    camera: Camera
    frame: CalibratedFrame
    target: str
    samples: tuple[Sample, ...]
    standing: World | None = None


@dataclass(frozen=True, slots=True, eq=False)
class _Setting:
    profile: Profile
    camera: Camera
    frame: CalibratedFrame
    parent: Carried
    target: Carried
    moving: tuple[RobotJoint, ...]
    board: Board
    standing: World | None


def read_recording(source: Source, profile: Profile) -> tuple[Recording | None, Diagnostics]:
    """The recording of a YAML (or JSON) text; None, with all that is wrong with it."""
    root, faults = read_yaml(source.file, source.text)
    if root is None or faults:
        return None, tuple(_recoded(fault) for fault in faults)
    try:
        model = RecordingModel.model_validate(root.plain())
    except ValidationError as error:
        return None, tuple(_recoded(fault) for fault in explain(error, root, RecordingModel))
    found: list[Diagnostic] = []
    setting = _setting(model, profile, root, found)
    if setting is None:
        return None, tuple(found)
    samples = [_sample(index, one, setting, root, found) for index, one in enumerate(model.samples)]
    usable = tuple(sample for sample in samples if sample is not None)
    if len({sample.is_pixels for sample in usable}) > 1:
        where = root.span_of("samples")
        found.append(
            Diagnostic(_CODE, "some samples have tags and some a pose", where, help=("keep one kind",))
        )
    if found:
        return None, tuple(found)
    camera, frame = setting.camera, setting.frame
    return Recording(model.recorded_on, camera, frame, model.target, usable, setting.standing), ()


def _recoded(fault: Diagnostic) -> Diagnostic:
    """What the reader of profiles says, under the code of recordings."""
    return Diagnostic(
        _CODE, fault.message, fault.span, fault.label, fault.labels, fault.notes, fault.help, fault.fix
    )


def _setting(model: RecordingModel, profile: Profile, root: Node, found: list[Diagnostic]) -> _Setting | None:
    calibration = profile.calibration
    camera = next((one for one in calibration.cameras if one.name == model.camera), None)
    if camera is None:
        found.append(
            _unknown("camera", model.camera, [one.name for one in calibration.cameras], root, "camera")
        )
        return None
    frame = next((one for one in calibration.frames if one.name == camera.frame), None)
    target = carried(profile, model.target)
    if target is None:
        known = [name for name, _ in calibration.robot_frames]
        found.append(_unknown("frame that the robot carries", model.target, known, root, "target"))
    if frame is None:
        message = f"`{camera.frame}`, the frame of the camera `{camera.name}`, is the robot's own"
        help_ = "give the camera a frame of its own under `frames`, which can be calibrated"
        found.append(Diagnostic(_CODE, message, root.span_of("camera"), help=(help_,)))
        return None
    parent, standing = _parent(model, profile, frame, root, found)
    if parent is None or target is None:
        return None
    moving = joints_between(profile.robot, parent.link, target.link)
    if not moving:
        message = f"no joint moves `{target.frame}` against `{frame.name}`: every sample is the same"
        help_ = "fix the tags to what the robot moves before the camera, and name that frame"
        found.append(Diagnostic(_CODE, message, root.span_of("target"), help=(help_,)))
        return None
    board = Board.of(model.board, Optics.of(camera))
    return _Setting(profile, camera, frame, parent, target, moving, board, standing)


def _parent(
    model: RecordingModel, profile: Profile, frame: CalibratedFrame, root: Node, found: list[Diagnostic]
) -> tuple[Carried | None, World | None]:
    """What the camera's frame hangs on, as the robot carries it or as it stands before the base."""
    parent = carried(profile, frame.parent)
    if parent is not None:
        return parent, None
    stations = {one.name: one for one in profile.calibration.stations}
    if model.station is None:
        message = f"`{frame.name}` hangs on `{frame.parent}`, and nothing says where the robot stood"
        help_ = "name the station that the base stood at in all samples: `station: ...`"
        note = "known: " + ", ".join(f"`{name}`" for name in stations)
        found.append(Diagnostic(_CODE, message, root.span_of("camera"), notes=(note,), help=(help_,)))
        return None, None
    station = stations.get(model.station)
    if station is None:
        found.append(_unknown("station", model.station, list(stations), root, "station"))
        return None, None
    standing = world_at(profile, station)
    return before_base(profile, frame.parent, standing), standing


def _sample(
    index: int, model: SampleModel, setting: _Setting, root: Node, found: list[Diagnostic]
) -> Sample | None:
    before = len(found)
    joints = _joints(index, model, setting, root, found)
    if bool(model.tags) == (model.pose is not None):
        message = f"sample {index + 1} must have either `tags` or a `pose`"
        found.append(Diagnostic(_CODE, message, root.span_of("samples", index)))
    if model.pose is not None:
        _check_unit(index, model.pose, root, found)
    if len(found) > before:
        return None
    robot = setting.profile.robot
    T_base_target = setting.target.T_base_frame(robot, joints)
    A = matrix_of(T_base_target.inverse() @ setting.parent.T_base_frame(robot, joints))
    if model.pose is not None:
        x, y, z, w = model.pose.quaternion_xyzw
        norm = math.sqrt(x * x + y * y + z * z + w * w)
        px, py, pz = model.pose.position_m
        seen = Pose((px, py, pz), (x / norm, y / norm, z / norm, w / norm))
        empty = np.empty((0, 3)), np.empty((0, 2))
        return Sample(index + 1, A, matrix_of(T_CAMERA_OPTICAL @ seen), *empty)
    board = see_board(model.tags, setting.board, index, root)
    if isinstance(board, Diagnostic):
        found.append(board)
        return None
    T_optical_board, points, rays = board
    return Sample(index + 1, A, matrix_of(T_CAMERA_OPTICAL) @ T_optical_board, points, rays)


def _joints(
    index: int, model: SampleModel, setting: _Setting, root: Node, found: list[Diagnostic]
) -> dict[str, float]:
    where = ("samples", index, "joints")
    movable = [
        joint.name for joint in setting.profile.robot.joints if joint.kind != "fixed" and not joint.mimic
    ]
    for name in model.joints:
        if name not in movable:
            near = did_you_mean(name, movable)
            help_ = f"did you mean `{near[0]}`?" if near else "the joints are " + ", ".join(movable)
            message = f"the robot has no joint `{name}`"
            found.append(
                Diagnostic(_CODE, message, root.key_span(*where, name), "unknown joint", help=(help_,))
            )
    for joint in setting.moving:
        value = model.joints.get(joint.name)
        if value is None:
            message = f"sample {index + 1} has no position of `{joint.name}`"
            note = f"it moves `{setting.target.frame}` against `{setting.parent.frame}`"
            found.append(Diagnostic(_CODE, message, root.span_of(*where), notes=(note,)))
        elif not joint.lower - _RANGE_SLACK <= value <= joint.upper + _RANGE_SLACK:
            unit = "m" if joint.kind == "prismatic" else "rad"
            message = f"`{joint.name}` cannot be at {value:g} {unit}"
            label = f"its range is {joint.lower:g} .. {joint.upper:g} {unit}"
            help_ = "positions are in radians and metres"
            found.append(Diagnostic(_CODE, message, root.span_of(*where, joint.name), label, help=(help_,)))
    return dict(model.joints)


def _check_unit(index: int, pose: SeenPoseModel, root: Node, found: list[Diagnostic]) -> None:
    norm = math.sqrt(sum(value * value for value in pose.quaternion_xyzw))
    if abs(norm - 1.0) > _NORM_SLACK:
        span = root.span_of("samples", index, "pose", "quaternion_xyzw")
        message = f"the quaternion of sample {index + 1} has norm {norm:.4g}, not 1"
        found.append(Diagnostic(_CODE, message, span, help=("write x, y, z, w of a unit quaternion",)))


def _unknown(what: str, name: str, known: list[str], root: Node, key: str) -> Diagnostic:
    near = did_you_mean(name, known)
    help_ = f"did you mean `{near[0]}`?" if near else "known: " + ", ".join(f"`{one}`" for one in known)
    return Diagnostic(_CODE, f"`{name}` is no {what} of this profile", root.span_of(key), help=(help_,))
