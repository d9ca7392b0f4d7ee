"""What must hold of what rides on other objects in a MotionGoalGraph: on something else, on no circle, not in
a hand, and left where its hand has brought it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Vec3
from xei_lang.ir.goals import Attach, Detach, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Side

_SAME_M = 1e-6


def rider_problems(graph: MotionGoalGraph) -> Iterator[str]:
    """Every problem of what is fastened, in the order of the goals. What rides at the start stands in the
    world, which is not asked.
    """
    carrier: dict[str, str] = {}
    brought: dict[Side, ToolTarget] = {}
    for goal in graph.goals:
        action = goal.action
        if isinstance(action, MoveTo):
            _bring(action, brought)
        elif isinstance(action, Attach):
            carrier.pop(action.object, None)
        elif isinstance(action, Detach) and action.fastened_to:
            if action.place.endswith(" hand"):
                yield f"goal `{goal.id}`: `{action.object}` is left to a hand, and fastened too"
            there = brought.get(action.arm)
            if there is not None and math.dist(_origin(there), action.T_base_object.position_m) > _SAME_M:
                yield f"goal `{goal.id}`: `{action.object}` is fastened elsewhere than where its hand is"
            if action.object in (action.fastened_to, *_under(action.fastened_to, carrier)):
                yield f"goal `{goal.id}`: `{action.object}` is fastened on itself"
            else:
                carrier[action.object] = action.fastened_to


def _bring(move: MoveTo, brought: dict[Side, ToolTarget]) -> None:
    """Keep where each hand was last aimed; a hand that has gone to a configuration is nowhere in the base."""
    target = move.target
    if isinstance(target, ToolTarget) and move.arm is not None:
        brought[move.arm] = target
    elif move.arm is None:
        brought.clear()
    else:
        brought.pop(move.arm, None)


def _origin(target: ToolTarget) -> Vec3:
    """Where the target has the origin of the reference, in the base frame."""
    x, y, z = (a + b for a, b in zip(target.T_base_reference.position_m, target.offset_base_m, strict=True))
    return (x, y, z)


def _under(name: str, carrier: Mapping[str, str]) -> Iterator[str]:
    """What an object rides on, and what that rides on, and so on; a circle never gets into `carrier`."""
    while name in carrier:
        name = carrier[name]
        yield name
