"""What a run knows of the robot between two goals, and how each goal changes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from xei_lang.ir.goals import Attach, Detach, Grip, MotionGoal, NavToPose, Perceive, SetDo
from xei_lang.ir.timed import TimedGoal
from xei_lang.runtime.handoffs import Handoffs


@dataclass(frozen=True, slots=True)
class RunState:
    """Joints (rad, m), what each hand holds (absent: nothing), the arms with closed jaws, outputs, the epoch.

    `perceived` lists the epochs in which a perception has run.
    """

    joints: Mapping[str, float]
    holding: Mapping[str, str]
    closed: tuple[str, ...] = ()
    outputs: tuple[tuple[str, bool], ...] = ()
    epoch: int = 0
    perceived: tuple[int, ...] = ()

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
    return RunState(joints, holding, closed=tuple(sorted(holding)), epoch=epoch)


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
            state = replace(state, holding={**state.holding, arm: name})
        case Detach(arm=arm):
            state = replace(state, holding={key: item for key, item in state.holding.items() if key != arm})
        case SetDo(output=output, value=value):
            state = replace(state, outputs=tuple(sorted({**dict(state.outputs), output: value}.items())))
        case NavToPose():
            state = replace(state, epoch=state.epoch + 1)
        case Perceive():
            state = replace(state, perceived=(*state.perceived, state.epoch))
        case _:
            pass
    return state
