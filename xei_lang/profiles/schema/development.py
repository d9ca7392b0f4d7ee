"""development_profile.yaml: the skill bank."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, PlainValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from xei_lang.profiles.schema.values import AnyQuantity, Model, Name, OperationValue, Text, _read
from xei_lang.quantity.dimension import TIME

ARG_TYPES = (
    "object", "Place", "Station", "Arm", "Volume", "Length", "Mass", "Time", "Temperature", "TemperatureDifference", "Angle",
    "Speed", "AngularSpeed", "Force", "Acceleration", "Frequency", "Flow", "Amount", "CentrifugalForce", "Concentration",
    "Int", "Float", "Bool", "String", "choice",
)  # fmt: skip


def _duration(value: object) -> tuple[float, float]:
    """`4 s .. 30 s` as seconds."""
    ends = value.split("..") if isinstance(value, str) else []
    if len(ends) != 2:
        context = {"text": str(value), "help": "write the shortest and the longest, such as `4 s .. 30 s`"}
        raise PydanticCustomError("quantity", "`{text}` is not a range of durations", context)
    lower, upper = (_read(end.strip(), "4 s") for end in ends)
    if lower.dimension != TIME or upper.dimension != TIME or lower > upper:
        context = {"text": str(value), "help": "write the shorter time first, such as `4 s .. 30 s`"}
        raise PydanticCustomError("quantity", "`{text}` is not a range of durations", context)
    return lower.si, upper.si


Duration = Annotated[
    tuple[float, float], PlainValidator(_duration), WithJsonSchema({"type": "string", "description": "such as `4 s .. 30 s`"})
]


class ArgModel(Model):
    """An argument of a skill. Without a default it is required."""

    type: Literal[ARG_TYPES]  # type: ignore[valid-type]
    roles: Text | None = None
    places: list[Literal["slot", "spot", "surface"]] = []
    choices: list[Name] = []
    min: AnyQuantity | int | float | None = None
    max: AnyQuantity | int | float | None = None
    default: str | int | float | bool | None = None


class SkillModel(Model):
    """A skill's contract and its template."""

    owner: Name
    summary: Text
    args: dict[Name, ArgModel] = {}
    exposed: bool
    requires: list[Text] = []
    ensures: list[Text] = []
    duration: Duration
    unsupported: list[Text] = []
    process: Text
    phrases: list[Text] = []
    parameters: dict[Name, OperationValue] = {}
    template: list[dict[Name, dict[Name, str | int | float | bool]]] = Field(min_length=1)


class RobotModel(Model):
    """The robot's description files and its parts."""

    urdf: Text
    srdf: Text
    arms: list[Name]
    owners: list[Name]


class DevelopmentProfile(Model):
    """The capability contract: the robot's parts and everything that it has learnt to do."""

    version: Literal[1]
    robot: RobotModel
    skills: dict[Name, SkillModel]
