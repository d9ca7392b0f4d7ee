"""Candidates of a chain: the present slide height first, and nothing that touches."""

from __future__ import annotations

import numpy as np

from tests.motion.sequence.bench import bench, context, goals, put_on_rack
from xei_lang.motion.sequence.candidates import LEAN, THOROUGH, enumerate_layer, slide_heights
from xei_lang.motion.sequence.choose import Bools
from xei_lang.motion.sequence.sections import Group, split


def test_the_present_height_comes_first_and_the_others_from_near_to_far() -> None:
    about = context(*bench())
    limits = about.slide_limits
    now = limits.lower + 0.4 * (limits.upper - limits.lower)
    for effort in (LEAN, THOROUGH):
        heights = slide_heights(about, now, effort)
        assert heights[0] == now
        assert np.all(np.diff(np.abs(heights - now)) >= 0.0)
        assert heights.min() >= limits.lower
        assert heights.max() <= limits.upper
        assert len(heights) in (effort.heights, effort.heights + 1)


def test_a_height_that_the_grid_has_already_is_not_tried_twice() -> None:
    about = context(*bench())
    heights = slide_heights(about, about.slide_limits.upper, LEAN)
    assert len(heights) == LEAN.heights
    assert len(np.unique(heights)) == LEAN.heights


def test_only_allowed_members_that_touch_nothing_at_any_target_are_left() -> None:
    profile, world = bench()
    about = context(profile, world)
    group = split(goals(put_on_rack(), profile, world))[-1]
    assert isinstance(group, Group)
    chain = group.chains[0]
    allowed = np.arange(len(chain.family.members)) % 2 == 0
    heights = np.array([about.slide_limits.lower])

    def touches(target: int, q: np.ndarray) -> Bools:
        # As if a wall stood where the last target asks for a bent first joint.
        wall: Bools = q[:, 1] > 0.0 if target == len(chain.targets) - 1 else np.zeros(len(q), dtype=bool)
        return wall

    free = enumerate_layer(
        about, chain, heights, allowed, lambda _target, q: np.zeros(len(q), dtype=bool), THOROUGH
    )
    walled = enumerate_layer(about, chain, heights, allowed, touches, THOROUGH)
    assert np.all(allowed[free.member])
    assert 0 < len(walled) < len(free)
    assert np.all(walled.q[:, -1, 1] <= 0.0)
    assert int(np.count_nonzero(free.q[:, -1, 1] <= 0.0)) == len(walled)
