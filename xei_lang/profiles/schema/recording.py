"""A recording for hand-eye calibration: joint positions, and what a camera saw of tags at each. SI units.

Recordings are written by programs, so numbers stand without units, in radians, metres and pixels, and every
name says which.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from xei_lang.profiles.schema.frames import Day
from xei_lang.profiles.schema.values import Model, Name, Text

Vector = Annotated[list[float], Field(min_length=3, max_length=3)]
Unit = Annotated[list[float], Field(min_length=4, max_length=4)]
Pixel = Annotated[list[float], Field(min_length=2, max_length=2)]


class BoardTagModel(Model):
    """A tag of the calibration target, in the target's own frame: x right, y up, z out of the paper."""

    id: Annotated[int, Field(ge=0)]
    size_m: Annotated[float, Field(gt=0, le=10)]
    position_m: Vector
    rpy_rad: Vector


class SeenTagModel(Model):
    """A tag that was seen: its top left, top right, bottom right and bottom left corner, as seen upright."""

    id: Annotated[int, Field(ge=0)]
    corners_px: Annotated[list[Pixel], Field(min_length=4, max_length=4)]


class SeenPoseModel(Model):
    """Pose of the calibration target in the camera's optical frame (x right, y down, z forward)."""

    position_m: Vector
    quaternion_xyzw: Unit


class SampleModel(Model):
    """One still: all joints that move the camera or the target, and either tags or a pose."""

    joints: dict[Text, float]
    tags: Annotated[list[SeenTagModel], Field(max_length=1000)] = Field(default=[])
    pose: SeenPoseModel | None = None


class RecordingModel(Model):
    """Samples that fix where a camera is mounted.

    `camera` is one of the profile's cameras; `target` is the frame of the robot that the tags are fixed to,
    whose place on it need not be known: `robot_base` for tags that stand still while the camera is carried
    about, `left_tool` for tags in a hand that a camera on the body or in the room looks at. `board` is their
    layout. `station` is where the base stood, for a camera that the robot does not carry.
    """

    version: Literal[1]
    recorded_on: Day
    camera: Name
    target: Name
    station: Name | None = None
    board: Annotated[list[BoardTagModel], Field(max_length=1000)] = Field(default=[])
    samples: Annotated[list[SampleModel], Field(min_length=1, max_length=10000)]
