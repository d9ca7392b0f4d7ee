"""The world as the plan takes it to be at a goal: the base at its stand, and things where they were put."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from xei_lang.ir.goals import Epoch, MotionGoal
from xei_lang.ir.world import RobotState, World, WorldObject
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.state import RunState
from xei_lang.world.frames import frame_tree
from xei_lang.world.use import uses


@dataclass(frozen=True, slots=True)
class Needed:
    """An object that goals from here on rely on, before the base drives again; `confidence` is what their
    skills ask for.
    """

    name: str
    confidence: float


def expected_world(given: Handoffs, state: RunState) -> World:
    """Frames for the base's nominal pose at its stand and the joints as they are; what hands hold is left
    out, and what they put down stands where the plan put it.
    """
    epoch = _epoch(given, state.epoch)
    robot = RobotState(tuple(state.joints.items()), epoch.station, epoch.T_world_base)
    objects = tuple(_stands(given, state))
    return World(frame_tree(given.profile, robot), objects, robot, given.world.sources, given.world.drives)


def needed_here(given: Handoffs, goal: MotionGoal, frame: str, expected: World) -> tuple[Needed, ...]:
    """The objects of the steps that go on at this stand from a goal on, and what these objects stand in; the
    table that the goal's frame is of tells where its own spots are.
    """
    starts = {timed.id: timed.start_s for timed in given.timed.goals}
    steps = {
        other.step_id
        for other in given.graph.goals
        if other.epoch == goal.epoch and starts[other.id] >= starts[goal.id]
    }
    plan = replace(given.plan, steps=tuple(step for step in given.plan.steps if step.step_id in steps))
    found: dict[str, float] = {}
    for use in uses(plan, given.profile):
        for name in (use.name, holder(expected, use.name)):
            if expected.find(name) is not None and name != frame:
                found[name] = max(use.needed, found.get(name, 0.0))
    return tuple(Needed(name, confidence) for name, confidence in found.items())


def holder(world: World, name: str) -> str:
    """What an object stands in: the rack of a tube; empty for what stands in nothing that has places."""
    item = world.find(name)
    return item.place.partition(".")[0] if item is not None else ""


def stood(given: Handoffs, state: RunState, name: str) -> WorldObject | None:
    """An object where it stood last: before it was taken up, if it was."""
    item = given.world.find(name)
    return None if item is None else _standing(given, state, item)


def _stands(given: Handoffs, state: RunState) -> Iterator[WorldObject]:
    carried = state.carried()
    for item in given.world.objects:
        if item.name not in carried:
            yield _standing(given, state, item)


def _standing(given: Handoffs, state: RunState, item: WorldObject) -> WorldObject:
    if item.name not in state.placed:
        return item
    # What rides on another object is placed with it, time and again.
    epoch, T_base_item = state.placed[item.name]
    T_world_item = _epoch(given, epoch).T_world_base @ T_base_item
    carrier = state.riding.get(item.name, "")
    return replace(item, T_frame_object=T_world_item, frame_id="world", place="", fastened_to=carrier)


def _epoch(given: Handoffs, index: int) -> Epoch:
    return next(epoch for epoch in given.graph.epochs if epoch.index == index)
