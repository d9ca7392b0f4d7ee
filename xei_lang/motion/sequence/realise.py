"""A chosen run carried out: the transits between its candidates planned, which is the dearest of all."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.motion.paths.free import PathBlocked
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.enact import carry_out
from xei_lang.motion.sequence.fixed import plan_fixed
from xei_lang.motion.sequence.motions import Motion
from xei_lang.motion.sequence.search import Search
from xei_lang.motion.sequence.sections import Chain, Group
from xei_lang.motion.sequence.snapshot import Snapshot
from xei_lang.motion.sequence.transit import plan_transit


@dataclass(frozen=True, slots=True)
class BlockedAt:
    """The transit into a stage that found no path, from `before`."""

    stage: int
    blocked: PathBlocked
    before: Snapshot


def realise(
    context: Context, group: Group, search: Search, chosen: tuple[int, ...], start: Snapshot
) -> tuple[Motion, ...] | BlockedAt:
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
            return BlockedAt(stage, transit, now)
        rest = carry_out(context, layer, index, transit.after)
        assert rest is not None
        motions.extend((transit, *rest))
        now = motions[-1].after
        stage += 1
    return tuple(motions)
