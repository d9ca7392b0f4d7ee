"""How far a profile is from each use: the table that `xei doctor` and the manifest of a bundle have."""

from __future__ import annotations

from collections.abc import Sequence

from xei_lang.doctor.blocker import STAGES, Blocker, Stage
from xei_lang.record import Record, record


@record
class Readiness(Record):
    """What stands before one use of a profile: all blockers of it and of the milder uses, by representation
    in the order in which they were found.
    """

    stage: Stage
    by_representation: tuple[tuple[str, int], ...]

    @property
    def blockers(self) -> int:
        """How many there are in all."""
        return sum(count for _, count in self.by_representation)


def readiness(blockers: Sequence[Blocker]) -> tuple[Readiness, ...]:
    """One row for each use, from the mildest on."""
    rows: list[Readiness] = []
    for place, stage in enumerate(STAGES):
        standing = [item.representation for item in blockers if STAGES.index(item.blocks) <= place]
        counts = {name: standing.count(name) for name in dict.fromkeys(standing)}
        rows.append(Readiness(stage, tuple(counts.items())))
    return tuple(rows)
