"""What a backend of the pose service is: one call from a decoded picture to poses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.geometry import Pose
from xei_lang.world.perception.optics import Array, Optics
from xei_lang.world.perception.pose_request import Matrix, Mode, PoseRequest, PoseStatus
from xei_lang.world.perception.registry import RegisteredObject, Registry


@dataclass(frozen=True, slots=True, eq=False)
class Shot:
    """A request with its pictures decoded.

    `image` is (h, w) or (h, w, 3), BGR, of 8 bits; `depth_m` (h, w) has NaN where nothing is known; `masks`
    has the mask of each object that has one, given or proposed; `known` are the objects of the queries as the
    registry has them.
    """

    request: PoseRequest
    optics: Optics
    image: NDArray[np.uint8]
    depth_m: Array
    masks: Mapping[str, NDArray[np.bool_]]
    known: tuple[RegisteredObject, ...] = ()


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a backend says of one object: a matrix by rows in the request's output frame where `status` is
    `ok`, and the covariance of a small motion in the object's own axes, translation (m) first.
    """

    name: str
    status: PoseStatus
    T_output_object: Matrix | None = None
    confidence: float = 0.0
    covariance: Matrix | None = None


@dataclass(frozen=True, slots=True)
class Unable:
    """A backend that cannot answer at all: the HTTP status to pass on, and why."""

    status: int
    message: str


class Backend(Protocol):
    """A way of finding objects in pictures. Calls come one at a time."""

    @property
    def name(self) -> str:
        """As `--backend` has it."""
        ...

    @property
    def version(self) -> str:
        """What goes into every answer as its `model_version`."""
        ...

    @property
    def modes(self) -> tuple[Mode, ...]:
        """The modes of a query that it has."""
        ...

    @property
    def needs_masks(self) -> bool:
        """Whether masks are to be proposed for it where none are given."""
        ...

    def ready(self, registry: Registry) -> str | None:
        """None where it can be asked for the objects of this registry, else why not."""
        ...

    def put(self, item: RegisteredObject) -> Unable | None:
        """Know an object so from now on."""
        ...

    def estimate(self, shot: Shot) -> tuple[Estimate, ...] | Unable:
        """One estimate for each query of the shot, in their order."""
        ...


def rows_of(pose: Pose) -> Matrix:
    """The matrix of a pose by rows."""
    return pose.matrix()
