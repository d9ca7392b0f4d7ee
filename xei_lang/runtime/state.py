"""What a run knows of the robot between two goals, and how each goal changes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, NavToPose, Perceive, SetDo
from xei_lang.ir.timed import TimedGoal
from xei_lang.runtime.handoffs import Handoffs


@dataclass(frozen=True, slots=True)
class RunState:
    """Joints (rad, m), what each hand holds (absent: nothing), the arms with closed jaws, outputs, the epoch.

    `perceived` lists the epochs in which a perception has run; `placed` has the epoch and the pose in the
    base's frame of then of each object that was put down. `riding` says of each object that is fastened on
    another one on which.
    """

    joints: Mapping[str, float]
    holding: Mapping[str, str]
    closed: tuple[str, ...] = ()
    outputs: tuple[tuple[str, bool], ...] = ()
    epoch: int = 0
    perceived: tuple[int, ...] = ()
    placed: Mapping[str, tuple[int, Pose]] = field(default_factory=dict[str, tuple[int, Pose]])
    riding: Mapping[str, str] = field(default_factory=dict[str, str])

    def riders(self, name: str) -> tuple[str, ...]:
        """What is fastened on an object, and on that."""
        own = [rider for rider, carrier in self.riding.items() if carrier == name]
        return tuple(found for rider in own for found in (rider, *self.riders(rider)))

    def carried(self) -> dict[str, str]:
        """All that moves with hands, and for each the object between the jaws that it moves with."""
        held = sorted(self.holding.values())
        return {found: name for name in held for found in (name, *self.riders(name))}

    def to_json(self) -> dict[str, Any]:
        """What changed with a goal, without the joints: they stand in the timed plan."""
        return {"holding": dict(self.holding), "outputs": dict(self.outputs), "epoch": self.epoch}


def initial_state(given: Handoffs) -> RunState:
    """The state before the first goal: the robot of the world, and what the plan says that its hands hold.

    Joints that the world does not report (a robot without finger sensors) are where the plan starts.
    """
    joints = {**dict(given.timed.start), **dict(given.world.robot.joints)}
    holding = {
        fact.subject: name
        for fact in given.plan.initial_state
        if fact.variable == "holding" and (name := getattr(fact.value, "name", ""))
    }
    epoch = given.graph.epochs[0].index if given.graph.epochs else 0
    riding = {item.name: item.fastened_to for item in given.world.objects if item.fastened_to}
    return RunState(joints, holding, closed=tuple(sorted(holding)), epoch=epoch, riding=riding)


def after(state: RunState, goal: MotionGoal, timed: TimedGoal) -> RunState:
    """The state once a goal has succeeded."""
    if timed.samples and timed.samples.positions:
        moved = dict(zip(timed.joints, timed.samples.positions[-1], strict=True))
        state = replace(state, joints={**state.joints, **moved})
    match goal.action:
        case Grip(arm=arm):
            others = tuple(item for item in state.closed if item != arm)
            state = replace(state, closed=(*others, arm) if goal.kind == "close_gripper" else others)
        case Attach(object=name, arm=arm):
            riding = {rider: carrier for rider, carrier in state.riding.items() if rider != name}
            state = replace(state, holding={**state.holding, arm: name}, riding=riding)
        case Detach(object=name, arm=arm, fastened_to=carrier):
            put = {one.object: (state.epoch, one.T_base_object) for one in timed.placed}
            holding = {key: item for key, item in state.holding.items() if key != arm}
            riding = {**state.riding, name: carrier} if carrier else state.riding
            state = replace(state, holding=holding, placed={**state.placed, **put}, riding=riding)
        case SetDo(output=output, value=value):
            state = replace(state, outputs=tuple(sorted({**dict(state.outputs), output: value}.items())))
        case NavToPose():
            state = replace(state, epoch=state.epoch + 1)
        case Perceive():
            state = replace(state, perceived=(*state.perceived, state.epoch))
        case _:
            pass
    return state
