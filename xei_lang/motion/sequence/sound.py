"""The candidates of a run looked at along their whole linear motions: what touches something is struck
out.
"""

from __future__ import annotations

from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import as_held, carry_out
from xei_lang.motion.sequence.layers import Layer
from xei_lang.motion.sequence.parting import Parting, parting_touch
from xei_lang.motion.sequence.rehearse import Rehearsal
from xei_lang.motion.sequence.search import Search
from xei_lang.motion.sequence.space import Touch, motion_contact


def all_sound(context: Context, search: Search, chosen: tuple[int, ...]) -> bool:
    """Check the linear motions of every chosen candidate; strike out those that touch something."""
    good = True
    for stage, (rehearsal, layer, index) in enumerate(
        zip(search.rehearsals, search.layers, chosen, strict=True)
    ):
        if (stage, index) in search.sound:
            continue
        parting = search.parting if stage == search.own - 1 else None
        touch = first_touch(context, rehearsal, layer, index, parting)
        if touch is None:
            search.sound.add((stage, index))
        else:
            search.struck[stage].append(touch)
            search.alive[stage][index] = False
            good = False
    return good


def first_touch(
    context: Context, rehearsal: Rehearsal, layer: Layer, index: int, parting: Parting | None
) -> Touch | None:
    """What a candidate meets on its linear motions, or where the other hand then parts from it; None where it
    holds.
    """
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
    if parting is not None and motions:
        return parting_touch(context, parting, motions[-1].after, int(layer.member[index]))
    return None
