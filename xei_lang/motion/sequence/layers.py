"""The candidates of one chain, side by side, and what each of them costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.sequence.choose import Bools, Stage
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.poses import Ints, orbits
from xei_lang.motion.sequence.postures import Rows
from xei_lang.motion.sequence.sections import Chain

Array = NDArray[np.float64]

_COMFORT_RAD = 0.2
_COMFORT_COST_S = 0.5


@dataclass(frozen=True, slots=True)
class Layer:
    """Candidates (n,) of a chain. `q` (n, targets, 8) is slide and arm at each tool target, within limits.

    `poses` (targets, members, 4, 4) are the tool poses; `member` is the one shown at this chain and `orbit`
    names members that are turns of each other. `swivel_angle` (n, targets) changes over stated paths only,
    at a constant rate. `cost` is in seconds.
    """

    chain: Chain
    poses: Array
    q: Array
    member: Ints
    orbit: Ints
    swivel_angle: Array
    branch: Ints
    cost: Array

    def __len__(self) -> int:
        return len(self.member)

    def like(self, index: int) -> Bools:
        """Candidates (n,) of the same grasp, branch and slide height as one of them."""
        same = (self.member == self.member[index]) & (self.branch == self.branch[index])
        return same & (self.q[:, 0, 0] == self.q[index, 0, 0])

    def stage(self, alive: Bools) -> Stage:
        """The layer as the dynamic programme sees it, with the candidates that still hold."""
        return Stage(self.q[:, 0], self.q[:, -1], self.cost, alive)


def layer_of(context: Context, chain: Chain, poses: Array, rows: Rows) -> Layer:
    """The candidates that configurations make, with their costs."""
    limits = context.limits_of(context.robot.arm(chain.arm).joint_names)
    lower, upper = (np.array([getattr(limit, name) for limit in limits]) for name in ("lower", "upper"))
    arm = rows.q[:, :, 1:]
    margin = np.minimum(arm - lower, upper - arm).min(axis=(1, 2), initial=np.inf)
    discomfort = np.clip(1.0 - margin / _COMFORT_RAD, 0.0, 1.0)
    member_cost = np.array([member.cost for member in chain.family.members])
    cost = member_cost[rows.member] + _COMFORT_COST_S * discomfort + _straight_s(context, chain, rows)
    orbit = orbits(chain.family)[rows.member] if len(rows.member) else rows.member
    return Layer(chain, poses, rows.q, rows.member, orbit, rows.swivel_angle, rows.branch, cost)


def _straight_s(context: Context, chain: Chain, rows: Rows) -> Array:
    """Lower bound (n,) of the time that the straight moves between a chain's targets take, seconds."""
    speeds = context.speeds(context.arm_joints(chain.arm))
    distance = np.abs(np.diff(rows.q, axis=1))
    total = np.zeros(len(rows))
    for index, fraction in enumerate(chain.speed_fractions[1:]):
        total += speeds.scaled(fraction).of_distance(distance[:, index])
    return total
