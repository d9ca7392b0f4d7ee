"""The map: whether it is there and the recorded one, and what of the deployment it speaks against."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground

REPRESENTATION = "calibration_profile"


def floor_blockers(profile: Profile) -> Iterator[Blocker]:
    """What is wrong with the map, stations that do not stand on free floor, drives without a way.

    A profile without a map has a placeholder there, which is told with the others.
    """
    named = profile.calibration.map
    world = ground(profile)[0] if named is not None and named.is_named else None
    if world is None:
        return
    from xei_lang.world.map.deployed import look_at_map

    for fault in look_at_map(profile, world).faults:
        first = fault.diagnostics[0]
        yield Blocker(
            first.code,
            REPRESENTATION,
            fault.item,
            fault.status,
            "hardware",
            fault.measure,
            fault.write_to,
            first.span,
        )
