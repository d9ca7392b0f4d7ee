"""Static transforms of a deployment, how well each is known, and what it was before."""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose
from xei_lang.ir.tolerance import ToleranceKind
from xei_lang.record import Record, record

Status = Literal["measured", "estimated", "placeholder"]


@record
class EarlierTransform(Record):
    """What a transform was taken to be until it was measured anew; it hung on the same parent.

    `residual` says what its measurement left over, as people read it; empty where nobody noted that.
    """

    T_parent_frame: Pose
    status: Status
    measured_on: str
    method: str
    position_tolerance_m: float
    rotation_tolerance_rad: float
    tolerance_as: ToleranceKind
    residual: str
    span: Span


@record
class CalibratedFrame(Record):
    """A static transform of the deployment and how well it is known.

    Its tolerance is a bound or a standard deviation, as `tolerance_as` says. `covariance` (36, or none) is
    that of a small motion on its right, row by row: translation (m) before rotation (rad). `history` begins
    with the newest of its former values.
    """

    name: str
    parent: str
    T_parent_frame: Pose
    status: Status
    measured_on: str
    method: str
    position_tolerance_m: float
    rotation_tolerance_rad: float
    span: Span
    tolerance_as: ToleranceKind = "bound"
    residual: str = ""
    covariance: tuple[float, ...] = ()
    history: tuple[EarlierTransform, ...] = ()
