"""Meshes and point clouds of objects, and shapes that are taken from them."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from xei_lang.profiles.schema.values import AngleVector, LengthVector, Model, Text

Units = Literal["m", "mm", "cm", "in"]


class PlacementModel(Model):
    """Where a file's frame is in the object's frame."""

    position: LengthVector | None = None
    rpy: AngleVector | None = None


class FileModel(Model):
    """A file of the profile's folder; a text alone is its path. `units` are those of its numbers."""

    file: Text
    units: Units | None = None

    @model_validator(mode="before")
    @classmethod
    def _path_alone(cls, value: object) -> object:
        return {"file": value} if isinstance(value, str) else value

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        made = handler.resolve_ref_schema(handler(schema))
        return {"anyOf": [{"type": "string", "minLength": 1, "maxLength": 500}, made]}


class MeshFileModel(FileModel):
    """A mesh: STL, OBJ or PLY. `T_object_mesh` places it in the object's frame, after its unit."""

    T_object_mesh: PlacementModel | None = None


class CloudFileModel(FileModel):
    """A point cloud: PLY, PCD or XYZ. `T_object_cloud` places it in the object's frame, after its unit."""

    T_object_cloud: PlacementModel | None = None


class MeshShapeModel(MeshFileModel):
    """A shape around a mesh: of the kind that is said in `as`, or else the one of the least volume."""

    as_: Literal["box", "cylinder"] | None = Field(default=None, alias="as")


class CloudShapeModel(CloudFileModel):
    """A shape around a point cloud: of the kind that is said in `as`, or else that of the least volume."""

    as_: Literal["box", "cylinder"] | None = Field(default=None, alias="as")


class AssetsModel(Model):
    """Files of an object; null is a gap that the startup checks list."""

    mesh: MeshFileModel | None = None
    point_cloud: CloudFileModel | None = None
