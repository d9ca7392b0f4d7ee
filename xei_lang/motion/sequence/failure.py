"""Why a group has no motions: the chain that no candidate serves, or the transit that found no path."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from xei_lang.ir.goals import MotionGoal
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.choose import Array
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.search import Search
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.space import Pair, Touch


@dataclass(frozen=True, slots=True)
class Unplaced:
    """No candidate of a chain holds: `struck` counts the bodies that the checks of whole motions met. `unfit`
    is the held object and what it would itself touch there, with every grasp; `given_up`, that the search has
    ended before all were tried.
    """

    rehearsal: Rehearsal
    struck: tuple[Touch, ...]
    unfit: Pair | None = None
    given_up: bool = False


@dataclass(frozen=True, slots=True)
class BlockedTransit:
    """Candidates hold at both ends, but no path between them was found: the last that was tried is told, from
    `before` to the candidate `index` of its layer.
    """

    goal: MotionGoal
    blocked: PathBlocked
    before: Snapshot
    layer: Layer
    index: int


Failure = Unplaced | BlockedTransit


def unplaced(search: Search, transitions: tuple[Array, ...]) -> Unplaced:
    """The first chain that no run of candidates reaches."""
    reached, failed = np.ones(1, dtype=bool), 0
    for stage, (cost, alive) in enumerate(zip(transitions, search.alive, strict=True)):
        reached, failed = np.isfinite(cost[reached]).any(axis=0) & alive, stage
        if not reached.any():
            break
    return Unplaced(search.rehearsals[failed], tuple(search.struck[failed]))


def given_up(search: Search) -> Unplaced:
    """The chain of which most candidates fell, of those first of which none held."""
    held = {stage for stage, _ in search.sound}
    worst = max(range(len(search.struck)), key=lambda stage: (stage not in held, len(search.struck[stage])))
    return Unplaced(search.rehearsals[worst], tuple(search.struck[worst]), given_up=True)
