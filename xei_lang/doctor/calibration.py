"""What of the calibration nobody has measured, or measured too long ago, or before something it hangs on."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import date

from xei_lang.diagnostics import Diagnostic, Span
from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.files import CALIBRATION
from xei_lang.profiles.model import CalibratedFrame, Profile
from xei_lang.world.history import changes, jump_diagnostic

REPRESENTATION = "calibration_profile"
_DAY_S = 86400.0


def calibration_blockers(profile: Profile, today: date | None) -> Iterator[Blocker]:
    """Placeholders, in the order of the file; then what is measured without a date, or gone stale.

    Without a `today` nothing is too old.
    """
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
        if frame.status == "measured":
            found = _frame(frame, frames) or _aged(profile, frame.measured_on, today)
            if found is not None:
                yield _again(f"frames.{frame.name}", *found, frame.span)
    named = profile.calibration.map
    if named is not None and named.is_named and named.status == "measured":
        found = _aged(profile, named.measured_on, today) if named.measured_on else _UNDATED
        if found is not None:
            yield _again("map", *found, named.span)


def jump_warnings(profile: Profile) -> Iterator[Diagnostic]:
    """Measurements of a frame that differ from the one before by more than both tolerances."""
    for frame in profile.calibration.frames:
        yield from (jump_diagnostic(frame.name, change) for change in changes(frame) if change.is_jump)


_UNDATED = ("undated", "say on which day it was measured, or measure it again")


def _frame(frame: CalibratedFrame, frames: dict[str, CalibratedFrame]) -> tuple[str, str] | None:
    if not frame.measured_on:
        return _UNDATED
    later = _measured_later(frame, frames)
    if later is None:
        return None
    reason = f"`{later.name}`, on which it hangs, was measured on {later.measured_on}"
    return "stale", f"measure it again: {reason}, after {frame.measured_on}"


def _aged(profile: Profile, measured_on: str, today: date | None) -> tuple[str, str] | None:
    """Whether a measurement is older than the profile lets any be, or of a day that has not come yet."""
    if today is None or not measured_on:
        return None
    age_d = (today - date.fromisoformat(measured_on)).days
    if age_d < 0:
        return "dated ahead", f"correct the date, or this clock: it is {today}, and {measured_on} is to come"
    most_s = profile.calibration.max_age_s
    if most_s is None or age_d * _DAY_S <= most_s:
        return None
    days = f"{age_d} days ago, and `max_age` is {most_s / _DAY_S:g} days"
    return "stale", f"measure it again: {measured_on} is {days}"


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


def _again(item: str, status: str, measure: str, span: Span) -> Blocker:
    write_to = f"{CALIBRATION}:{item}.measured_on"
    return Blocker("XEI0671", REPRESENTATION, item, status, "hardware", measure, write_to, span)
