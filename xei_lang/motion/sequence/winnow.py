"""Candidates winnowed by the dynamic programme and then the checks that are dear, cheapest run first.

A candidate is checked along its whole linear motions only once a run asks for it, a transit is planned only
between two candidates that hold. What fails is struck out and the next cheapest run is taken, so that the
result is the cheapest run whose motions all hold.
"""

from __future__ import annotations

import numpy as np

from xei_lang.ir.skill_plan import Side
from xei_lang.motion.sequence.ahead import Ahead
from xei_lang.motion.sequence.candidates import Effort
from xei_lang.motion.sequence.choose import Array, Runs
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import as_held
from xei_lang.motion.sequence.failure import BlockedTransit, Failure, given_up, unplaced
from xei_lang.motion.sequence.meeting import Meeting
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.onward import goes_on
from xei_lang.motion.sequence.realise import BlockedAt, realise
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.search import Search, avoid, stages_of, travel
from xei_lang.motion.sequence.sections import Group
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.sound import all_sound
from xei_lang.motion.sequence.space import Touch, space_for
from xei_lang.motion.sequence.transit import keeps_upright

MAX_GLANCES = 6
MAX_STRIKES = 400
"""How many candidates may fall by their whole motions before a search ends: each look takes a moment, and a
place in which so many fall is taken for one that no grasp reaches."""
DETOUR_FACTOR = 1.3
DETOUR_S = 0.5
"""What a way around something is taken to cost beside the straight way, where that is blocked."""


def winnow(
    context: Context, group: Group, search: Search, start: Snapshot, ahead: Ahead, effort: Effort
) -> tuple[Motion, ...] | Failure:
    """The motions of the cheapest run that holds, for a group that begins at `start`; or why there is none.
    What falls is struck out in `search`.
    """
    now = start.q[context.arm_indices(group.arm)]
    speeds = context.speeds(context.arm_joints(group.arm))
    transitions = travel(context, now, search, speeds)
    homeward = _homeward_s(context, search, group.arm, ahead)
    runs = Runs(transitions)
    meeting = None if ahead.encounter is None else Meeting(context, ahead.encounter)
    failure: Failure | None = None
    blocked = 0
    while blocked <= effort.blocked_transits:
        run = runs.cheapest(stages_of(now, search, homeward))
        if run is None:
            return failure or unplaced(search, transitions)
        if search.strikes > MAX_STRIKES:
            return failure or given_up(search)
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


def _homeward_s(context: Context, search: Search, arm: Side, ahead: Ahead) -> Array:
    """Seconds (n,) from where each candidate of the group's last chain ends to what the arm does next."""
    last = search.layers[search.own - 1]
    if ahead.configuration is None:
        return np.zeros(len(last))
    speeds = context.speeds(context.robot.arm(arm).joint_names)
    return speeds.travel_s(last.q[:, -1, 1:], ahead.configuration[None])[:, 0]


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
