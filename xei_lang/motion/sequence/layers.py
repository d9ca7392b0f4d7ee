"""Candidates of one chain: grasp, slide height, swivel and branch, with the arm's configuration at every
target.

Grasps are tried best first, a round of them at all slide heights at once, until each height has enough: a
plain scene costs little, a crowded one is searched to the end.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.motion.kinematics import Solver
from xei_lang.motion.sequence.choose import Bools, Stage
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.legs import Leg, follow
from xei_lang.motion.sequence.poses import Ints, orbits, tool_poses
from xei_lang.motion.sequence.sections import Chain

Array = NDArray[np.float64]
CheckTarget = Callable[[int, Array], Bools]
"""For the index of a target and configurations (n, 8) of slide and arm: which of them touch something (n,).
"""

MEMBERS_PER_ROUND = 16

_COMFORT_RAD = 0.2
_COMFORT_COST_S = 0.5
_FACING_COST = 1.0


@dataclass(frozen=True, slots=True)
class Effort:
    """How widely to look: slide heights, grasps wanted at each, configurations of each grasp, and how many
    blocked transits are put up with. `exhaustive` leaves out at once what could only fall later.
    """

    heights: int
    poses_per_height: int
    configurations_per_pose: int
    blocked_transits: int
    exhaustive: bool = False


LEAN = Effort(5, 8, 5, 3)
THOROUGH = Effort(13, 10_000, 20, 1, exhaustive=True)


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


def slide_heights(context: Context, slide_m: float, effort: Effort) -> Array:
    """Heights to try in metres: the present one first, then the others of a grid over the stroke, nearest
    first.
    """
    limits = context.slide_limits
    grid = np.linspace(limits.lower, limits.upper, effort.heights)
    others = grid[np.abs(grid - slide_m) > 0.25 * (grid[1] - grid[0])]
    return np.concatenate([[slide_m], others[np.argsort(np.abs(others - slide_m), kind="stable")]])


def enumerate_layer(
    context: Context, chain: Chain, heights: Array, allowed: Bools, touches: CheckTarget, effort: Effort
) -> Layer:
    """Candidates of a chain over slide heights (h,), for the members (m,) that `allowed` leaves."""
    solver = context.solvers[chain.arm]
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    ranked = _ranked(context, chain, poses, allowed)
    found = np.zeros(len(heights), dtype=np.int64)
    kept: list[Rows] = [none_of(len(poses))]
    for first in range(0, len(ranked), MEMBERS_PER_ROUND):
        hungry = np.flatnonzero(found < effort.poses_per_height)
        if len(hungry) == 0:
            break
        members = ranked[first : first + MEMBERS_PER_ROUND]
        rows = feasible(solver, poses, members, heights[hungry], effort.configurations_per_pose, chain.legs)
        if effort.exhaustive:
            rows = on_line(solver, poses, rows, chain.legs)
        rows = _without_contact(rows, touches)
        kept.append(rows)
        for index in hungry:
            found[index] += len(np.unique(rows.member[rows.q[:, 0, 0] == heights[index]]))
    return layer_of(context, chain, poses, _joined(kept))


def _ranked(context: Context, chain: Chain, poses: Array, allowed: Bools) -> NDArray[np.intp]:
    """Members in the order in which they are worth trying: cheap ones first, and those whose hand comes from
    the robot's side.
    """
    shoulder = context.robot.T_base_frame(
        np.zeros(context.robot.nq), context.robot.arm(chain.arm).shoulder_frame
    )
    key = poses[_key(chain.legs, len(poses))]
    away = key[:, :2, 3] - shoulder[:2, 3]
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
    facing = np.einsum("mi,mi->m", key[:, :2, 2], away)
    costs = np.array([member.cost for member in chain.family.members]) + _FACING_COST * (1.0 - facing)
    members = np.flatnonzero(allowed)
    return members[np.argsort(costs[members], kind="stable")]


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


def _joined(parts: list[Rows]) -> Rows:
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
    key, targets = _key(legs, len(poses)), len(poses)
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


def _key(legs: tuple[Leg | None, ...], targets: int) -> int:
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


def _without_contact(rows: Rows, touches: CheckTarget) -> Rows:
    """The rows that touch nothing at any target; the grasp, where most fall, is looked at first."""
    targets = rows.q.shape[1]
    for target in sorted(range(targets), key=lambda index: (index != 1, index)):
        if len(rows.member) == 0:
            break
        rows = rows.kept(np.flatnonzero(~touches(target, rows.q[:, target])))
    return rows


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
