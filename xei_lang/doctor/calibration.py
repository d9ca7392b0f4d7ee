"""What of the calibration nobody has measured, or measured before something that it hangs on."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import CalibratedFrame, Profile

REPRESENTATION = "calibration_profile"


def calibration_blockers(profile: Profile) -> Iterator[Blocker]:
    """Placeholders, in the order of the file; then measured transforms without a date, or gone stale."""
    for found in profile.calibration.placeholders:
        write_to = f"{CALIBRATION}:{found.item}"
        yield Blocker(
            "XEI0670",
            REPRESENTATION,
            found.item,
            "placeholder",
            "strict",
            found.measure,
            write_to,
            found.span,
        )
    frames = {frame.name: frame for frame in profile.calibration.frames}
    for frame in profile.calibration.frames:
        if frame.status == "measured" and not frame.measured_on:
            yield _again(frame, "undated", "say on which day it was measured, or measure it again")
        elif frame.status == "measured":
            later = _measured_later(frame, frames)
            if later is not None:
                reason = f"`{later.name}`, on which it hangs, was measured on {later.measured_on}"
                yield _again(frame, "stale", f"measure it again: {reason}, after {frame.measured_on}")


def _measured_later(frame: CalibratedFrame, frames: dict[str, CalibratedFrame]) -> CalibratedFrame | None:
    """The nearest frame on the way to the root that was measured after this one; ISO 8601 dates sort as text.

    A transform to a frame that has moved since is worth nothing any more.
    """
    parent = frames.get(frame.parent)
    while parent is not None:
        if parent.status == "measured" and parent.measured_on > frame.measured_on:
            return parent
        parent = frames.get(parent.parent)
    return None


def _again(frame: CalibratedFrame, status: str, measure: str) -> Blocker:
    item = f"frames.{frame.name}"
    write_to = f"{CALIBRATION}:{item}.measured_on"
    return Blocker("XEI0671", REPRESENTATION, item, status, "hardware", measure, write_to, frame.span)
