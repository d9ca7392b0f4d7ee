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
    TIME,
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
    TIME: "90 d",
}
_PATTERN = r"^[+-]?[0-9]+(\.[0-9]+)?[ \t]*[^\s0-9.]\S*$"


Sign = Literal["any", "not negative", "above zero"]
_SIGNS = {"any": "", "not negative": "of zero or above", "above zero": "above zero"}
_MEASURE = "measure it, and write what it is"


class Model(BaseModel):
    """Every part of a profile: unknown keys are refused, and nothing is converted in silence."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


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
    is. `sign` says which values have a meaning.
    """

    def __init__(self, *dimensions: Dimension, sign: Sign = "any") -> None:
        self.dimensions = dimensions
        self.sign = sign
        self.example = _EXAMPLES[dimensions[0]] if dimensions else "80 mm"

    def read(self, value: object) -> Quantity:
        """The quantity, of a dimension that is wanted."""
        quantity = read_quantity(value, self.example)
        if self.dimensions and quantity.dimension not in self.dimensions:
            wanted = " or ".join(dimension.name for dimension in self.dimensions)
            found = f"`{value}` is a quantity of {quantity.dimension.name}, expected {wanted}"
            raise quantity_error(found, f"write for example `{self.example}`")
        if (self.sign == "above zero" and quantity.value <= 0) or (self.sign != "any" and quantity.value < 0):
            raise quantity_error(f"`{value}` is out of range, expected a value {_SIGNS[self.sign]}", _MEASURE)
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
Size = Annotated[Quantity, Measures(LENGTH, sign="above zero")]
Distance = Annotated[Quantity, Measures(LENGTH, sign="not negative")]
Angle = Annotated[Quantity, Measures(ANGLE)]
Turn = Annotated[Quantity, Measures(ANGLE, sign="not negative")]
Mass = Annotated[Quantity, Measures(MASS, sign="above zero")]
Volume = Annotated[Quantity, Measures(VOLUME, sign="above zero")]
Speed = Annotated[Quantity, Measures(SPEED, sign="above zero")]
AngularSpeed = Annotated[Quantity, Measures(ANGULAR_SPEED, sign="above zero")]
JointPosition = Annotated[Quantity, Measures(ANGLE, LENGTH)]
JointVelocity = Annotated[Quantity, Measures(ANGULAR_SPEED, SPEED, sign="above zero")]
JointAcceleration = Annotated[Quantity, Measures(ANGULAR_ACCELERATION, ACCELERATION, sign="above zero")]
Torque = Annotated[Quantity, Measures(TORQUE, sign="above zero")]
Force = Annotated[Quantity, Measures(FORCE, sign="above zero")]
Age = Annotated[Quantity, Measures(TIME, sign="above zero")]
AnyQuantity = Annotated[Quantity, Measures()]
OperationValue = Annotated[Quantity | str, OperationParameter()]

Name = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]*$", max_length=80)]
RowName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z]{1,4}$")]
Text = Annotated[str, StringConstraints(min_length=1, max_length=500)]
Count = Annotated[int, Field(ge=1, le=1000)]
Fraction01 = Annotated[float, Field(ge=0.0, le=1.0)]
Status = Literal["measured", "estimated", "placeholder"]
LengthPair = Annotated[list[Length], Field(min_length=2, max_length=2)]
SizePair = Annotated[list[Size], Field(min_length=2, max_length=2)]
SizeVector = Annotated[list[Size], Field(min_length=3, max_length=3)]
LengthVector = Annotated[list[Length], Field(min_length=3, max_length=3)]
AngleVector = Annotated[list[Angle], Field(min_length=3, max_length=3)]


class Bounds(Model):
    """An axis-aligned box by its two corners."""

    lower: LengthVector
    upper: LengthVector
