"""Operation-parameter planners. A new operation is one file with an `Operation`, and one entry in
`OPERATIONS`.
"""

from __future__ import annotations

from xei_lang.lower.operations.base import Aim, Area, Axis, Operation, Planned, Work
from xei_lang.lower.operations.draw import ASPIRATE, DISPENSE
from xei_lang.lower.operations.grasp import GRASP
from xei_lang.lower.operations.handover import GIVE, TAKE
from xei_lang.lower.operations.invert import INVERT, SHAKE
from xei_lang.lower.operations.lift import LIFT
from xei_lang.lower.operations.place import PLACE
from xei_lang.lower.operations.pour import POUR
from xei_lang.lower.operations.steady import STEADY
from xei_lang.lower.operations.tap import SWIPE, TAP
from xei_lang.lower.operations.tip import EJECT, TIP
from xei_lang.lower.operations.twist import CAP, THREAD
from xei_lang.lower.operations.wipe import WIPE

OPERATIONS: tuple[Operation, ...] = (
    GRASP,
    LIFT,
    PLACE,
    POUR,
    TAP,
    SWIPE,
    WIPE,
    INVERT,
    SHAKE,
    GIVE,
    TAKE,
    TIP,
    ASPIRATE,
    DISPENSE,
    EJECT,
    STEADY,
    CAP,
    THREAD,
)


def operation_of_point(point: str) -> Operation | None:
    """The operation that a point such as `pregrasp` belongs to, or None."""
    return next((item for item in OPERATIONS if point in item.points), None)


def operation_of_axis(name: str) -> Operation | None:
    """The operation that an axis such as `pour_lip` belongs to, or None."""
    return next((item for item in OPERATIONS if name in item.axes), None)


def operation_of_area(name: str) -> Operation | None:
    """The operation that an area such as `wipe_area` belongs to, or None."""
    return next((item for item in OPERATIONS if name in item.areas), None)


def operations_of_parameter(name: str) -> tuple[Operation, ...]:
    """The operations that compute a parameter such as `open_width`."""
    return tuple(item for item in OPERATIONS if name in item.parameters)


__all__ = [
    "OPERATIONS",
    "Aim",
    "Area",
    "Axis",
    "Operation",
    "Planned",
    "Work",
    "operation_of_area",
    "operation_of_axis",
    "operation_of_point",
    "operations_of_parameter",
]
