"""The HTTP contract of the pose service: the models of what crosses the wire, and nothing else.

Numbers are finite, keys that the contract does not have are refused, and images are base64 text (RFC 4648).
"""

from __future__ import annotations

import base64
import binascii
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

MAX_QUERIES = 64
MAX_OBJECTS = 1000
MAX_SIDE_PX = 8192

Text = Annotated[str, StringConstraints(min_length=1, max_length=200)]
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z_][A-Za-z0-9_]*$", max_length=100)]
Sha256 = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
Row4 = Annotated[list[float], Field(min_length=4, max_length=4)]
Matrix4 = Annotated[list[Row4], Field(min_length=4, max_length=4)]
Row6 = Annotated[list[float], Field(min_length=6, max_length=6)]
Matrix6 = Annotated[list[Row6], Field(min_length=6, max_length=6)]
Size = Annotated[list[Annotated[float, Field(ge=0, le=100)]], Field(min_length=3, max_length=3)]
Stamp = Annotated[int, Field(ge=0, lt=2**63)]
Names = Annotated[list[Text], Field(max_length=100)]
Png = Annotated[
    str,
    Field(
        max_length=200_000_000,
        json_schema_extra={"contentEncoding": "base64", "contentMediaType": "image/png"},
    ),
]


class Wire(BaseModel):
    """What all models share: nothing unknown, nothing converted, no NaN."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class IntrinsicsModel(Wire):
    """A pinhole camera in pixels; the centre of the top left pixel is (0, 0); distortion as OpenCV has it."""

    fx: Annotated[float, Field(gt=0, le=1e6)]
    fy: Annotated[float, Field(gt=0, le=1e6)]
    cx: Annotated[float, Field(ge=-1e6, le=1e6)]
    cy: Annotated[float, Field(ge=-1e6, le=1e6)]
    width: Annotated[int, Field(ge=1, le=MAX_SIDE_PX)]
    height: Annotated[int, Field(ge=1, le=MAX_SIDE_PX)]
    distortion: Annotated[list[float], Field(max_length=14)] = Field(default=[])


class QueryModel(Wire):
    """An object that is asked for. `mask_png` is white where it is seen."""

    object_id: Name
    mesh_sha256: Sha256
    mask_png: Png | None = None
    mode: Literal["register", "track"]


class PoseRequestModel(Wire):
    """`POST /v1/poses`. `T_output_camera` is by rows, m: the camera's body (x forward, y left, z up)."""

    request_id: Text
    stamp_ns: Stamp
    camera_frame: Text
    output_frame: Text
    T_output_camera: Matrix4
    intrinsics: IntrinsicsModel
    rgb_png: Png
    depth_png16: Png
    depth_scale_m: Annotated[float, Field(gt=0, le=1)]
    queries: Annotated[list[QueryModel], Field(min_length=1, max_length=MAX_QUERIES)]
    session_id: Text


class MeshModel(Wire):
    """The shape that an object is known by: the hash of its file, the file's unit, its bounding box."""

    sha256: Sha256
    units: Annotated[str, StringConstraints(pattern=r"^(m|mm|cm|in)$")]
    size_m: Size


class ObjectPoseModel(Wire):
    """Where one object is, or why that is not said. The matrix is there exactly where `status` is `ok`."""

    name: Name
    frame_id: Text
    status: Literal["ok", "no_object", "low_quality", "error"]
    T_output_object: Matrix4 | None
    confidence: Annotated[float, Field(ge=0, le=1)]
    covariance: Matrix6 | None
    roles: Names
    skills: Names
    mesh: MeshModel


class PoseResponseModel(Wire):
    """The answer to `POST /v1/poses`: one entry for each query."""

    request_id: Text
    stamp_ns: Stamp
    objects: Annotated[list[ObjectPoseModel], Field(max_length=MAX_QUERIES)]
    model_version: Text
    processing_ms: Annotated[float, Field(ge=0)]


class RegisteredModel(Wire):
    """An object of the registry, as `GET /objects` lists it."""

    name: Name
    roles: Names
    skills: Names
    mesh: MeshModel


class ObjectsModel(Wire):
    """`GET /objects`, and the answer to a `PUT`."""

    registry_sha256: Sha256
    objects: Annotated[list[RegisteredModel], Field(max_length=MAX_OBJECTS)]


class PutObjectModel(Wire):
    """`PUT /objects/{id}`: an object that is new, or that is to be known otherwise."""

    roles: Names
    skills: Names
    mesh: MeshModel


class HealthModel(Wire):
    """`GET /health`: `ready` where poses can be asked for, and for which lab."""

    status: Literal["ready", "not_ready"]
    backend: Text
    registry_sha256: Sha256
    detail: Annotated[str, StringConstraints(max_length=500)] = ""


class ModelEntry(Wire):
    """What answers: its name, its version, and the modes that it has."""

    name: Text
    version: Text
    modes: list[Literal["register", "track"]]


class ModelsModel(Wire):
    """`GET /models`."""

    models: Annotated[list[ModelEntry], Field(max_length=100)]


class ProblemModel(Wire):
    """The body of every answer that is no success."""

    error: Annotated[str, StringConstraints(max_length=2000)]


def decoded(text: str) -> bytes | None:
    """The bytes of base64 text; None where it is none."""
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        return None


def encoded(data: bytes) -> str:
    """Bytes as base64 text."""
    return base64.b64encode(data).decode("ascii")
