"""The verifier of MotionGoalGraph: what must hold of every graph, however it came about.

It runs before and after each pass in tests and on graphs that are read from files. It says what is wrong in
words and repairs nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.families import Family
from xei_lang.ir.goals import MotionGoalGraph, NavToPose, Perceive
from xei_lang.ir.verify_actions import action_faults, pose_fault
from xei_lang.ir.verify_hands import hand_problems
from xei_lang.ir.verify_riders import rider_problems
from xei_lang.ir.verify_runs import run_problems
from xei_lang.ir.verify_tool_paths import path_problems


def verify_goals(graph: MotionGoalGraph) -> tuple[str, ...]:
    """Every problem of the graph, in the order of its goals; empty for a sound one.

    Checked: unique ids; edges between known goals that run forward (so there is no cycle); actions that
    fit their kinds; known, non-empty families with finite members; finite poses and unit quaternions;
    epochs that start at 0, are all described and grow by one with each drive; hands that attach and
    detach in turn, the object and family that they hold, and let go of what they open about; what is
    fastened, on no circle; durations, openings and speeds within their ranges; paths of the tool that are
    stated where they must be, and lead from the move before to their target; runs of instruments that
    begin once, go on one at a time, and are paused, resumed and ended in turn.
    """
    problems = [*_ids_and_edges(graph), *_families(graph), *_epochs(graph)]
    families = {family.id for family in graph.families}
    for goal in graph.goals:
        problems.extend(f"goal `{goal.id}`: {text}" for text in action_faults(goal, families))
    problems.extend(path_problems(graph))
    problems.extend(run_problems(graph))
    problems.extend(hand_problems(graph))
    problems.extend(rider_problems(graph))
    return tuple(problems)


def _ids_and_edges(graph: MotionGoalGraph) -> Iterator[str]:
    order: dict[str, int] = {}
    for index, goal in enumerate(graph.goals):
        if goal.id in order:
            yield f"goal `{goal.id}`: its id is used twice"
        order.setdefault(goal.id, index)
    seen: set[tuple[str, str]] = set()
    for before, after in graph.edges:
        missing = next((name for name in (before, after) if name not in order), None)
        if missing is not None:
            yield f"edge `{before}` -> `{after}`: there is no goal `{missing}`"
        elif order[before] >= order[after]:
            yield f"edge `{before}` -> `{after}`: it runs backward in the order of the goals"
        if (before, after) in seen:
            yield f"edge `{before}` -> `{after}`: it stands twice"
        seen.add((before, after))


def _families(graph: MotionGoalGraph) -> Iterator[str]:
    seen: set[str] = set()
    for family in graph.families:
        if family.id in seen:
            yield f"family `{family.id}`: its id is used twice"
        seen.add(family.id)
        if not family.members:
            yield f"family `{family.id}`: it has no member"
        yield from _members(family)


def _members(family: Family) -> Iterator[str]:
    for member in family.members:
        fault = pose_fault(member.T_reference_tool)
        if fault:
            yield f"family `{family.id}`: member `{member.name}` {fault}"
        if not math.isfinite(member.cost):
            yield f"family `{family.id}`: member `{member.name}` has no finite cost"


def _epochs(graph: MotionGoalGraph) -> Iterator[str]:
    for index, epoch in enumerate(graph.epochs):
        if epoch.index != index:
            yield f"epoch {epoch.index}: expected number {index}"
        fault = pose_fault(epoch.T_world_base)
        if fault:
            yield f"epoch {epoch.index}: its base pose {fault}"
    current, perceived = 0, False
    for goal in graph.goals:
        if goal.epoch != current:
            yield f"goal `{goal.id}`: it is of epoch {goal.epoch}, the base stands in epoch {current}"
        if goal.provisional != perceived:
            yield f"goal `{goal.id}`: it is {'' if goal.provisional else 'not '}provisional"
        perceived = perceived or isinstance(goal.action, Perceive)
        if isinstance(goal.action, NavToPose):
            current, perceived = current + 1, False
            yield from _arrival(graph, goal.id, goal.action, current)
    if len(graph.epochs) != current + 1:
        yield f"the graph has {len(graph.epochs)} epochs for {current} drives"


def _arrival(graph: MotionGoalGraph, goal_id: str, action: NavToPose, epoch: int) -> Iterator[str]:
    if epoch < len(graph.epochs) and graph.epochs[epoch].T_world_base != action.T_world_base:
        yield f"goal `{goal_id}`: it drives elsewhere than epoch {epoch} stands"
