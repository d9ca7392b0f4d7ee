"""A scene file: where things were seen, written down on one day for one registry of objects."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from xei_lang.profiles.schema.frames import Covariance
from xei_lang.profiles.schema.values import (
    AngleVector,
    Fraction01,
    LengthVector,
    Model,
    Name,
    SizeVector,
    Text,
)

Digest = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
Stamp = Annotated[
    str,
    StringConstraints(pattern=r"^\d{4}-\d{2}-\d{2}T\d{2}:\d{2}:\d{2}(\.\d{1,9})?Z$"),
    Field(description="a time in UTC, such as `2026-11-02T10:15:00Z`"),
]
MatrixRow = Annotated[list[float | int], Field(min_length=4, max_length=4)]


class SceneObjectModel(Model):
    """What was seen of an object; whatever is left out, the file does not say.

    Its pose (bottom centre, z up) is given in `frame` by `position` with `rpy` or `quaternion` (x, y, z, w),
    or by `matrix` (4 x 4, row by row, metres). `absent` says that it is not there, whatever its prior says.
    """

    frame: Name | None = None
    position: LengthVector | None = None
    rpy: AngleVector | None = None
    quaternion: Annotated[list[float | int], Field(min_length=4, max_length=4)] | None = None
    matrix: Annotated[list[MatrixRow], Field(min_length=4, max_length=4)] | None = None
    confidence: Fraction01 | None = None
    states: dict[Name, Name] = Field(default={})
    size: SizeVector | None = None
    stamp: Stamp | None = None
    covariance: Covariance | None = None
    perception_args: dict[Name, Text] = Field(default={})
    absent: bool = False


class SceneFile(Model):
    """Objects as they were seen: `profile` and `objects_sha256` say of which registry they are."""

    version: Literal[1]
    profile: Name
    objects_sha256: Digest
    stamp: Stamp | None = None
    objects: dict[Name, SceneObjectModel]
