"""development_profile.yaml: the skill bank."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag
from pydantic_core import CoreSchema, core_schema

from xei_lang.profiles.schema.values import (
    AnyQuantity,
    Fraction01,
    Model,
    Name,
    OperationValue,
    Text,
    quantity_error,
    read_quantity,
)
from xei_lang.quantity.dimension import TIME

QuantityType = Literal[
    "Volume",
    "Length",
    "Mass",
    "Time",
    "Temperature",
    "TemperatureDifference",
    "Angle",
    "Speed",
    "AngularSpeed",
    "Force",
    "Acceleration",
    "Frequency",
    "Flow",
    "Amount",
    "CentrifugalForce",
    "Concentration",
]
ReturnType = Literal[QuantityType, "Int", "Float"]
ArgType = Literal[
    "object", "Place", "Pose", "Station", "Arm", QuantityType, "Int", "Float", "Bool", "String", "choice"
]


class DurationRange:
    """Marks the shortest and the longest time that something takes: `4 s .. 30 s`, in seconds."""

    def read(self, value: object) -> tuple[float, float]:
        """Both ends in seconds."""
        ends = value.split("..") if isinstance(value, str) else []
        if len(ends) == 2:
            lower, upper = (read_quantity(end.strip(), "4 s") for end in ends)
            if lower.dimension == upper.dimension == TIME and 0 <= lower.value <= upper.value:
                return lower.si, upper.si
        way_out = "write the shorter time first, such as `4 s .. 30 s`"
        raise quantity_error(f"`{value}` is not a range of durations", way_out)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {"type": "string", "description": "shortest and longest time, such as `4 s .. 30 s`"}


Duration = Annotated[tuple[float, float], DurationRange()]


class ArgModel(Model):
    """An argument of a skill. Without a default it is required."""

    type: ArgType
    roles: Text | None = None
    places: list[Literal["slot", "spot", "surface"]] = Field(default=[])
    choices: list[Name] = Field(default=[])
    min: AnyQuantity | int | float | None = None
    max: AnyQuantity | int | float | None = None
    default: str | int | float | bool | None = None


class ReturnModel(Model):
    """What a skill that measures gives back; bounds where the instrument has them."""

    type: ReturnType
    min: AnyQuantity | int | float | None = None
    max: AnyQuantity | int | float | None = None


Fields = dict[Name, Text | int | float | bool]
GoalLine = dict[Name, Fields]
"""One key, the kind of goal, and the fields of it."""


class RepeatModel(Model):
    """Lines of a template that are gone through `times` times: a number, or the name of one."""

    times: int | Name
    do: list[GoalLine] = Field(min_length=1)


class RepeatLine(Model):
    """A line of a template that stands for several."""

    repeat: RepeatModel


def _sort_of_line(line: object) -> str:
    return "repeated" if isinstance(line, dict) and "repeat" in line else "goal"


Line = Annotated[
    Annotated[RepeatLine, Tag("repeated")] | Annotated[GoalLine, Tag("goal")], Discriminator(_sort_of_line)
]


class SkillModel(Model):
    """A skill's contract and its template. `min_confidence` is how surely it must be known where its objects
    are.
    """

    owner: Name
    summary: Text
    args: dict[Name, ArgModel] = Field(default={})
    exposed: bool
    returns: ReturnModel | None = None
    occupies: list[Name] = Field(default=[])
    touchable: bool = False
    min_confidence: Fraction01 | None = None
    requires: list[Text] = Field(default=[])
    ensures: list[Text] = Field(default=[])
    duration: Duration
    unsupported: list[Text] = Field(default=[])
    process: Text
    phrases: list[Text] = Field(default=[])
    parameters: dict[Name, OperationValue] = Field(default={})
    template: list[Line] = Field(min_length=1)


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
