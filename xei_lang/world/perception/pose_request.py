"""A picture and what is asked about it, and what a pose service answers: the values behind its contract."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from xei_lang.ir.geometry import Pose, Vec3

Mode = Literal["register", "track"]
PoseStatus = Literal["ok", "no_object", "low_quality", "error"]
Matrix = tuple[tuple[float, ...], ...]
"""Rows of a matrix of numbers as they came; nothing is known of it but that they are finite."""


@dataclass(frozen=True, slots=True)
class Intrinsics:
    """A pinhole camera in pixels, the centre of the top left pixel at (0, 0); `distortion` as in OpenCV."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int
    height: int
    distortion: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Picture:
    """A colour image and the depth that belongs to it, from one place.

    `T_output_camera` is the pose of the camera's body (x forward, y left, z up; REP 103) in `output_frame`.
    `depth_png16` has 16 bits a pixel: the distance along the optical axis in units of `depth_scale_m`, 0
    where nothing is known.
    """

    stamp_ns: int
    camera_frame: str
    output_frame: str
    T_output_camera: Pose
    intrinsics: Intrinsics
    rgb_png: bytes = field(repr=False)
    depth_png16: bytes = field(repr=False)
    depth_scale_m: float


@dataclass(frozen=True, slots=True)
class PoseQuery:
    """An object that is asked for; `mesh_sha256` says which shape is meant, see `RegisteredObject`."""

    object_id: str
    mesh_sha256: str
    mask_png: bytes | None = field(default=None, repr=False)
    mode: Mode = "register"


@dataclass(frozen=True, slots=True)
class PoseRequest:
    """What is sent to a pose service."""

    request_id: str
    picture: Picture
    queries: tuple[PoseQuery, ...]
    session_id: str


@dataclass(frozen=True, slots=True)
class MeshInfo:
    """The shape that a service knows an object by: its hash, the unit of its file, its bounding box in m."""

    sha256: str
    units: str
    size_m: Vec3


@dataclass(frozen=True, slots=True)
class ObjectPose:
    """What a service says of one object. Nothing of it has been believed yet: see `acceptance.py`.

    `T_output_object` is a 4x4 matrix by rows, m; `covariance` that of a small motion in the object's own
    axes, translation (m) before rotation (rad).
    """

    name: str
    frame_id: str
    status: PoseStatus
    T_output_object: Matrix | None
    confidence: float
    covariance: Matrix | None
    roles: tuple[str, ...]
    skills: tuple[str, ...]
    mesh: MeshInfo


@dataclass(frozen=True, slots=True)
class PoseResponse:
    """What a service answers. `stamp_ns` is that of the picture that the poses are for."""

    request_id: str
    stamp_ns: int
    objects: tuple[ObjectPose, ...]
    model_version: str
    processing_ms: float
