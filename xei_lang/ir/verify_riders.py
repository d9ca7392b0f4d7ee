"""What must hold of what rides on other objects in a MotionGoalGraph: on something else, on no circle, and
not in a hand.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from xei_lang.ir.goals import Attach, Detach, MotionGoalGraph


def rider_problems(graph: MotionGoalGraph) -> Iterator[str]:
    """Every problem of what is fastened, in the order of the goals. What rides at the start stands in the
    world, which is not asked.
    """
    carrier: dict[str, str] = {}
    for goal in graph.goals:
        action = goal.action
        if isinstance(action, Attach):
            carrier.pop(action.object, None)
        elif isinstance(action, Detach) and action.fastened_to:
            if action.place.endswith(" hand"):
                yield f"goal `{goal.id}`: `{action.object}` is left to a hand, and fastened too"
            if action.object in (action.fastened_to, *_under(action.fastened_to, carrier)):
                yield f"goal `{goal.id}`: `{action.object}` is fastened on itself"
            else:
                carrier[action.object] = action.fastened_to


def _under(name: str, carrier: Mapping[str, str]) -> Iterator[str]:
    """What an object rides on, and what that rides on, and so on; a circle never gets into `carrier`."""
    while name in carrier:
        name = carrier[name]
        yield name
