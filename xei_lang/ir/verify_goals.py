"""The verifier of MotionGoalGraph: what must hold of every graph, however it came about.

It runs before and after each pass in tests and on graphs that are read from files. It says what is wrong in
words and repairs nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.goals import (
    Attach,
    Confirm,
    Detach,
    Grip,
    Instrument,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    Perceive,
    SetDo,
    SlideMove,
    Wait,
    in_hand,
)
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.verify_riders import rider_problems
from xei_lang.ir.verify_runs import run_problems
from xei_lang.ir.verify_tool_paths import path_problems

_UNIT = 1e-6
_ACTION_OF_KIND: dict[str, type] = {
    "move_to": MoveTo,
    "open_gripper": Grip,
    "close_gripper": Grip,
    "set_do": SetDo,
    "slide_move": SlideMove,
    "nav_to_pose": NavToPose,
    "wait": Wait,
    "perceive": Perceive,
    "confirm": Confirm,
    "instrument": Instrument,
    "attach": Attach,
    "detach": Detach,
}


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
        problems.extend(f"goal `{goal.id}`: {text}" for text in _goal(goal, families))
    problems.extend(path_problems(graph))
    problems.extend(run_problems(graph))
    problems.extend(_hands(graph))
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
        fault = _pose_fault(member.T_reference_tool)
        if fault:
            yield f"family `{family.id}`: member `{member.name}` {fault}"
        if not math.isfinite(member.cost):
            yield f"family `{family.id}`: member `{member.name}` has no finite cost"


def _epochs(graph: MotionGoalGraph) -> Iterator[str]:
    for index, epoch in enumerate(graph.epochs):
        if epoch.index != index:
            yield f"epoch {epoch.index}: expected number {index}"
        fault = _pose_fault(epoch.T_world_base)
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


def _goal(goal: MotionGoal, families: set[str]) -> Iterator[str]:
    if not isinstance(goal.action, _ACTION_OF_KIND.get(goal.kind, ())):
        yield f"its action does not fit the kind `{goal.kind}`"
    if not 0.0 <= goal.min_duration_s <= goal.max_duration_s:
        yield f"its durations {goal.min_duration_s:g} .. {goal.max_duration_s:g} s are no range"
    if isinstance(goal.action, MoveTo):
        yield from _move(goal.action, families)
    elif isinstance(goal.action, Attach):
        if goal.action.family not in families:
            yield f"there is no family `{goal.action.family}`"
    else:
        yield from _numbers(goal.action)


def _move(action: MoveTo, families: set[str]) -> Iterator[str]:
    if not 0.0 < action.speed_fraction <= 1.0:
        yield f"its speed fraction {action.speed_fraction:g} is not in (0, 1]"
    target = action.target
    if isinstance(target, JointTarget):
        if not target.joints or not all(math.isfinite(value) for _, value in target.joints):
            yield f"its configuration `{target.name}` has no finite joints"
        return
    if target.family not in families:
        yield f"there is no family `{target.family}`"
    if action.arm is None:
        yield "it aims a tool without an arm"
    fault = _pose_fault(target.T_base_reference)
    if fault:
        yield f"its reference {fault}"
    if not _finite(target.offset_base_m) or not _finite(target.offset_tool_m):
        yield "its offsets are not finite"


def _numbers(action: object) -> Iterator[str]:
    if isinstance(action, Grip) and not (math.isfinite(action.opening_m) and action.opening_m >= 0.0):
        yield f"its opening {action.opening_m:g} m is no gap"
    if isinstance(action, SlideMove) and not math.isfinite(action.height_m):
        yield "its height is not finite"
    if isinstance(action, Wait) and not (math.isfinite(action.duration_s) and action.duration_s >= 0.0):
        yield "its wait is no duration"
    if isinstance(action, NavToPose):
        fault = _pose_fault(action.T_world_base)
        if fault:
            yield f"its base pose {fault}"
    if isinstance(action, Detach):
        fault = _pose_fault(action.T_base_object)
        if fault:
            yield f"its object's pose {fault}"


def _hands(graph: MotionGoalGraph) -> Iterator[str]:
    """Attach and detach in turn for each arm, of one object. Only where it is left to the other hand may both
    hold it, and then nothing but jaws moves.
    """
    held: dict[Side, Attach] = {}
    opened: set[Side] = set()
    for index, goal in enumerate(graph.goals):
        action = goal.action
        yield from _open_jaws(goal, held, opened)
        shared = len({item.object for item in held.values()}) < len(held)
        if shared and not isinstance(action, (Grip, Detach, Wait, Confirm, SetDo, Instrument)):
            yield f"goal `{goal.id}`: it moves while two hands hold one object"
        if isinstance(action, Attach):
            if action.arm in held:
                yield f"goal `{goal.id}`: the {action.arm} hand already holds `{held[action.arm].object}`"
            other: Side | None = next(
                (arm for arm, item in held.items() if item.object == action.object), None
            )
            if other is not None and not _is_left(graph, index, other, action):
                yield f"goal `{goal.id}`: `{action.object}` is already in a hand"
            held[action.arm] = action
        elif isinstance(action, Detach):
            found = held.pop(action.arm, None)
            if found is None or found.object != action.object:
                yield f"goal `{goal.id}`: the {action.arm} hand does not hold `{action.object}`"
            holders = [in_hand(arm) for arm, item in held.items() if item.object == action.object]
            if action.place not in holders and (holders or action.place.endswith(" hand")):
                yield f"goal `{goal.id}`: `{action.object}` is not left where a hand holds it"
        elif isinstance(action, MoveTo) and isinstance(action.target, ToolTarget):
            found = held.get(action.arm) if action.arm else None
            if found is not None and found.family != action.target.family:
                yield f"goal `{goal.id}`: it aims by another family than the one it holds by"


def _open_jaws(goal: MotionGoal, held: Mapping[Side, Attach], opened: set[Side]) -> Iterator[str]:
    """A hand whose jaws were opened about its object moves on only once it has let go of that; `opened` is
    kept.
    """
    action = goal.action
    if isinstance(action, Grip):
        opened.discard(action.arm)
        if goal.kind == "open_gripper" and action.arm in held:
            opened.add(action.arm)
    elif isinstance(action, Detach):
        opened.discard(action.arm)
    elif isinstance(action, MoveTo):
        for arm in sorted(opened if action.arm is None else opened & {action.arm}):
            name = held[arm].object
            yield f"goal `{goal.id}`: the {arm} hand moves with open jaws, and still holds `{name}`"


def _is_left(graph: MotionGoalGraph, index: int, giver: Side, taken: Attach) -> bool:
    """Whether the next detach of an object is by the hand that held it first, to the one that takes it."""
    later = (goal.action for goal in graph.goals[index + 1 :])
    found = next((act for act in later if isinstance(act, Detach) and act.object == taken.object), None)
    return found is not None and found.arm == giver and found.place == in_hand(taken.arm)


def _pose_fault(pose: Pose) -> str:
    if not _finite(pose.position_m) or not all(math.isfinite(value) for value in pose.quaternion):
        return "is not finite"
    norm = math.sqrt(sum(value * value for value in pose.quaternion))
    return "" if abs(norm - 1.0) <= _UNIT else "has no unit quaternion"


def _finite(vector: Vec3) -> bool:
    return all(math.isfinite(value) for value in vector)
