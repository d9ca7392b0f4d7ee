"""What blocks a real deployment, by representation; the checks that a start makes. One concern a file.

A profile that loads is consistent; this says what it still lacks, for which use, and how to come by it.
"""

from __future__ import annotations

from datetime import date

from xei_lang.diagnostics import Diagnostics
from xei_lang.doctor.blocker import STAGES, Blocker, Stage
from xei_lang.doctor.calibration import calibration_blockers, jump_warnings
from xei_lang.doctor.floor import floor_blockers
from xei_lang.doctor.grounding import grounding_blockers
from xei_lang.doctor.lab import lab_blockers
from xei_lang.doctor.precision import precision_blockers
from xei_lang.doctor.reach import reach_blockers
from xei_lang.doctor.sensors import sensor_blockers
from xei_lang.profiles.model import Profile

__all__ = ["STAGES", "Blocker", "Stage", "deployment_blockers", "deployment_warnings"]


def deployment_blockers(profile: Profile, today: date | None = None) -> tuple[Blocker, ...]:
    """All that a profile by itself tells, in a fixed order; nothing outside of it is asked.

    How old measurements are is only asked where the day is given: a bundle holds no clock.
    """
    found = (
        *calibration_blockers(profile, today),
        *grounding_blockers(profile),
        *lab_blockers(profile),
        *reach_blockers(profile),
        *precision_blockers(profile),
        *floor_blockers(profile),
        *sensor_blockers(profile),
    )
    return tuple(dict.fromkeys(found))


def deployment_warnings(profile: Profile) -> Diagnostics:
    """What stops nothing, and is worth a look before a deployment."""
    return tuple(jump_warnings(profile))
