"""The values that profiles share: quantities with a checked dimension, vectors, poses, status."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PlainValidator, StringConstraints, WithJsonSchema
from pydantic_core import PydanticCustomError

from xei_lang.quantity import Quantity, QuantityError, parse_quantity
from xei_lang.quantity.dimension import (
    ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, FORCE, LENGTH, MASS, SPEED, TIME, TORQUE, VOLUME, Dimension,
)  # fmt: skip

_EXAMPLES = {
    LENGTH: "120 mm", ANGLE: "90 deg", MASS: "6.5 g", VOLUME: "15 mL", TIME: "4 s", SPEED: "0.3 m/s", FORCE: "10 N",
    ACCELERATION: "0.1 m/s2", ANGULAR_SPEED: "2.5 rad/s", ANGULAR_ACCELERATION: "10 rad/s2", TORQUE: "20 Nm",
}  # fmt: skip


class Model(BaseModel):
    """Every part of a profile: unknown keys are refused, and nothing is converted in silence."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def _read(value: object, example: str) -> Quantity:
    if not isinstance(value, str):
        shown = "nothing" if value is None else f"`{value}`"
        raise PydanticCustomError(
            "quantity", "{shown} is not a quantity", {"shown": shown, "help": f"write a number with a unit, such as `{example}`"}
        )
    try:
        return parse_quantity(value)
    except QuantityError as error:
        mended = f"write `{error.suggestion}`" if error.suggestion else f"write a number with a unit, such as `{example}`"
        raise PydanticCustomError("quantity", "{reason}", {"reason": error.reason, "help": mended}) from None


def quantity_type(*dimensions: Dimension) -> Any:
    """The type of a text that must be a quantity of one of these dimensions."""
    example = _EXAMPLES[dimensions[0]]
    names = " or ".join(dimension.name for dimension in dimensions)

    def validate(value: object) -> Quantity:
        quantity = _read(value, example)
        if quantity.dimension not in dimensions:
            context = {"text": str(value), "found": quantity.dimension.name, "wanted": names, "help": f"write for example `{example}`"}
            raise PydanticCustomError("quantity", "`{text}` is a quantity of {found}, expected {wanted}", context)
        return quantity

    schema = {"type": "string", "description": f"{names}, such as `{example}`", "pattern": r"^[+-]?[0-9]+(\.[0-9]+)?\s*\S+$"}
    return Annotated[Any, PlainValidator(validate), WithJsonSchema(schema)]


def _any_quantity(value: object) -> Quantity:
    return _read(value, "80 mm")


def _parameter(value: object) -> Quantity | str:
    """An operation parameter: a quantity where it begins like a number, else a word."""
    if isinstance(value, str) and value and not (value[0].isdigit() or value[0] in "+-."):
        return value
    return _any_quantity(value)


Length = quantity_type(LENGTH)
Angle = quantity_type(ANGLE)
Mass = quantity_type(MASS)
Volume = quantity_type(VOLUME)
Speed = quantity_type(SPEED)
AngularSpeed = quantity_type(ANGULAR_SPEED)
JointPosition = quantity_type(ANGLE, LENGTH)
JointVelocity = quantity_type(ANGULAR_SPEED, SPEED)
JointAcceleration = quantity_type(ANGULAR_ACCELERATION, ACCELERATION)
Torque = quantity_type(TORQUE)
Force = quantity_type(FORCE)
AnyQuantity = Annotated[Any, PlainValidator(_any_quantity), WithJsonSchema({"type": "string", "description": "a quantity"})]
OperationValue = Annotated[
    Any, PlainValidator(_parameter), WithJsonSchema({"type": "string", "description": "a quantity, or a word"})
]

Name = Annotated[str, StringConstraints(pattern=r"^[a-z][a-z0-9_]*$", max_length=80)]
Text = Annotated[str, StringConstraints(min_length=1, max_length=500)]
Count = Annotated[int, Field(ge=1, le=1000)]
Fraction01 = Annotated[float, Field(ge=0.0, le=1.0)]
Status = Literal["measured", "estimated", "placeholder"]


def _vector(of: Any) -> Any:
    """Three quantities, written as a list."""
    return Annotated[list[of], Field(min_length=3, max_length=3)]


LengthVector = _vector(Length)
AngleVector = _vector(Angle)


class Bounds(Model):
    """An axis-aligned box by its two corners."""

    lower: LengthVector
    upper: LengthVector


class Tolerance(Model):
    """Standard deviations of a transform."""

    position: Length
    rotation: Angle
