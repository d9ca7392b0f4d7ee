"""How an arm reaches the tool poses of a chain: slide height, swivel angle and branch, carried from the grasp
through all targets.

Postures are looked for at one target alone, and the others follow from it: over straight moves swivel and
branch stay, over stated paths the swivel turns. Nothing here knows of the scene.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics import Solver
from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.legs import Leg, follow
from xei_lang.motion.sequence.poses import Ints

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Rows:
    """Configurations of a chain: `q` (n, targets, 8), swivel angles (n, targets), and member and branch (n,)
    of each.
    """

    q: Array
    member: Ints
    swivel_angle: Array
    branch: Ints

    def __len__(self) -> int:
        return len(self.member)

    def kept(self, index: NDArray[np.intp]) -> Rows:
        """Only the rows of these indices."""
        return Rows(self.q[index], self.member[index], self.swivel_angle[index], self.branch[index])


def none_of(targets: int) -> Rows:
    """No rows."""
    empty = np.zeros(0, dtype=np.int64)
    return Rows(np.zeros((0, targets, 8)), empty, np.zeros((0, targets)), empty)


def joined(parts: list[Rows]) -> Rows:
    """The rows of all parts, in their order."""
    return Rows(
        np.concatenate([part.q for part in parts]),
        np.concatenate([part.member for part in parts]),
        np.concatenate([part.swivel_angle for part in parts]),
        np.concatenate([part.branch for part in parts]),
    )


def feasible(
    solver: Solver,
    poses: Array,
    members: NDArray[np.intp],
    heights: Array,
    most: int,
    legs: tuple[Leg | None, ...] = (),
) -> Rows:
    """At most `most` configurations of each member and height at the grasp itself, as far as the same branch
    serves at all targets, and along the stated paths between them; `poses` (targets, members, 4, 4). The
    swivel changes over stated paths only. Contacts are not looked at.
    """
    key, targets = key_target(legs, len(poses)), len(poses)
    pair_member = np.tile(members, len(heights)).astype(np.int64)
    pair_height = np.repeat(heights, len(members))
    solutions = solver.solve_many(poses[key, pair_member], pair_height)
    picks = [_spread(len(item), most) for item in solutions]
    pair = np.repeat(np.arange(len(solutions)), [len(pick) for pick in picks])
    swivel = np.concatenate([item.swivel_angle[pick] for item, pick in zip(solutions, picks, strict=True)])
    branch = np.concatenate([item.branch[pick] for item, pick in zip(solutions, picks, strict=True)])
    member, height = pair_member[pair], pair_height[pair]
    angles = np.repeat(swivel[:, None], targets, axis=1)
    kept = np.arange(len(member))
    for target, leg in enumerate(legs):
        if leg is None:
            angles[:, target + 1] = angles[:, target]
            continue
        ends, good = follow(
            solver, leg, poses[target, member[kept]], height[kept], angles[kept, target], branch[kept]
        )
        angles[kept, target + 1] = ends
        kept = kept[good]
    member, height, branch, angles = member[kept], height[kept], branch[kept], angles[kept]
    q, valid = carried(solver, poses[:, member].swapaxes(0, 1), height, angles, branch)
    return Rows(q, member, angles, branch).kept(np.flatnonzero(valid.all(axis=1)))


def on_line(solver: Solver, poses: Array, rows: Rows, legs: tuple[Leg | None, ...]) -> Rows:
    """The rows that keep their limits half way along the straight moves as well, for tool poses (targets,
    members, 4, 4).
    """
    for target, leg in enumerate(legs):
        if leg is not None or len(rows) == 0:
            continue
        ends = poses[target : target + 2, rows.member]
        half = ends[0].copy()
        half[:, :3, 3] = (ends[0, :, :3, 3] + ends[1, :, :3, 3]) / 2
        _, valid = carried(
            solver, half[:, None], rows.q[:, 0, 0], rows.swivel_angle[:, target : target + 1], rows.branch
        )
        rows = rows.kept(np.flatnonzero(valid[:, 0]))
    return rows


def key_target(legs: tuple[Leg | None, ...], targets: int) -> int:
    """The target at which configurations are looked for: the second, where a hand closes or opens, if a
    straight move leads there.
    """
    stated = next((index for index, leg in enumerate(legs) if leg is not None), targets)
    return min(1, stated, targets - 1)


def _spread(count: int, most: int) -> NDArray[np.intp]:
    """At most `most` of a pose's configurations, evenly over branches and swivel angles."""
    return np.linspace(0, count - 1, min(count, most)).round().astype(np.intp)


def carried(solver: Solver, poses: Array, height: Array, swivel: Array, branch: Ints) -> tuple[Array, Bools]:
    """Slide and arm (n, t, 8) at poses (n, t, 4, 4) with swivel angles (n, t), and one height and branch (n,)
    a row; a mask (n, t) of what is valid.
    """
    rows, targets = poses.shape[:2]
    q = np.zeros((rows, targets, 8))
    q[:, :, 0] = height[:, None]
    valid = np.zeros((rows, targets), dtype=bool)
    for code in np.unique(branch):
        index = np.flatnonzero(branch == code)
        arm, good = solver.at_many(
            poses[index].reshape(-1, 4, 4),
            np.repeat(height[index], targets),
            swivel[index].reshape(-1),
            int(code),
        )
        q[index, :, 1:] = arm.reshape(len(index), targets, 7)
        valid[index] = good.reshape(len(index), targets)
    return q, valid
