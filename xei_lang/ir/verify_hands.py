"""What must hold of the hands in a MotionGoalGraph: each takes and leaves in turn, moves on only once it has
let go of what it opened about, and aims by the family that it holds by.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import (
    Attach,
    Confirm,
    Detach,
    Grip,
    Instrument,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    SetDo,
    Wait,
    in_hand,
)
from xei_lang.ir.skill_plan import Side


def hand_problems(graph: MotionGoalGraph) -> Iterator[str]:
    """Every problem of what the hands hold, in the order of the goals.

    Only where an object is left to the other hand may both hold it, and then nothing but jaws moves.
    """
    held: dict[Side, Attach] = {}
    opened: set[Side] = set()
    for index, goal in enumerate(graph.goals):
        for text in _goal(graph, index, held, opened):
            yield f"goal `{goal.id}`: {text}"


def _goal(graph: MotionGoalGraph, index: int, held: dict[Side, Attach], opened: set[Side]) -> Iterator[str]:
    """What is wrong at one goal; what is `held`, and which jaws are `opened` about it, are kept."""
    goal = graph.goals[index]
    action = goal.action
    yield from _open_jaws(goal, held, opened)
    shared = len({item.object for item in held.values()}) < len(held)
    if shared and not isinstance(action, (Grip, Detach, Wait, Confirm, SetDo, Instrument)):
        yield "it moves while two hands hold one object"
    if isinstance(action, Attach):
        yield from _taken(graph, index, action, held)
        held[action.arm] = action
    elif isinstance(action, Detach):
        found = held.pop(action.arm, None)
        yield from _left(action, found, held)
    elif isinstance(action, MoveTo) and isinstance(action.target, ToolTarget):
        found = held.get(action.arm) if action.arm else None
        if found is not None and found.family != action.target.family:
            yield "it aims by another family than the one it holds by"


def _open_jaws(goal: MotionGoal, held: Mapping[Side, Attach], opened: set[Side]) -> Iterator[str]:
    action = goal.action
    if isinstance(action, Grip):
        opened.discard(action.arm)
        if goal.kind == "open_gripper" and action.arm in held:
            opened.add(action.arm)
    elif isinstance(action, Detach):
        opened.discard(action.arm)
    elif isinstance(action, MoveTo):
        for arm in sorted(opened if action.arm is None else opened & {action.arm}):
            yield f"the {arm} hand moves with open jaws, and still holds `{held[arm].object}`"


def _taken(graph: MotionGoalGraph, index: int, taken: Attach, held: Mapping[Side, Attach]) -> Iterator[str]:
    if taken.arm in held:
        yield f"the {taken.arm} hand already holds `{held[taken.arm].object}`"
    other: Side | None = next((arm for arm, item in held.items() if item.object == taken.object), None)
    if other is not None and not _is_left(graph, index, other, taken):
        yield f"`{taken.object}` is already in a hand"


def _left(left: Detach, found: Attach | None, held: Mapping[Side, Attach]) -> Iterator[str]:
    """What is wrong where a hand lets go: `found` is what it held, `held` what the hands hold then."""
    if found is None or found.object != left.object:
        yield f"the {left.arm} hand does not hold `{left.object}`"
    holders = [in_hand(arm) for arm, item in held.items() if item.object == left.object]
    if left.place not in holders and (holders or left.place.endswith(" hand")):
        yield f"`{left.object}` is not left where a hand holds it"


def _is_left(graph: MotionGoalGraph, index: int, giver: Side, taken: Attach) -> bool:
    """Whether the next detach of an object is by the hand that held it first, to the one that takes it."""
    later = (goal.action for goal in graph.goals[index + 1 :])
    found = next((act for act in later if isinstance(act, Detach) and act.object == taken.object), None)
    return found is not None and found.arm == giver and found.place == in_hand(taken.arm)
