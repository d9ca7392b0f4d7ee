"""Which chain is named when a search has found nothing."""

from __future__ import annotations

import numpy as np

from tests.motion.sequence.bench import bench, context, goals, put_on_rack
from xei_lang.motion.sequence.candidates import LEAN, enumerate_layer
from xei_lang.motion.sequence.failure import given_up, unplaced
from xei_lang.motion.sequence.rehearse import rehearse_group
from xei_lang.motion.sequence.search import Search
from xei_lang.motion.sequence.sections import Group, split
from xei_lang.motion.sequence.snapshot import first_snapshot
from xei_lang.motion.sequence.space import Touch


def begun() -> tuple[Search, tuple[np.ndarray, ...]]:
    """A search over the two chains of a tube put on a rack, and free ways between all its candidates."""
    profile, world = bench()
    about = context(profile, world)
    group = split(goals(put_on_rack(), profile, world))[-1]
    assert isinstance(group, Group)
    rehearsals = rehearse_group(about, group, first_snapshot(about.robot, world))
    layers = tuple(
        enumerate_layer(
            about,
            item.chain,
            np.array([about.slide_limits.lower]),
            np.ones(len(item.chain.family.members), dtype=bool),
            lambda _target, q: np.zeros(len(q), dtype=bool),
            LEAN,
        )
        for item in rehearsals
    )
    assert all(len(layer) > 1 for layer in layers)
    alive = [np.ones(len(layer), dtype=bool) for layer in layers]
    first, second = (len(layer) for layer in layers)
    search = Search(len(layers), rehearsals, layers, alive, [[] for _ in layers])
    return search, (np.zeros((1, first)), np.zeros((first, second)))


def test_the_first_chain_that_no_run_reaches_is_named_with_what_its_candidates_met() -> None:
    search, ways = begun()
    search.alive[1][:] = False
    search.struck[1].append(Touch(0, ("a", "b")))
    failure = unplaced(search, ways)
    assert failure.rehearsal is search.rehearsals[1]
    assert failure.struck == (Touch(0, ("a", "b")),)
    assert not failure.given_up
    search.alive[0][:] = False
    assert unplaced(search, ways).rehearsal is search.rehearsals[0]


def test_a_chain_whose_candidates_no_way_joins_to_those_that_hold_is_not_reached() -> None:
    search, ways = begun()
    search.alive[0][1:] = False
    ways[1][0] = np.inf
    assert unplaced(search, ways).rehearsal is search.rehearsals[1]


def test_a_search_that_was_ended_names_the_chain_where_none_held_before_one_where_more_fell() -> None:
    search, _ = begun()
    search.struck[0].extend([Touch(0, None), Touch(1, None)])
    search.struck[1].append(Touch(0, None))
    assert given_up(search).rehearsal is search.rehearsals[0]
    search.sound.add((0, 0))
    failure = given_up(search)
    assert failure.rehearsal is search.rehearsals[1]
    assert failure.given_up
