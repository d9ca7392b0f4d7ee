"""How a goal sequence falls into parts: groups of chains that are chosen together, and fixed goals between
them.

A *chain* is a free move of one arm to a family of tool poses with the linear moves, stated
paths and hand actions that follow it: it is carried out at one slide height and one branch of the arm, at one
swivel angle but for stated paths. A *group* is a
run of chains of one arm between anchors (named configurations, drives, perceptions, slide moves, a change of
arm).
"""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.goals import Attach, Detach, Grip, JointTarget, MotionGoal, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Side
from xei_lang.motion.sequence.legs import Leg, legs_of


@dataclass(frozen=True, slots=True)
class Chain:
    """A free move to a family and what follows it at constant slide and branch.

    `goals[0]` is the free move; `targets` are the tool targets of the moves among `goals`, in order, and
    `speed_fractions` the speeds of these moves; `legs` the stated paths between the targets, None where the
    way is straight.
    """

    arm: Side
    family: Family
    goals: tuple[MotionGoal, ...]
    targets: tuple[ToolTarget, ...]
    speed_fractions: tuple[float, ...]
    legs: tuple[Leg | None, ...]

    @property
    def head(self) -> MotionGoal:
        """The free move that the chain begins with."""
        return self.goals[0]

    @property
    def attach(self) -> Attach | None:
        """The action that closes the hand on an object in this chain, if one does."""
        return next((goal.action for goal in self.goals if isinstance(goal.action, Attach)), None)

    @property
    def detach(self) -> Detach | None:
        """The action that leaves an object behind in this chain, if one does."""
        return next((goal.action for goal in self.goals if isinstance(goal.action, Detach)), None)

    @property
    def turns(self) -> bool:
        """Whether the reference may be turned about its z axis."""
        return self.family.symmetric and any(target.turn_reference for target in self.targets)

    @property
    def slide_free(self) -> bool:
        """Whether the free move may also move the slide."""
        return "slide" in self.head.resources


@dataclass(frozen=True, slots=True)
class Group:
    """Chains of one arm, and goals between them that move neither arm nor slide, in order."""

    arm: Side
    items: tuple[Chain | MotionGoal, ...]

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The chains among the items, in order."""
        return tuple(item for item in self.items if isinstance(item, Chain))


Part = Group | MotionGoal


def split(graph: MotionGoalGraph) -> tuple[Part, ...]:
    """The parts of the graph, in order; every goal stands in exactly one."""
    families = {family.id: family for family in graph.families}
    items = _chains(graph.goals, families)
    parts: list[Part] = []
    run: list[Chain | MotionGoal] = []
    for item in items:
        if isinstance(item, Chain) and run and _arm_of(run) == item.arm:
            run.append(item)
        elif isinstance(item, Chain):
            parts.extend(_closed(run))
            run = [item]
        elif run and not _is_anchor(item):
            run.append(item)
        else:
            parts.extend(_closed(run))
            run = []
            parts.append(item)
    return (*parts, *_closed(run))


def _chains(goals: tuple[MotionGoal, ...], families: dict[str, Family]) -> tuple[Chain | MotionGoal, ...]:
    items: list[Chain | MotionGoal] = []
    index = 0
    while index < len(goals):
        goal = goals[index]
        end = index + 1
        if _is_head(goal):
            while end < len(goals) and _continues(goals[end], goal):
                end += 1
            items.append(_chain(_without_trailing_idle(goals[index:end]), families))
            end = index + len(items[-1].goals) if isinstance(items[-1], Chain) else end
        else:
            items.append(goal)
        index = end
    return tuple(items)


def _chain(goals: tuple[MotionGoal, ...], families: dict[str, Family]) -> Chain:
    moves = [goal.action for goal in goals if isinstance(goal.action, MoveTo)]
    targets = tuple(move.target for move in moves if isinstance(move.target, ToolTarget))
    arm = moves[0].arm
    assert arm is not None
    fractions = tuple(move.speed_fraction for move in moves)
    return Chain(arm, families[targets[0].family], goals, targets, fractions, legs_of(tuple(moves)))


def _is_head(goal: MotionGoal) -> bool:
    """A move of the tool to a family; a linear one can only head a chain where nothing precedes it."""
    action = goal.action
    return isinstance(action, MoveTo) and isinstance(action.target, ToolTarget)


def _continues(goal: MotionGoal, head: MotionGoal) -> bool:
    """Whether a goal belongs to the chain of `head`: linear moves and hand actions of the same arm."""
    action, move = goal.action, head.action
    assert isinstance(move, MoveTo)
    assert isinstance(move.target, ToolTarget)
    if isinstance(action, MoveTo):
        same = isinstance(action.target, ToolTarget) and action.target.family == move.target.family
        return same and action.arm == move.arm and action.path != "free"
    if isinstance(action, (Grip, Attach, Detach)):
        return action.arm == move.arm
    return goal.kind in ("wait", "set_do", "confirm", "instrument")


def _without_trailing_idle(goals: tuple[MotionGoal, ...]) -> tuple[MotionGoal, ...]:
    """The chain up to its last move, attach or detach: what follows need not hold its scene."""
    last = max(i for i, goal in enumerate(goals) if isinstance(goal.action, (MoveTo, Attach, Detach)))
    return goals[: last + 1]


def _is_anchor(goal: MotionGoal) -> bool:
    move = goal.action
    is_named = isinstance(move, MoveTo) and isinstance(move.target, JointTarget)
    return is_named or goal.kind in ("slide_move", "nav_to_pose", "perceive")


def _arm_of(run: list[Chain | MotionGoal]) -> Side | None:
    return next((item.arm for item in run if isinstance(item, Chain)), None)


def _closed(run: list[Chain | MotionGoal]) -> tuple[Part, ...]:
    """The group that a run makes, its trailing goals without motion standing on their own."""
    arm = _arm_of(run)
    if arm is None:
        return tuple(item for item in run if isinstance(item, MotionGoal))
    last = max(i for i, item in enumerate(run) if isinstance(item, Chain))
    rest = tuple(item for item in run[last + 1 :] if isinstance(item, MotionGoal))
    return (Group(arm, tuple(run[: last + 1])), *rest)
