"""What a search among candidates costs: travel between chains, and what has been found to be in the way."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.choose import Bools, Speeds, Stage
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.parting import Parting
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.space import Touch
from xei_lang.motion.sequence.transit import keeps_upright

Array = NDArray[np.float64]

BLOCKED_S = 1.0
"""What is added to transits that are like one that found no path."""
OTHER_BRANCH_S = 3.0
"""What a change of branch is taken to cost where the hand must stay upright: a singular posture lies between.
"""


@dataclass(slots=True)
class Search:
    """The state of one search: what still holds, and what has been found out."""

    own: int
    rehearsals: tuple[Rehearsal, ...]
    layers: tuple[Layer, ...]
    alive: list[Bools]
    struck: list[list[Touch]]
    parting: Parting | None = None
    transits: dict[tuple[int, ...], Motion | PathBlocked] = field(
        default_factory=dict[tuple[int, ...], Motion | PathBlocked]
    )
    sound: set[tuple[int, int]] = field(default_factory=set[tuple[int, int]])
    met: set[tuple[int, int]] = field(default_factory=set[tuple[int, int]])
    glanced: dict[int, set[tuple[int, int]]] = field(default_factory=dict[int, set[tuple[int, int]]])

    @property
    def strikes(self) -> int:
        """How many candidates fell by their whole motions."""
        return sum(len(touches) for touches in self.struck)


def stages_of(now: Array, search: Search, homeward: Array) -> tuple[Stage, ...]:
    """Where the arm is now (8,), and each chain as the dynamic programme sees it; `homeward` (n,) is added to
    the group's last one.
    """
    first = Stage(now[None], now[None], np.zeros(1), np.ones(1, dtype=bool))
    stages = [layer.stage(alive) for layer, alive in zip(search.layers, search.alive, strict=True)]
    last = stages[search.own - 1]
    stages[search.own - 1] = replace(last, cost=last.cost + homeward)
    return (first, *stages)


def travel(context: Context, now: Array, search: Search, speeds: Speeds) -> tuple[Array, ...]:
    """Travel times between the group's stages; into a chain that is only looked ahead to, whether it may
    follow at all.
    """
    stages = stages_of(now, search, np.zeros(1))
    costs: list[Array] = []
    for index, mask in enumerate((None, *_joined(search))):
        before, after = stages[index], stages[index + 1]
        if index < search.own:
            cost = speeds.travel_s(before.exit, after.entry)
        else:
            cost = np.zeros((len(before.cost), len(after.cost)))
        cost = cost + _branch_s(context, now, search, index)
        costs.append(cost if mask is None else np.where(mask, cost, np.inf))
    return tuple(costs)


def _branch_s(context: Context, now: Array, search: Search, stage: int) -> Array:
    """What the change of branch into each candidate of a stage adds, where the hand must stay upright."""
    rehearsal, after = search.rehearsals[stage], search.layers[stage].branch
    if not keeps_upright(rehearsal):
        return np.zeros((1, len(after)))
    solver = context.solvers[rehearsal.chain.arm]
    before = search.layers[stage - 1].branch if stage else np.array([solver.describe(now[1:])[1]])
    return OTHER_BRANCH_S * (before[:, None] != after[None, :])


def avoid(search: Search, stage: int, run: tuple[int, ...], costs: Array) -> None:
    """Strike a transit that found no path out, and make those like it dear: same grasps, branches and slide
    heights.
    """
    pair = run[stage], run[stage + 1]
    first = search.layers[stage - 1].like(pair[0]) if stage else np.ones(1, dtype=bool)
    costs[np.ix_(first, search.layers[stage].like(pair[1]))] += BLOCKED_S
    costs[pair] = np.inf


def _joined(search: Search) -> tuple[Bools | None, ...]:
    """Which candidate may follow which: while an object is held, only those of the same grasp."""
    masks: list[Bools | None] = []
    for before, after, rehearsal in zip(
        search.layers, search.layers[1:], search.rehearsals[1:], strict=False
    ):
        chain = rehearsal.chain
        if chain.arm not in rehearsal.before.held:
            masks.append(None)
        elif chain.turns:
            masks.append(before.orbit[:, None] == after.orbit[None, :])
        else:
            masks.append(before.member[:, None] == after.member[None, :])
    return tuple(masks)
