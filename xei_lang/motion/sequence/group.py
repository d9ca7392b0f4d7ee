"""The chains of a group chosen together: candidates, dynamic programme, and then the checks that are dear,
cheapest run first.

A candidate is checked along its whole linear motions only once a run asks for it, a transit is planned only
between two candidates that hold. What fails is struck out and the next cheapest run is taken, so that the
result is the cheapest run whose motions all hold.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MotionGoal
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.choose import Bools, Speeds, Stage, cheapest
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import as_held, carry_out
from xei_lang.motion.sequence.fixed import plan_fixed
from xei_lang.motion.sequence.layers import LEAN, THOROUGH, Effort, Layer, enumerate_layer, slide_heights
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.poses import same_grasp
from xei_lang.motion.sequence.rehearse import Rehearsal, rehearse_group
from xei_lang.motion.sequence.sections import Chain, Group
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Snapshot
from xei_lang.motion.sequence.space import Touch, motion_contact, space_for, target_check
from xei_lang.motion.sequence.transit import keeps_upright, plan_transit

Array = NDArray[np.float64]

MAX_BLOCKED_TRANSITS = 6
MAX_GLANCES = 6
DETOUR_FACTOR = 1.3
DETOUR_S = 0.5
"""What a way around something is taken to cost beside the straight way, where that is blocked."""
BLOCKED_S = 1.0
"""What is added to transits that are like one that found no path."""
OTHER_BRANCH_S = 3.0
"""What a change of branch is taken to cost where the hand must stay upright: it leads past a singular posture."""


@dataclass(frozen=True, slots=True)
class Ahead:
    """What comes after a group: the configuration (7,) of the arm that is named next, if one is, and the
    chain of a later group in which the hand still holds what it took in this one: the grasp must serve there
    too.
    """

    configuration: Array | None = None
    release: tuple[Rehearsal, ...] = ()


@dataclass(frozen=True, slots=True)
class Unplaced:
    """No candidate of a chain holds: `struck` counts the bodies that the checks of whole motions met."""

    rehearsal: Rehearsal
    struck: tuple[Touch, ...]


@dataclass(frozen=True, slots=True)
class BlockedTransit:
    """Candidates hold at both ends, but no path between them was found."""

    goal: MotionGoal
    blocked: PathBlocked


Failure = Unplaced | BlockedTransit


@dataclass(slots=True)
class _Search:
    """The state of one search: what still holds, and what has been found out."""

    own: int
    rehearsals: tuple[Rehearsal, ...]
    layers: tuple[Layer, ...]
    alive: list[Bools]
    struck: list[list[Touch]]
    transits: dict[tuple[int, ...], Motion | PathBlocked] = field(
        default_factory=dict[tuple[int, ...], Motion | PathBlocked]
    )
    sound: set[tuple[int, int]] = field(default_factory=set[tuple[int, int]])
    glanced: dict[int, set[tuple[int, int]]] = field(default_factory=dict[int, set[tuple[int, int]]])


def plan_group(context: Context, group: Group, start: Snapshot, ahead: Ahead) -> tuple[Motion, ...] | Failure:
    """Motions of all goals of a group from `start`, chosen with an eye to what comes after it."""
    rehearsals = rehearse_group(context, group, start)
    found: tuple[Motion, ...] | Failure = Unplaced(rehearsals[0], ())
    for effort in (LEAN, THOROUGH):
        found = _attempt(context, group, rehearsals, start, ahead, effort)
        if isinstance(found, tuple):
            break
    return found


def _attempt(
    context: Context,
    group: Group,
    rehearsals: tuple[Rehearsal, ...],
    start: Snapshot,
    ahead: Ahead,
    effort: Effort,
) -> tuple[Motion, ...] | Failure:
    heights = slide_heights(context, float(start.q[context.robot.slide_index]), effort)
    own = len(rehearsals)
    rehearsals = (*rehearsals, *ahead.release)
    layers: list[Layer] = []
    for rehearsal in rehearsals:
        chain = rehearsal.chain
        tried = heights if chain.slide_free else heights[:1]
        layer = enumerate_layer(
            context, chain, tried, _allowed(rehearsal), target_check(context, rehearsal), effort
        )
        if len(layer) == 0:
            return Unplaced(rehearsal, ())
        layers.append(layer)
    search = _Search(
        own,
        rehearsals,
        tuple(layers),
        [np.ones(len(layer), dtype=bool) for layer in layers],
        [[] for _ in layers],
    )
    return _search(context, group, search, start, ahead)


def _search(
    context: Context, group: Group, search: _Search, start: Snapshot, ahead: Ahead
) -> tuple[Motion, ...] | Failure:
    now = start.q[context.arm_indices(group.arm)]
    speeds = context.speeds(context.arm_joints(group.arm))
    transitions = _transitions(context, now, search, speeds)
    last = search.layers[search.own - 1]
    homeward = np.zeros(len(last))
    if ahead.configuration is not None:
        arm_speeds = context.speeds(context.robot.arm(group.arm).joint_names)
        homeward = arm_speeds.travel_s(last.q[:, -1, 1:], ahead.configuration[None])[:, 0]
    failure: Failure | None = None
    blocked = 0
    while blocked <= MAX_BLOCKED_TRANSITS:
        run = cheapest(_stages(now, search, homeward), transitions)
        if run is None:
            return failure or _unplaced(search)
        if not _all_sound(context, search, run[1:]) or _dearer(context, search, run, transitions, now):
            continue
        result = _realise(context, group, search, run[1:], start)
        if not isinstance(result, _BlockedAt):
            return result
        _avoid(search, result.stage, run, transitions[result.stage])
        failure = BlockedTransit(search.rehearsals[result.stage].chain.head, result.blocked)
        blocked += 1
    assert failure is not None
    return failure


def _stages(now: Array, search: _Search, homeward: Array) -> tuple[Stage, ...]:
    first = Stage(now[None], now[None], np.zeros(1), np.ones(1, dtype=bool))
    stages = [layer.stage(alive) for layer, alive in zip(search.layers, search.alive, strict=True)]
    last = stages[search.own - 1]
    stages[search.own - 1] = replace(last, cost=last.cost + homeward)
    return (first, *stages)


def _transitions(context: Context, now: Array, search: _Search, speeds: Speeds) -> tuple[Array, ...]:
    """Travel times between the group's stages; into a chain that is only looked ahead to, whether it may
    follow at all.
    """
    stages = _stages(now, search, np.zeros(1))
    costs: list[Array] = []
    for index, mask in enumerate((None, *_joined(search))):
        before, after = stages[index], stages[index + 1]
        if index < search.own:
            cost = speeds.travel_s(before.exit, after.entry) + _branch_s(context, now, search, index)
        else:
            cost = np.zeros((len(before.cost), len(after.cost)))
        costs.append(cost if mask is None else np.where(mask, cost, np.inf))
    return tuple(costs)


def _branch_s(context: Context, now: Array, search: _Search, stage: int) -> Array:
    """What the change of branch into each candidate of a stage adds, where the hand must stay upright."""
    rehearsal, after = search.rehearsals[stage], search.layers[stage].branch
    if not keeps_upright(rehearsal):
        return np.zeros((1, len(after)))
    solver = context.solvers[rehearsal.chain.arm]
    before = search.layers[stage - 1].branch if stage else np.array([solver.describe(now[1:])[1]])
    return OTHER_BRANCH_S * (before[:, None] != after[None, :])


def _avoid(search: _Search, stage: int, run: tuple[int, ...], costs: Array) -> None:
    """Strike a transit that found no path out, and make those like it dear: same grasps, branches and slide
    heights.
    """
    pair = run[stage], run[stage + 1]
    first = search.layers[stage - 1].like(pair[0]) if stage else np.ones(1, dtype=bool)
    costs[np.ix_(first, search.layers[stage].like(pair[1]))] += BLOCKED_S
    costs[pair] = np.inf


def _allowed(rehearsal: Rehearsal) -> Bools:
    """The members that a chain may show: all, or what the hand that already holds the object leaves."""
    chain, held = rehearsal.chain, rehearsal.before.held.get(rehearsal.chain.arm)
    if held is None or held.family.id != chain.family.id or held.member == UNCHOSEN:
        return np.ones(len(chain.family.members), dtype=bool)
    return same_grasp(chain.family, held.member, chain.turns)


def _joined(search: _Search) -> tuple[Bools | None, ...]:
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


def _all_sound(context: Context, search: _Search, chosen: tuple[int, ...]) -> bool:
    """Check the linear motions of every chosen candidate; strike out those that touch something."""
    good = True
    for stage, (rehearsal, layer, index) in enumerate(
        zip(search.rehearsals, search.layers, chosen, strict=True)
    ):
        if (stage, index) in search.sound:
            continue
        touch = _first_touch(context, rehearsal, layer, index)
        if touch is None:
            search.sound.add((stage, index))
        else:
            search.struck[stage].append(touch)
            search.alive[stage][index] = False
            good = False
    return good


def _dearer(
    context: Context, search: _Search, run: tuple[int, ...], transitions: tuple[Array, ...], now: Array
) -> bool:
    """Glance at the straight lines of a run that were not looked at before; where one is blocked, its cost
    goes up.
    """
    found = False
    for stage, (rehearsal, layer) in enumerate(zip(search.rehearsals, search.layers, strict=True)):
        pair, seen = (run[stage], run[stage + 1]), search.glanced.setdefault(stage, set())
        if stage >= search.own or pair in seen or len(seen) >= MAX_GLANCES or keeps_upright(rehearsal):
            continue
        seen.add(pair)
        q_from = now if stage == 0 else search.layers[stage - 1].q[pair[0], -1]
        before = as_held(rehearsal.chain, rehearsal.before, int(layer.member[pair[1]]))
        joints = context.arm_joints(rehearsal.chain.arm)
        space = space_for(context, before, joints, rehearsal.chain.head.allowed_contacts)
        if not space.looks_clear(q_from, layer.q[pair[1], 0]):
            transitions[stage][pair] = DETOUR_FACTOR * transitions[stage][pair] + DETOUR_S
            found = True
    return found


def _first_touch(context: Context, rehearsal: Rehearsal, layer: Layer, index: int) -> Touch | None:
    chain = rehearsal.chain
    before = as_held(chain, rehearsal.before, int(layer.member[index]))
    start = before.moved(context.lift(before.q, chain.arm, layer.q[index, 0]))
    motions = carry_out(context, layer, index, start)
    if motions is None:
        return Touch(int(layer.member[index]), None)
    for motion in motions:
        bodies = motion_contact(context, motion)
        if bodies is not None:
            return Touch(int(layer.member[index]), bodies)
    return None


@dataclass(frozen=True, slots=True)
class _BlockedAt:
    stage: int
    blocked: PathBlocked


def _realise(
    context: Context, group: Group, search: _Search, chosen: tuple[int, ...], start: Snapshot
) -> tuple[Motion, ...] | _BlockedAt:
    """The motions of a chosen run, transits planned; or the first transit that found no path."""
    now = start
    motions: list[Motion] = []
    stage = 0
    for item in group.items:
        if not isinstance(item, Chain):
            motion = plan_fixed(context, item, now)
            assert isinstance(motion, Motion)
            motions.append(motion)
            now = motion.after
            continue
        layer, index = search.layers[stage], chosen[stage]
        prefix = chosen[: stage + 1]
        transit = search.transits.get(prefix) or plan_transit(context, layer, index, now)
        search.transits[prefix] = transit
        if isinstance(transit, PathBlocked):
            return _BlockedAt(stage, transit)
        rest = carry_out(context, layer, index, transit.after)
        assert rest is not None
        motions.extend((transit, *rest))
        now = motions[-1].after
        stage += 1
    return tuple(motions)


def _unplaced(search: _Search) -> Unplaced:
    """The first chain that has nothing left, or else the one that lost most."""
    empty = [stage for stage, alive in enumerate(search.alive) if not alive.any()]
    stage = empty[0] if empty else max(range(len(search.layers)), key=lambda k: len(search.struck[k]))
    return Unplaced(search.rehearsals[stage], tuple(search.struck[stage]))
