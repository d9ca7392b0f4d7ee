"""Static transforms of calibration_profile.yaml: where frames are, how that is known, what it was before."""

from __future__ import annotations

import math
from datetime import date
from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from xei_lang.profiles.schema.values import (
    AngleVector,
    Distance,
    LengthVector,
    Model,
    Name,
    Status,
    Text,
    Turn,
)


def _day(text: str) -> str:
    try:
        date.fromisoformat(text)
    except ValueError:
        raise ValueError("a day of the calendar, such as `2026-11-20`") from None
    return text


Day = Annotated[str, Field(pattern=r"^[0-9]{4}-[0-9]{2}-[0-9]{2}$"), AfterValidator(_day)]


def _covariance(values: list[float]) -> list[float]:
    rows = [values[6 * k : 6 * k + 6] for k in range(6)]
    largest = max((abs(value) for value in values), default=0.0)
    symmetric = all(
        math.isclose(rows[i][j], rows[j][i], rel_tol=1e-6, abs_tol=1e-9 * largest)
        for i in range(6)
        for j in range(i)
    )
    if not symmetric or any(rows[k][k] < 0.0 for k in range(6)):
        raise ValueError("a symmetric matrix of 6 x 6 numbers, row by row, with variances of zero or above")
    return values


Covariance = Annotated[
    list[float], Field(min_length=36, max_length=36), AfterValidator(_covariance)
]  # m2, m rad, rad2


class Tolerance(Model):
    """How well a transform is known: `bound`s that no error exceeds, or standard deviations (`std`)."""

    position: Distance
    rotation: Turn
    kind: Literal["bound", "std"] = Field(default="bound", alias="as")


class ResidualModel(Model):
    """What a measurement left over: standard deviations of position and rotation, or of corners in pixels."""

    position: Distance | None = None
    rotation: Turn | None = None
    pixel: Annotated[float, Field(ge=0)] | None = None


class TransformModel(Model):
    """Where a frame is, or was taken to be until it was measured anew, and how that is known."""

    position: LengthVector | None = None
    rpy: AngleVector | None = None
    status: Status
    measured_on: Day | None = None
    method: Text
    tolerance: Tolerance
    residual: ResidualModel | None = None
    covariance: Covariance | None = None


class FrameModel(TransformModel):
    """A static transform, and how it is known; `history` begins with the newest of its former values."""

    parent: Name
    history: Annotated[list[TransformModel], Field(max_length=1000)] = Field(default=[])
