"""Postures of a chain: the tool is where it should be, and swivel and branch stay over straight moves."""

from __future__ import annotations

import numpy as np

from tests.motion.sequence.bench import bench, context, goals, put_on_rack
from xei_lang.motion.sequence.context import Context
from xei_lang.motion.sequence.poses import tool_poses
from xei_lang.motion.sequence.postures import feasible, joined, none_of, on_line
from xei_lang.motion.sequence.sections import Chain, Group, split


def first_chain() -> tuple[Context, Chain]:
    profile, world = bench()
    group = split(goals(put_on_rack(), profile, world))[-1]
    assert isinstance(group, Group)
    return context(profile, world), group.chains[0]


def test_every_posture_shows_its_member_at_each_target_and_changes_nothing_else() -> None:
    about, chain = first_chain()
    solver = about.solvers[chain.arm]
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    members = np.arange(0, len(chain.family.members), 5)
    heights = np.linspace(about.slide_limits.lower, about.slide_limits.upper, 3)
    rows = feasible(solver, poses, members, heights, 3, chain.legs)
    assert len(rows) > 0
    assert set(rows.member.tolist()) <= set(members.tolist())
    assert set(rows.q[:, :, 0].ravel().tolist()) <= set(heights.tolist())
    assert np.array_equal(rows.swivel_angle, np.repeat(rows.swivel_angle[:, :1], len(poses), axis=1))
    _, counts = np.unique(np.stack([rows.member, rows.q[:, 0, 0]]), axis=1, return_counts=True)
    assert counts.max() <= 3
    rest = np.zeros(about.robot.nq)
    frame = about.robot.arm(chain.arm).tool_frame
    for row in range(0, len(rows), max(1, len(rows) // 20)):
        for target in range(len(poses)):
            whole = about.lift(rest, chain.arm, rows.q[row, target])
            T = about.robot.T_base_frame(whole, frame)
            assert np.allclose(T, poses[target, rows.member[row]], atol=1e-6)


def test_what_holds_half_way_as_well_is_a_part_of_what_holds_at_the_targets() -> None:
    about, chain = first_chain()
    solver = about.solvers[chain.arm]
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    members = np.arange(len(chain.family.members))
    rows = feasible(solver, poses, members, np.array([about.slide_limits.lower]), 20, chain.legs)
    kept = on_line(solver, poses, rows, chain.legs)
    assert 0 < len(kept) <= len(rows)
    assert {row.tobytes() for row in kept.q} <= {row.tobytes() for row in rows.q}


def test_parts_are_joined_in_their_order_and_none_adds_nothing() -> None:
    about, chain = first_chain()
    poses = np.stack([tool_poses(target, chain.family) for target in chain.targets])
    members, height = np.arange(len(chain.family.members)), np.array([about.slide_limits.lower])
    rows = feasible(about.solvers[chain.arm], poses, members, height, 2, chain.legs)
    assert len(rows) > 1
    first, second = rows.kept(np.arange(1)), rows.kept(np.arange(1, len(rows)))
    whole = joined([none_of(len(poses)), first, second])
    assert np.array_equal(whole.q, rows.q)
    assert np.array_equal(whole.member, rows.member)
