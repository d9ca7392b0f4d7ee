"""calibration_profile.yaml: geometric deployment facts."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from xei_lang.profiles.schema.frames import Day, FrameModel
from xei_lang.profiles.schema.values import (
    Age,
    AngleVector,
    AngularSpeed,
    Bounds,
    Distance,
    Force,
    JointAcceleration,
    JointPosition,
    JointVelocity,
    LengthVector,
    Mass,
    Model,
    Name,
    Size,
    Speed,
    Status,
    Text,
    Torque,
    Turn,
    quantity_error,
)
from xei_lang.quantity import Quantity


class LimitModel(Model):
    """Planning limits of joints that share them; a range that is not given is the robot description's."""

    joints: list[Name] = Field(min_length=1)
    lower: JointPosition | None = None
    upper: JointPosition | None = None
    velocity: JointVelocity
    acceleration: JointAcceleration
    torque: Torque | None = None
    force: Force | None = None
    reason: Text


class BasePoseModel(Model):
    """Where the base stands, in `world`."""

    position: LengthVector
    rpy: AngleVector


class StationModel(Model):
    """A scene origin: a stand of the base from which a bench is worked."""

    aliases: list[Text] = Field(default=[])
    base: BasePoseModel
    status: Status
    ground_frame: Name
    slide: Distance


class CarryModel(Model):
    """Where a hand keeps what it holds while the base drives: the object's origin, in `robot_base`."""

    position: LengthVector
    status: Status
    reason: Text


class DockingModel(Model):
    """How well the base reaches a station: bounds, or standard deviations (`as: std`)."""

    position: Distance
    rotation: Turn
    kind: Literal["bound", "std"] = Field(default="bound", alias="as")
    status: Status
    remark: Text


class MobileBaseModel(Model):
    """The mobile base."""

    speed: Speed
    turn: AngularSpeed
    docking: DockingModel


class TableModel(Model):
    """The table's height above the floor and the volume above it, in the table's frame."""

    height: Size
    status: Status
    method: Text
    bounds: Bounds


class EarlierMapModel(Model):
    """A map that another one has taken the place of."""

    frame: Name
    yaml: str | None
    image: str | None
    sha256: str | None
    status: Status
    measured_on: Day | None = None


class MapModel(Model):
    """The map (ROS map_server) and the frame that it is in; null is a gap that blocks driving on hardware."""

    frame: Name
    yaml: str | None
    image: str | None
    sha256: str | None
    status: Status
    measured_on: Day | None = None
    history: Annotated[list[EarlierMapModel], Field(max_length=1000)] = Field(default=[])


_LARGEST_TAG_M = 1.0


def _tag_size(size: Quantity) -> Quantity:
    if size.si > _LARGEST_TAG_M:
        raise quantity_error(
            "a tag of more than a metre is a slip of the unit", "write its black edge, such as `50 mm`"
        )
    return size


class TagModel(Model):
    """One AprilTag: the pose of its centre in a frame, z out of the paper."""

    id: Annotated[int, Field(ge=0)]
    size: Annotated[Size, AfterValidator(_tag_size)]
    frame: Name
    position: LengthVector
    rpy: AngleVector


class TagsModel(Model):
    """The AprilTags that ground the tables, and what must be seen of them: so many of a frame, with their
    corners within a root mean square distance (pixels) of the joint pose.
    """

    family: Literal["tag16h5", "tag25h9", "tag36h11"]
    status: Status
    tags: list[TagModel]
    minimum_tags: Annotated[int, Field(ge=1, le=100)] = 2
    residual_px: Annotated[float, Field(gt=0, le=10)] = 0.8


def _distortion(values: list[float]) -> list[float]:
    if len(values) not in (0, 4, 5, 8, 12, 14):
        raise ValueError("a list of 0, 4, 5, 8, 12 or 14 numbers")
    return values


class IntrinsicsModel(Model):
    """A pinhole camera in pixels; distortion in OpenCV's order k1, k2, p1, p2, k3, ..."""

    fx: Annotated[float, Field(gt=0)]
    fy: Annotated[float, Field(gt=0)]
    cx: float
    cy: float
    width: Annotated[int, Field(ge=1, le=20000)]
    height: Annotated[int, Field(ge=1, le=20000)]
    distortion: Annotated[list[float], AfterValidator(_distortion)]


class CameraModel(Model):
    """A camera: its frame, intrinsics and topics."""

    frame: Name
    status: Status
    intrinsics: IntrinsicsModel
    topics: dict[Name, Text]


class LidarModel(Model):
    """A lidar: its frame and topics."""

    frame: Name
    status: Status
    topics: dict[Name, Text]


class CalibrationProfile(Model):
    """Frames, limits, stations, tolerances and sensors of one deployment."""

    version: Literal[1]
    robot_frames: dict[Name, Text]
    frames: dict[Name, FrameModel]
    limits: list[LimitModel]
    start_station: Name
    stations: dict[Name, StationModel]
    carry: dict[Literal["left", "right"], CarryModel] = Field(default={})
    base: MobileBaseModel
    table: TableModel
    workspace: Bounds
    payload: Mass
    spill_tilt: Turn
    clearance: Distance
    map: MapModel
    apriltags: TagsModel
    cameras: dict[Name, CameraModel] = Field(default={})
    lidars: dict[Name, LidarModel] = Field(default={})
    max_age: Age | None = None
