"""No two bodies touch that may not, at any time: conservative advancement over the 1 kHz configurations.

Two bodies that are `d` apart cannot meet before their points have moved by `d` towards each other; how far
points can have moved is bounded by the joints' travel times their levers (`Robot.lever`). So each pair is
measured, then left alone for as long as that bound allows (Mirtich, "Impulse-based dynamic simulation of
rigid body systems", 1996, ch. 2). Pairs that bounding spheres keep apart through a whole phase are never
measured. Between objects that nobody holds nothing is checked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from heapq import heapify, heappop, heappush

import numpy as np

from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.bodies import Bodies
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.openings import Openings
from xei_lang.motion.verify.pairs import Pairs, Rows
from xei_lang.motion.verify.timeline import Phase

_NODE_STRIDE = 16
_GLANCE_STRIDE = 16
"""Nodes from one glance to the next: pairs that these few keep apart are not looked at in all the others."""


@dataclass(frozen=True, slots=True)
class _Near:
    """A pair that bounding spheres do not keep apart, and how far its points can have moved up to each
    time."""

    row: int
    moved: Array


def check_clearance(context: Context) -> int:
    """Look at all phases; returns how many exact distances were measured."""
    held = frozenset(h.object for phase in context.timeline.phases for h in phase.scene.held)
    bodies = Bodies(context.robot, context.about, context.world)
    pairs = Pairs(bodies, context.graph, held, context.about.srdf_text)
    openings = Openings(context, bodies, pairs)
    measured, epoch = 0, -1
    for phase in context.timeline.phases:
        if phase.new_scene:
            bodies.arrange(phase.scene)
            pairs.arrange(phase.scene)
        if phase.scene.epoch != epoch:
            measured += _check_phase(context, bodies, pairs, _still(phase))
            epoch = phase.scene.epoch
        if phase.moving:
            measured += _check_phase(context, bodies, pairs, phase)
            openings.check(phase)
    return measured


def _still(phase: Phase) -> Phase:
    """The first instant of a phase: how things stand once the base has come to a new stand."""
    return replace(phase, times=phase.times[:1], q=phase.q[:1], v=phase.v[:1], a=phase.a[:1])


def _check_phase(context: Context, bodies: Bodies, pairs: Pairs, phase: Phase) -> int:
    """Pairs that move against each other; at a single instant, all that can. What stands still against each
    other was looked at when it last moved."""
    travel = np.zeros_like(phase.q)
    np.cumsum(np.abs(np.diff(phase.q, axis=0)), axis=0, out=travel[1:])
    active = travel[-1] > 0.0
    rows = pairs.forbidden(phase, active)
    if not len(rows):
        return 0
    near = _sift(phase, pairs, rows, travel, context.options.contact_m)
    return _advance(context, bodies, pairs, phase, near)


def _sift(phase: Phase, pairs: Pairs, rows: Rows, travel: Array, contact_m: float) -> list[_Near]:
    """The pairs that lower bounds at some nodes do not already keep apart from node to node."""
    nodes = _every(_NODE_STRIDE, len(phase.times))
    centers = pairs.centers(phase.q[nodes], phase.scene)
    columns = np.flatnonzero(travel[-1] > 0.0)
    travel, weights = travel[:, columns], pairs.weights[:, columns]
    for some in (_every(_GLANCE_STRIDE, len(nodes)), np.arange(len(nodes))):
        gaps = pairs.gaps(centers[some], rows, phase.scene) - contact_m
        # Sums over few columns, written as einsum: a threaded matrix product costs more than it saves here.
        steps = np.einsum("nj,pj->np", np.diff(travel[nodes[some]], axis=0), weights[rows])
        apart = np.all(gaps > 0.0, axis=0) & np.all(gaps[1:] + gaps[:-1] > steps, axis=0)
        rows = rows[~apart]
    return [_Near(row, np.einsum("nj,j->n", travel, weights[row])) for row in rows.tolist()]


def _every(stride: int, count: int) -> Rows:
    """Each `stride`-th of so many, and the last."""
    return np.unique([*range(0, count, stride), count - 1])


def _advance(context: Context, bodies: Bodies, pairs: Pairs, phase: Phase, near: list[_Near]) -> int:
    """Measure each pair's shapes when their bound has run out, in order of time; returns the number of
    distances."""
    contact, last = context.options.contact_m, len(phase.times) - 1
    queue: list[tuple[int, int, int]] = []
    for k, item in enumerate(near):
        bodies.add_pair(pairs.pairs[item.row])
        queue += [(0, k, shape) for shape in bodies.shape_pairs(pairs.pairs[item.row])]
    heapify(queue)
    placed, measured = -1, 0
    touched: set[int] = set()
    closest = (np.inf, 0, 0)
    while queue:
        node, k, shape = heappop(queue)
        if k in touched:
            continue
        if node != placed:
            bodies.move(phase.q[node])
            placed = node
        distance = bodies.distance(shape)
        measured += 1
        closest = min(closest, (distance, node, k))
        if distance <= contact:
            touched.add(k)
            _touch(context, pairs, phase, near[k].row, node, distance=distance)
            continue
        moved = near[k].moved
        reach = float(moved[node]) + distance - contact
        safe = int(np.searchsorted(moved, reach)) - 1
        if safe < last:
            heappush(queue, (max(safe, node + 1), k, shape))
    _note_clearance(context, pairs, phase, near, closest)
    return measured


def _touch(context: Context, pairs: Pairs, phase: Phase, row: int, node: int, *, distance: float) -> None:
    goal, (a, b) = _mover(context, pairs, phase, row), pairs.pairs[row]
    if goal is not None:
        limit, time = context.options.contact_m, float(phase.times[node])
        text = f"`{a}` touches `{b}`"
        context.found("collision", goal, time, f"{a} / {b}", text, value=distance, limit=limit, unit="m")


def _note_clearance(
    context: Context, pairs: Pairs, phase: Phase, near: list[_Near], closest: tuple[float, int, int]
) -> None:
    distance, node, k = closest
    if not np.isfinite(distance):
        return
    goal, time = _mover(context, pairs, phase, near[k].row), float(phase.times[node])
    if goal is not None:
        where = " / ".join(pairs.pairs[near[k].row])
        context.margin("clearance", float(distance), where, goal.id, time, smallest=True)


def _mover(context: Context, pairs: Pairs, phase: Phase, row: int) -> TimedGoal | None:
    """The running goal that moves the two bodies against each other, or what comes nearest to one."""
    for goal in phase.moving:
        columns = [context.robot.column[joint] for joint in goal.joints]
        if pairs.between[row, columns].any():
            return goal
    return next(iter((*phase.moving, *phase.running, *context.plan.goals)), None)
