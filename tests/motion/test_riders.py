"""A closed bottle in the hand: its cap goes along, is looked at for contacts, weighs, and the verifier, which
reckons by itself, holds the plan to it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.lower.capped import BOTTLE, CAP, HEIGHT_M, capped
from tests.lower.plans import surface
from tests.motion.capped import CARRY, cap_of, carried, changed, findings, placed, set_down
from tests.motion.sequence.bench import goals, obj, plan, planned, station
from xei_lang.ir.geometry import Box, Pose, Primitive
from xei_lang.ir.timed import Placement, TimedGoal
from xei_lang.ir.world import World, WorldObject

MOVED = Pose((0.0, 0.0, 0.02))


def holding() -> list[TimedGoal]:
    return [goal for goal in carried()[0].goals if goal.attached and goal.joints]


def lifted_m() -> float:
    """How high the bottle's bottom comes over where it stood."""
    timed, _ = carried()
    heights = [
        (goal.tool @ item.T_link_object).position_m[2]
        for goal in timed.goals
        for item in goal.attached
        if goal.tool is not None and item.object == BOTTLE
    ]
    return max(heights) - min(heights)


def board(bottom_m: float) -> World:
    """The world with a small board over the bottle, its lower side this high over the bottle's bottom."""
    _, world = capped()
    x, y, z = world.T_world_object(BOTTLE).position_m
    size = (0.03, 0.03, 0.02)
    parts = (Primitive(Box(size), Pose((0.0, 0.0, size[2] / 2))),)
    above = Pose((x, y, z + bottom_m))
    item = WorldObject("board", above, "world", 1.0, (), (), size, parts, 1.0)
    return replace(world, objects=(*world.objects, item))


def in_the_way() -> World:
    """A board between the top of the lifted bottle and that of its cap."""
    return board(lifted_m() + HEIGHT_M + 0.01)


def test_the_cap_goes_where_its_bottle_goes() -> None:
    timed, graph = carried()
    _, world = capped()
    assert findings(timed, graph, world) == ()
    T_bottle_cap = world.T_world_object(BOTTLE).inverse() @ world.T_world_object(CAP)
    assert len(holding()) > 2
    for goal in holding():
        bottle = next(item for item in goal.attached if item.object == BOTTLE)
        assert cap_of(goal).link == bottle.link
        same(bottle.T_link_object @ T_bottle_cap, cap_of(goal).T_link_object)
    goal, _ = set_down(timed, graph)
    left = placed(goal)
    assert set(left) == {BOTTLE, CAP}
    same(left[BOTTLE].T_base_object @ T_bottle_cap, left[CAP].T_base_object)


PICK = ("pick", {"object": obj(BOTTLE), "arm": "right"})
JOURNEYS = {
    "set down elsewhere": plan(
        PICK, ("place", {"object": obj(BOTTLE), "on": surface("table"), "arm": "right"})
    ),
    "driven": plan(
        PICK,
        ("nav_to", {"station": station("bench_b")}),
        ("place", {"object": obj(BOTTLE), "on": surface("table_b"), "arm": "right"}),
    ),
    "handed over": plan(PICK, ("handover", {"object": obj(BOTTLE), "arm": "right", "to": "left"})),
}


@pytest.mark.parametrize("name", sorted(JOURNEYS))
def test_so_it_does_over_longer_ways(name: str) -> None:
    profile, world = capped()
    timed, problems = planned(JOURNEYS[name], profile, world)
    assert timed is not None, problems
    assert findings(timed, goals(JOURNEYS[name], profile, world), world) == ()
    T_bottle_cap = world.T_world_object(BOTTLE).inverse() @ world.T_world_object(CAP)
    for goal in timed.goals:
        bottles = {item.link: item.T_link_object for item in goal.attached if item.object == BOTTLE}
        caps = {item.link: item.T_link_object for item in goal.attached if item.object == CAP}
        assert set(bottles) == set(caps)
        for link, T_link_bottle in bottles.items():
            same(T_link_bottle @ T_bottle_cap, caps[link])
        assert set(placed(goal)) in (set(), {BOTTLE, CAP})


def same(first: Pose, second: Pose) -> None:
    assert math.dist(first.position_m, second.position_m) < 1e-9
    assert math.dist(first.quaternion, second.quaternion) < 1e-9


def test_a_plan_that_forgets_the_cap_is_found() -> None:
    timed, graph = carried()
    goal = holding()[1]
    bare = replace(goal, attached=tuple(item for item in goal.attached if item.object != CAP))
    (found,) = findings(changed(timed, bare), graph, capped()[1])
    assert (found.kind, found.subject, found.goal_id) == ("attachment", CAP, goal.id)
    assert found.message == f"`{CAP}` is on `{BOTTLE}` in the hand that moves, but the plan does not say so"


def test_a_cap_that_sits_elsewhere_than_on_its_bottle_is_found() -> None:
    timed, graph = carried()
    goal = holding()[1]
    loose = replace(cap_of(goal), T_link_object=cap_of(goal).T_link_object @ MOVED)
    wrong = replace(goal, attached=tuple(loose if item.object == CAP else item for item in goal.attached))
    (found,) = findings(changed(timed, wrong), graph, capped()[1])
    assert (found.kind, found.subject) == ("attachment", CAP)
    assert "sits elsewhere" in found.message


@pytest.mark.parametrize("said", ["nothing", "where it was"])
def test_a_cap_that_is_left_behind_is_found(said: str) -> None:
    timed, graph = carried()
    goal, _ = set_down(timed, graph)
    others = tuple(item for item in goal.placed if item.object != CAP)
    stale = (Placement(CAP, placed(goal)[CAP].T_base_object @ MOVED),) if said == "where it was" else ()
    (found,) = findings(changed(timed, replace(goal, placed=(*others, *stale))), graph, capped()[1])
    assert (found.kind, found.subject) == ("placement", CAP)


def test_a_cap_that_no_thread_holds_is_not_said_to_come_along() -> None:
    """The same plan in a world where the cap only stands on the bottle: it would stay behind, and be hit."""
    timed, graph = carried()
    _, world = capped()
    loose = tuple(replace(item, fastened_to="") for item in world.objects)
    kinds = {(found.kind, found.subject) for found in findings(timed, graph, replace(world, objects=loose))}
    assert ("attachment", CAP) in kinds
    assert ("collision", f"{BOTTLE} / {CAP}") in kinds or ("collision", f"{CAP} / {BOTTLE}") in kinds


def test_what_only_the_cap_would_hit_is_seen() -> None:
    timed, graph = carried()
    assert {found.subject for found in findings(timed, graph, in_the_way())} == {f"{CAP} / board"}
    none, problems = planned(CARRY, capped()[0], in_the_way())
    assert none is None
    assert [item.code for item in problems] == ["XEI0802"]
    assert "`board`" in problems[0].message


def test_without_the_cap_the_same_board_is_no_matter() -> None:
    bare = replace(in_the_way(), objects=tuple(item for item in in_the_way().objects if item.name != CAP))
    timed, problems = planned(CARRY, capped()[0], bare)
    assert timed is not None, problems
    assert findings(timed, carried()[1], bare) == ()
