"""The chains of a group chosen together: candidates, dynamic programme, and then the checks that are dear,
cheapest run first.

A candidate is checked along its whole linear motions only once a run asks for it, a transit is planned only
between two candidates that hold. What fails is struck out and the next cheapest run is taken, so that the
result is the cheapest run whose motions all hold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from xei_lang.ir.goals import MotionGoal
from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.candidates import LEAN, THOROUGH, Effort, enumerate_layer, slide_heights
from xei_lang.motion.sequence.choose import Bools, Runs
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import as_held
from xei_lang.motion.sequence.fits import object_touch
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.meeting import Encounter, Meeting, shown
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.onward import goes_on, onward_layer
from xei_lang.motion.sequence.parting import Parting
from xei_lang.motion.sequence.poses import same_grasp
from xei_lang.motion.sequence.realise import BlockedAt, realise
from xei_lang.motion.sequence.rehearse import Rehearsal, rehearse_group
from xei_lang.motion.sequence.search import Search, avoid, stages_of, travel
from xei_lang.motion.sequence.sections import Group
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Snapshot
from xei_lang.motion.sequence.sound import all_sound
from xei_lang.motion.sequence.space import Pair, Touch, space_for, target_check
from xei_lang.motion.sequence.transit import keeps_upright

Array = NDArray[np.float64]

MAX_GLANCES = 6
MAX_STRIKES = 400
"""How many candidates may fall by their whole motions before a search ends: each look takes a moment, and a
place in which so many fall is taken for one that no grasp reaches."""
DETOUR_FACTOR = 1.3
DETOUR_S = 0.5
"""What a way around something is taken to cost beside the straight way, where that is blocked."""


@dataclass(frozen=True, slots=True)
class Ahead:
    """What comes after a group: the configuration (7,) of the arm that is named next, if one is, and the
    chains of later groups in which the hand still holds what it took in this one, up to where it lets go: the
    grasp must serve in all of them; how the hand parts from it that this group takes it from; and, where the
    two grasps are chosen together, its taking by the other hand after the last of those chains.
    """

    configuration: Array | None = None
    release: tuple[Rehearsal, ...] = ()
    parting: Parting | None = None
    encounter: Encounter | None = None


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


def plan_group(context: Context, group: Group, start: Snapshot, ahead: Ahead) -> tuple[Motion, ...] | Failure:
    """Motions of all goals of a group from `start`, chosen with an eye to what comes after it."""
    rehearsals = rehearse_group(context, group, start)
    found: tuple[Motion, ...] | Failure = Unplaced(rehearsals[0], ())
    for effort in (LEAN, THOROUGH):
        found = _attempt(context, group, rehearsals, start, ahead, effort)
        if isinstance(found, tuple) or (isinstance(found, Unplaced) and found.unfit is not None):
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
    own = len(rehearsals)
    rehearsals = (*rehearsals, *ahead.release)
    for rehearsal in rehearsals:
        unfit = object_touch(context, rehearsal)
        if unfit is not None:
            return Unplaced(rehearsal, (), unfit)
    layers = _layers(context, rehearsals, start, effort)
    if len(layers[-1]) == 0:
        return Unplaced(rehearsals[len(layers) - 1], ())
    search = Search(
        own,
        rehearsals,
        tuple(layers),
        [np.ones(len(layer), dtype=bool) for layer in layers],
        [[] for _ in layers],
        ahead.parting,
    )
    return _search(context, group, search, start, ahead, effort)


def _layers(
    context: Context, rehearsals: tuple[Rehearsal, ...], start: Snapshot, effort: Effort
) -> list[Layer]:
    """The layers of all chains, or up to the first that is empty."""
    heights = slide_heights(context, float(start.q[context.robot.slide_index]), effort)
    layers: list[Layer] = []
    for rehearsal in rehearsals:
        chain = rehearsal.chain
        tried = heights if chain.slide_free else rehearsal.before.q[[context.robot.slide_index]]
        if goes_on(chain) and not layers:
            layer = onward_layer(context, chain, start)
        else:
            allowed = _allowed(rehearsal)
            if effort.exhaustive and layers and chain.arm in rehearsal.before.held:
                allowed &= shown(chain, layers[-1].member)
            layer = enumerate_layer(context, chain, tried, allowed, target_check(context, rehearsal), effort)
        layers.append(layer)
        if len(layer) == 0:
            break
    return layers


def _search(
    context: Context, group: Group, search: Search, start: Snapshot, ahead: Ahead, effort: Effort
) -> tuple[Motion, ...] | Failure:
    now = start.q[context.arm_indices(group.arm)]
    speeds = context.speeds(context.arm_joints(group.arm))
    transitions = travel(context, now, search, speeds)
    last = search.layers[search.own - 1]
    homeward = np.zeros(len(last))
    if ahead.configuration is not None:
        arm_speeds = context.speeds(context.robot.arm(group.arm).joint_names)
        homeward = arm_speeds.travel_s(last.q[:, -1, 1:], ahead.configuration[None])[:, 0]
    runs = Runs(transitions)
    meeting = None if ahead.encounter is None else Meeting(context, ahead.encounter)
    failure: Failure | None = None
    blocked = 0
    while blocked <= effort.blocked_transits:
        run = runs.cheapest(stages_of(now, search, homeward))
        if run is None:
            return failure or _unplaced(search, transitions)
        if search.strikes > MAX_STRIKES:
            return failure or _given_up(search)
        if not all_sound(context, search, run[1:]) or not _is_taken(search, meeting, run[-1]):
            continue
        dearer = _dearer(context, search, run, transitions, now)
        for stage in dearer:
            runs.changed(stage)
        if dearer:
            continue
        result = realise(context, group, search, run[1:], start)
        if not isinstance(result, BlockedAt):
            return result
        avoid(search, result.stage, run, transitions[result.stage])
        runs.changed(result.stage)
        layer, index = search.layers[result.stage], run[result.stage + 1]
        failure = BlockedTransit(layer.chain.head, result.blocked, result.before, layer, index)
        blocked += 1
    assert failure is not None
    return failure


def _allowed(rehearsal: Rehearsal) -> Bools:
    """The members that a chain may show: all, or what the hand that already holds the object leaves."""
    chain, held = rehearsal.chain, rehearsal.before.held.get(rehearsal.chain.arm)
    if held is None or held.family.id != chain.family.id or held.member == UNCHOSEN:
        return np.ones(len(chain.family.members), dtype=bool)
    return same_grasp(chain.family, held.member, chain.turns)


def _is_taken(search: Search, meeting: Meeting | None, index: int) -> bool:
    """Whether the other hand can take what the last chain's candidate holds out; strike out those like it
    where it cannot.
    """
    stage = len(search.layers) - 1
    if meeting is None or (stage, index) in search.met:
        return True
    layer = search.layers[stage]
    if meeting.allows(layer, index):
        search.met.add((stage, index))
        return True
    search.struck[stage].append(Touch(int(layer.member[index]), None))
    search.alive[stage] &= ~layer.like(index)
    return False


def _dearer(
    context: Context, search: Search, run: tuple[int, ...], transitions: tuple[Array, ...], now: Array
) -> tuple[int, ...]:
    """Glance at the straight lines of a run that were not looked at before; where one is blocked, its cost
    goes up. Returns the stages where one is.
    """
    found: list[int] = []
    for stage, (rehearsal, layer) in enumerate(zip(search.rehearsals, search.layers, strict=True)):
        pair, seen = (run[stage], run[stage + 1]), search.glanced.setdefault(stage, set())
        if stage >= search.own or pair in seen or len(seen) >= MAX_GLANCES or _is_stated(rehearsal):
            continue
        seen.add(pair)
        q_from = now if stage == 0 else search.layers[stage - 1].q[pair[0], -1]
        before = as_held(rehearsal.chain, rehearsal.before, int(layer.member[pair[1]]))
        joints = context.arm_joints(rehearsal.chain.arm)
        space = space_for(context, before, joints, rehearsal.chain.head.allowed_contacts)
        if not space.looks_clear(q_from, layer.q[pair[1], 0]):
            transitions[stage][pair] = DETOUR_FACTOR * transitions[stage][pair] + DETOUR_S
            found.append(stage)
    return tuple(found)


def _is_stated(rehearsal: Rehearsal) -> bool:
    """Whether the straight line in joint space says nothing of the move that a chain begins with."""
    return keeps_upright(rehearsal) or goes_on(rehearsal.chain)


def _unplaced(search: Search, transitions: tuple[Array, ...]) -> Unplaced:
    """The first chain that no run of candidates reaches."""
    reached, failed = np.ones(1, dtype=bool), 0
    for stage, (cost, alive) in enumerate(zip(transitions, search.alive, strict=True)):
        reached, failed = np.isfinite(cost[reached]).any(axis=0) & alive, stage
        if not reached.any():
            break
    return Unplaced(search.rehearsals[failed], tuple(search.struck[failed]))


def _given_up(search: Search) -> Unplaced:
    """The chain of which most candidates fell, of those first of which none held."""
    held = {stage for stage, _ in search.sound}
    worst = max(range(len(search.struck)), key=lambda stage: (stage not in held, len(search.struck[stage])))
    return Unplaced(search.rehearsals[worst], tuple(search.struck[worst]), given_up=True)
