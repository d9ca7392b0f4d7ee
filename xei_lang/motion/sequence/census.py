"""Why each grasp of a chain fell, counted: made only once a search has failed, so that the message can say
it.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics import Solver
from xei_lang.motion.sequence.candidates import THOROUGH
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import Unplaced
from xei_lang.motion.sequence.postures import feasible, on_line
from xei_lang.motion.sequence.reach import chain_poses, tried_heights
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.space import target_contact

Array = NDArray[np.float64]

_CONFIGURATIONS_ASKED = 12
_OFF_LINE, _UNTAKEN = "off line", "untaken"  # no bodies: names have no space


@dataclass(frozen=True, slots=True)
class Census:
    """How many of a chain's grasps fell for which reason; `bodies` are what those in reach touch, most often
    first.

    Each grasp is counted once, by how far it came: reach, joint limits, contact, straight line. `neighbours`
    are the movable objects among the bodies that stand by themselves.
    """

    total: int
    out_of_reach: int
    past_limits: int
    bodies: tuple[tuple[str, int], ...]
    off_line: int
    untaken: int
    neighbours: tuple[str, ...]

    @property
    def within_limits(self) -> int:
        """How many grasps some posture of the arm reaches."""
        return self.total - self.out_of_reach - self.past_limits


def take_census(context: Context, failure: Unplaced) -> Census:
    """Go through all grasps of the chain that failed."""
    rehearsal = failure.rehearsal
    chain, poses, heights = rehearsal.chain, chain_poses(rehearsal), tried_heights(context, rehearsal)
    members = np.arange(len(chain.family.members), dtype=np.intp)
    solver = context.solvers[chain.arm]
    rows = feasible(solver, poses, members, heights, THOROUGH.configurations_per_pose, chain.legs)
    reached = set(rows.member.tolist())
    far = [
        member
        for member in members.tolist()
        if member not in reached and _out_of_reach(solver, poses[:, member], heights)
    ]
    touched: Counter[str] = Counter()
    for member in sorted(reached):
        own = rows.kept(np.flatnonzero(rows.member == member))
        name = _touched(context, failure, own.q, member)
        if not name:
            fell = any(touch.member == member for touch in failure.struck)
            straight = len(on_line(solver, poses, own, chain.legs)) > 0 and not fell
            name = _UNTAKEN if straight else _OFF_LINE
        touched[name] += 1
    off_line, untaken = touched.pop(_OFF_LINE, 0), touched.pop(_UNTAKEN, 0)
    bodies = tuple(sorted(touched.items(), key=lambda item: (-item[1], item[0])))
    riding = rehearsal.before.riding
    neighbours = tuple(
        name
        for name, _ in bodies
        if name not in riding and (item := context.world.find(name)) is not None and item.movable
    )
    return Census(
        len(members), len(far), len(members) - len(reached) - len(far), bodies, off_line, untaken, neighbours
    )


def _out_of_reach(solver: Solver, poses: Array, heights: Array) -> bool:
    """Whether at every height (h,) one of the tool poses (targets, 4, 4) is too far or too near."""
    return all(
        any(solver.reach_shortfall(pose, height) > 0.0 for pose in poses) for height in heights.tolist()
    )


def _touched(context: Context, failure: Unplaced, q: Array, member: int) -> str:
    """The body that a member's configurations (n, targets, 8) meet most often; empty where they meet none."""
    rehearsal, names = failure.rehearsal, Counter[str]()
    picked = np.linspace(0, len(q) - 1, min(len(q), _CONFIGURATIONS_ASKED)).round().astype(int)
    for row in picked:
        pair = target_contact(context, rehearsal, q[row])
        if pair is not None:
            names[culprit(context, rehearsal, pair)] += 1
    for touch in failure.struck:
        if touch.member == member and touch.bodies is not None:
            names[culprit(context, rehearsal, touch.bodies)] += 1
    return min(names, key=lambda name: (-names[name], name)) if names else ""


def culprit(context: Context, rehearsal: Rehearsal, pair: tuple[str, str]) -> str:
    """Of two bodies that touch, the one to name: another object rather than what is handled, an object rather
    than a link.
    """
    chain = rehearsal.chain
    handled = {action.object for action in (chain.attach, chain.detach) if action is not None}
    riders = {rider for name in handled for rider, _ in rehearsal.before.riders(name)}
    own = handled | riders
    objects = [name for name in pair if context.world.find(name) is not None and name not in own]
    if objects:
        return objects[0]
    return next(
        (name for name in pair if name not in own and not name.startswith(f"openarm_{chain.arm}")), pair[1]
    )
