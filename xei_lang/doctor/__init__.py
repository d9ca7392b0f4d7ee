"""What blocks a real deployment, by representation; the checks that a start makes. One concern a file.

A profile that loads is consistent; this says what it still lacks, for which use, and how to come by it.
"""

from __future__ import annotations

from xei_lang.doctor.blocker import STAGES, Blocker, Stage
from xei_lang.doctor.calibration import calibration_blockers
from xei_lang.doctor.floor import floor_blockers
from xei_lang.doctor.lab import lab_blockers
from xei_lang.doctor.precision import precision_blockers
from xei_lang.doctor.reach import reach_blockers
from xei_lang.doctor.sensors import sensor_blockers
from xei_lang.profiles.model import Profile

__all__ = ["STAGES", "Blocker", "Stage", "deployment_blockers"]


def deployment_blockers(profile: Profile) -> tuple[Blocker, ...]:
    """All that a profile by itself tells, in a fixed order; nothing outside of it is asked."""
    found = (
        *calibration_blockers(profile),
        *lab_blockers(profile),
        *reach_blockers(profile),
        *precision_blockers(profile),
        *floor_blockers(profile),
        *sensor_blockers(profile),
    )
    return tuple(dict.fromkeys(found))
