"""How a goal sequence falls into groups of chains and fixed goals."""

from __future__ import annotations

from tests.motion.sequence.bench import bench, goals, obj, plan, put_on_rack, slot, spot, station
from xei_lang.ir.goals import MotionGoal
from xei_lang.motion.sequence.sections import Chain, Group, Part, split


def shape(parts: tuple[Part, ...]) -> list[str]:
    """`fixed` goals by their kind, groups by their arm and how their items alternate."""
    shown: list[str] = []
    for part in parts:
        if isinstance(part, Group):
            items = ["chain" if isinstance(item, Chain) else item.kind for item in part.items]
            shown.append(f"{part.arm}: {' '.join(items)}")
        else:
            shown.append(part.kind)
    return shown


def test_a_pick_and_an_insert_are_two_chains_of_one_group() -> None:
    profile, world = bench()
    parts = split(goals(put_on_rack(), profile, world))
    assert shape(parts)[-1] in ("left: chain chain", "right: chain chain")
    group = parts[-1]
    assert isinstance(group, Group)
    take, put = group.chains
    assert [goal.kind for goal in take.goals] == ["move_to", "move_to", "close_gripper", "attach", "move_to"]
    assert [goal.kind for goal in put.goals] == ["move_to", "move_to", "open_gripper", "detach", "move_to"]
    assert take.attach is not None
    assert put.detach is not None
    assert put.turns
    assert not take.turns


def test_every_goal_stands_in_exactly_one_part_and_in_order() -> None:
    profile, world = bench()
    steps = plan(
        ("pick", {"object": obj("tube_1"), "arm": "left"}),
        ("pick", {"object": obj("bottle_1"), "arm": "right"}),
        ("insert", {"object": obj("tube_1"), "into": slot("rack_2", "A1"), "arm": "left"}),
        ("place", {"object": obj("bottle_1"), "on": spot("table", "bottle"), "arm": "right"}),
    )
    graph = goals(steps, profile, world)
    parts = split(graph)
    flat: list[MotionGoal] = []
    for part in parts:
        for item in part.items if isinstance(part, Group) else (part,):
            flat.extend(item.goals if isinstance(item, Chain) else (item,))
    assert tuple(flat) == graph.goals
    groups = [part.arm for part in parts if isinstance(part, Group)]
    assert groups == ["left", "right", "left", "right"]


def test_a_drive_ends_a_group() -> None:
    profile, world = bench()
    steps = plan(
        ("pick", {"object": obj("tube_1"), "arm": "left"}),
        ("nav_to", {"station": station("bench_b")}),
    )
    shown = shape(split(goals(steps, profile, world)))
    assert shown.index("left: chain chain") < shown.index("nav_to_pose") < shown.index("perceive")
