"""How far out of reach a chain is, and what would help: another slide height, arm or station."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.skill_plan import Side
from xei_lang.motion.sequence.candidates import THOROUGH, slide_heights
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.legs import Leg
from xei_lang.motion.sequence.poses import matrix, tool_poses
from xei_lang.motion.sequence.postures import feasible
from xei_lang.motion.sequence.rehearse import Rehearsal

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Reach:
    """The smallest distance by which a chain's targets lie outside the arm's reach, and the slide height of
    that.
    """

    shortfall_m: float
    slide_m: float


def chain_poses(rehearsal: Rehearsal) -> Array:
    """`T_base_tool` (targets, members, 4, 4) of a chain."""
    chain = rehearsal.chain
    return np.stack([tool_poses(target, chain.family) for target in chain.targets])


def tried_heights(context: Context, rehearsal: Rehearsal) -> Array:
    """The slide heights (h,) that a search to the end goes through."""
    slide_m = float(rehearsal.before.q[context.robot.slide_index])
    heights = slide_heights(context, slide_m, THOROUGH)
    return heights if rehearsal.chain.slide_free else heights[:1]


def nearest_reach(context: Context, rehearsal: Rehearsal) -> Reach:
    """Over members and heights, the smallest of the largest shortfalls over the chain's targets."""
    solver, poses = context.solvers[rehearsal.chain.arm], chain_poses(rehearsal)
    best = Reach(np.inf, 0.0)
    for height in tried_heights(context, rehearsal).tolist():
        for member in range(poses.shape[1]):
            worst = max(solver.reach_shortfall(pose, height) for pose in poses[:, member])
            if worst < best.shortfall_m:
                best = Reach(worst, height)
    return best


def reach_help(context: Context, rehearsal: Rehearsal) -> tuple[str, ...]:
    """What would bring the chain into reach, by trying: another slide height, a place between for the other
    arm to take the object from, each other station.
    """
    chain, poses = rehearsal.chain, chain_poses(rehearsal)
    heights = slide_heights(context, float(rehearsal.before.q[context.robot.slide_index]), THOROUGH)
    found: list[str] = []
    height = _lowest_feasible(context, chain.arm, poses, heights, chain.legs)
    if height is not None:
        found.append(f"with the slide at {height * 1000:.0f} mm it is in reach: move the slide there first")
    if chain.detach is not None:
        for side in sorted(context.solvers):
            if side != chain.arm and _lowest_feasible(context, side, poses, heights, chain.legs) is not None:
                found.append(
                    f"the {side} arm reaches this place: set `{chain.detach.object}` down where both arms"
                    f" reach it, and pick it from there with `arm={side}`"
                )
    found.extend(_stations(context, rehearsal, poses, heights))
    return tuple(found) or (
        "move it nearer to the robot, or add a station from which it is in reach to the calibration profile",
    )


def _stations(context: Context, rehearsal: Rehearsal, poses: Array, heights: Array) -> list[str]:
    found: list[str] = []
    T_world_base = matrix(rehearsal.before.T_world_base)
    for station in context.profile.calibration.stations:
        T_new_old = matrix(station.T_world_base.inverse()) @ T_world_base
        if np.allclose(T_new_old, np.eye(4), atol=1e-6):
            continue
        legs = tuple(None if leg is None else leg.seen_from(T_new_old) for leg in rehearsal.chain.legs)
        height = _lowest_feasible(context, rehearsal.chain.arm, T_new_old @ poses, heights, legs)
        if height is not None:
            found.append(
                f"it is in reach from `{station.name}`: drive there first (`nav_to(station={station.name})`)"
            )
    return found


def _lowest_feasible(
    context: Context, side: Side, poses: Array, heights: Array, legs: tuple[Leg | None, ...]
) -> float | None:
    members = np.arange(poses.shape[1], dtype=np.intp)
    for height in sorted(heights.tolist()):
        if len(feasible(context.solvers[side], poses, members, np.array([height]), 20, legs)) > 0:
            return height
    return None
