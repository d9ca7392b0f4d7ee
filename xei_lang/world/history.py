"""What a transform was taken to be before, beside what it is now."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.tolerance import SIGMAS
from xei_lang.profiles.model import CalibratedFrame, EarlierTransform


@dataclass(frozen=True, slots=True)
class Change:
    """How far a transform is from the entry of its history before it, and how far the tolerances of both let
    it be: their bounds' sum, and `SIGMAS` of their standard deviations in quadrature.
    """

    later: CalibratedFrame | EarlierTransform
    earlier: EarlierTransform
    position_m: float
    rotation_rad: float
    position_allowed_m: float
    rotation_allowed_rad: float

    @property
    def is_jump(self) -> bool:
        """Whether two measurements differ by more than both their tolerances: something was moved, or one of
        them is wrong. What nobody had measured may be anywhere.
        """
        if self.later.status != "measured" or self.earlier.status != "measured":
            return False
        return self.position_m > self.position_allowed_m or self.rotation_rad > self.rotation_allowed_rad


def changes(frame: CalibratedFrame) -> Iterator[Change]:
    """The changes of a frame, the newest first."""
    later: CalibratedFrame | EarlierTransform = frame
    for earlier in frame.history:
        apart = earlier.T_parent_frame.inverse() @ later.T_parent_frame
        yield Change(
            later,
            earlier,
            math.hypot(*apart.position_m),
            2.0 * math.acos(min(1.0, abs(apart.quaternion[3]))),
            _allowed(
                (later.position_tolerance_m, later.tolerance_as),
                (earlier.position_tolerance_m, earlier.tolerance_as),
            ),
            _allowed(
                (later.rotation_tolerance_rad, later.tolerance_as),
                (earlier.rotation_tolerance_rad, earlier.tolerance_as),
            ),
        )
        later = earlier


def jump_diagnostic(frame: str, change: Change) -> Diagnostic:
    """What is said of two measurements of a frame that contradict each other (XEI0669)."""
    apart = f"{1e3 * change.position_m:.2f} mm and {math.degrees(change.rotation_rad):.3f} deg"
    allowed = (
        f"{1e3 * change.position_allowed_m:.2f} mm and {math.degrees(change.rotation_allowed_rad):.3f} deg"
    )
    when = f"between {change.earlier.measured_on or 'an earlier day'} and {change.later.measured_on or 'now'}"
    return Diagnostic(
        "XEI0669",
        f"`{frame}` moved by {apart} {when}",
        change.later.span,
        notes=(f"the tolerances of both measurements allow {allowed}",),
        help=("if nobody moved it, look for a loose mount, or measure it once more",),
    )


def _allowed(*stated: tuple[float, str]) -> float:
    bounds = sum(value for value, kind in stated if kind == "bound")
    return bounds + SIGMAS * math.hypot(*(value for value, kind in stated if kind == "std"))
