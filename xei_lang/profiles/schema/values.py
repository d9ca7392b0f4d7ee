"""The values that profiles share: quantities with a checked dimension, vectors, poses, status."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from xei_lang.quantity import Dimension, Quantity, QuantityError, parse_quantity
from xei_lang.quantity.dimension import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MASS,
    SPEED,
    TORQUE,
    VOLUME,
)

_EXAMPLES = {
    LENGTH: "120 mm",
    ANGLE: "90 deg",
    MASS: "6.5 g",
    VOLUME: "15 mL",
    SPEED: "0.3 m/s",
    FORCE: "10 N",
    ACCELERATION: "0.1 m/s2",
    ANGULAR_SPEED: "2.5 rad/s",
    ANGULAR_ACCELERATION: "10 rad/s2",
    TORQUE: "20 Nm",
}
_PATTERN = r"^[+-]?[0-9]+(\.[0-9]+)?[ \t]*[^\s0-9.]\S*$"


class Model(BaseModel):
    """Every part of a profile: unknown keys are refused, and nothing is converted in silence."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def read_quantity(value: object, example: str) -> Quantity:
    """The quantity of a text; PydanticCustomError, with the way out as `help`, for anything else."""
    if not isinstance(value, str):
        shown = "nothing" if value is None else f"`{value}`"
        raise quantity_error(f"{shown} is not a quantity", f"write a number with a unit, such as `{example}`")
    try:
        return parse_quantity(value)
    except QuantityError as error:
        usual = f"write a number with a unit, such as `{example}`"
        mended = f"write `{error.suggestion}`" if error.suggestion else usual
        raise quantity_error(error.reason, mended) from None


def quantity_error(reason: str, way_out: str) -> PydanticCustomError:
    """A fault of a quantity in our words; `faults.py` makes a diagnostic of it."""
    return PydanticCustomError("quantity", "{reason}", {"reason": reason, "help": way_out})


class Measures:
    """Marks a quantity that is written as text and must measure one of these things; without any, whatever it
    is.
    """

    def __init__(self, *dimensions: Dimension) -> None:
        self.dimensions = dimensions
        self.example = _EXAMPLES[dimensions[0]] if dimensions else "80 mm"

    def read(self, value: object) -> Quantity:
        """The quantity, of a dimension that is wanted."""
        quantity = read_quantity(value, self.example)
        if self.dimensions and quantity.dimension not in self.dimensions:
            wanted = " or ".join(dimension.name for dimension in self.dimensions)
            found = f"`{value}` is a quantity of {quantity.dimension.name}, expected {wanted}"
            raise quantity_error(found, f"write for example `{self.example}`")
        return quantity

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        names = " or ".join(dimension.name for dimension in self.dimensions) or "a quantity"
        return {"type": "string", "pattern": _PATTERN, "description": f"{names}, such as `{self.example}`"}


class OperationParameter:
    """Marks the value of an operation parameter: a quantity where it begins like a number, else a word."""

    def read(self, value: object) -> Quantity | str:
        """The quantity or the word."""
        if isinstance(value, str) and value and not (value[0].isdigit() or value[0] in "+-."):
            return value
        return read_quantity(value, "80 mm")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {"type": "string", "description": "a quantity, such as `80 mm`, or a word"}


Length = Annotated[Quantity, Measures(LENGTH)]
Angle = Annotated[Quantity, Measures(ANGLE)]
Mass = Annotated[Quantity, Measures(MASS)]
Volume = Annotated[Quantity, Measures(VOLUME)]
Speed = Annotated[Quantity, Measures(SPEED)]
AngularSpeed = Annotated[Quantity, Measures(ANGULAR_SPEED)]
JointPosition = Annotated[Quantity, Measures(ANGLE, LENGTH)]
JointVelocity = Annotated[Quantity, Measures(ANGULAR_SPEED, SPEED)]
JointAcceleration = Annotated[Quantity, Measures(ANGULAR_ACCELERATION, ACCELERATION)]
Torque = Annotated[Quantity, Measures(TORQUE)]
Force = Annotated[Quantity, Measures(FORCE)]
AnyQuantity = Annotated[Quantity, Measures()]
OperationValue = Annotated[Quantity | str, OperationParameter()]

Name = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]*$", max_length=80)]
Text = Annotated[str, StringConstraints(min_length=1, max_length=500)]
Count = Annotated[int, Field(ge=1, le=1000)]
Fraction01 = Annotated[float, Field(ge=0.0, le=1.0)]
Status = Literal["measured", "estimated", "placeholder"]
LengthPair = Annotated[list[Length], Field(min_length=2, max_length=2)]
LengthVector = Annotated[list[Length], Field(min_length=3, max_length=3)]
AngleVector = Annotated[list[Angle], Field(min_length=3, max_length=3)]


class Bounds(Model):
    """An axis-aligned box by its two corners."""

    lower: LengthVector
    upper: LengthVector


class Tolerance(Model):
    """Standard deviations of a transform."""

    position: Length
    rotation: Angle
