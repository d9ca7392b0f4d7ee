"""The chains of a group chosen together: what could serve at each of them is looked for, a little at first
and widely where that does not do, and of it the cheapest run that holds is taken.
"""

from __future__ import annotations

import numpy as np

from xei_lang.motion.sequence.ahead import Ahead
from xei_lang.motion.sequence.candidates import LEAN, THOROUGH, Effort, enumerate_layer, slide_heights
from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.failure import Failure, Unplaced
from xei_lang.motion.sequence.fits import object_touch
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.meeting import shown
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.onward import goes_on, onward_layer
from xei_lang.motion.sequence.poses import same_grasp
from xei_lang.motion.sequence.rehearse import Rehearsal, rehearse_group
from xei_lang.motion.sequence.search import Search
from xei_lang.motion.sequence.sections import Group
from xei_lang.motion.sequence.snapshot import UNCHOSEN, Snapshot
from xei_lang.motion.sequence.space import target_check
from xei_lang.motion.sequence.winnow import winnow


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
    return winnow(context, group, search, start, ahead, effort)


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


def _allowed(rehearsal: Rehearsal) -> Bools:
    """The members that a chain may show: all, or what the hand that already holds the object leaves."""
    chain, held = rehearsal.chain, rehearsal.before.held.get(rehearsal.chain.arm)
    if held is None or held.family.id != chain.family.id or held.member == UNCHOSEN:
        return np.ones(len(chain.family.members), dtype=bool)
    return same_grasp(chain.family, held.member, chain.turns)
