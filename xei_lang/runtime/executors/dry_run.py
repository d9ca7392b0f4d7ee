"""The dry run: walks every trajectory in virtual time, moves nothing, and believes nothing that it is told.

It keeps its own record of joints and hands, so that a plan whose parts do not meet fails here as it would on
the robot, whatever the checks before it say.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

from xei_lang.ir.goals import Attach, Detach, GoalKind, Instrument, MotionGoal, SetDo
from xei_lang.ir.timed import Samples, TimedGoal
from xei_lang.ir.trace import RuntimeFeedback
from xei_lang.runtime.executors.instruments import Clocks
from xei_lang.runtime.state import RunState

START_TOLERANCE = 1e-4
TIME_TOLERANCE_S = 1e-6
TRACKING_TOLERANCE = 5e-3
"""How far (rad, m) a sample may lie from where the speeds lead; further, and a joint would have to jump."""

KINDS: tuple[GoalKind, ...] = (
    "move_to", "open_gripper", "close_gripper", "set_do", "slide_move", "nav_to_pose", "wait", "perceive",
    "confirm", "attach", "detach", "instrument",
)  # fmt: skip


@dataclass(slots=True)
class DryRun:
    """An executor for plans alone."""

    joints: dict[str, float]
    holding: dict[str, str] = field(default_factory=dict[str, str])
    outputs: dict[str, bool] = field(default_factory=dict[str, bool])
    clocks: Clocks = field(default_factory=Clocks)
    stopped: bool = False
    name: str = "dry-run"
    virtual: bool = True
    kinds: tuple[GoalKind, ...] = KINDS

    @staticmethod
    def starting_at(state: RunState) -> DryRun:
        """A dry run of the robot in this state."""
        return DryRun(dict(state.joints), dict(state.holding), dict(state.outputs))

    def execute(self, goal: MotionGoal, timed: TimedGoal) -> RuntimeFeedback:
        """Walk the trajectory, then do what the goal says to hands and outputs."""
        if self.stopped:
            return _failed(goal, "the executor was stopped")
        problem = self._walk(timed) or self._act(goal, timed)
        return _failed(goal, problem) if problem else RuntimeFeedback(goal.id, "succeeded")

    def cancel(self, goal_id: str) -> RuntimeFeedback:
        """A virtual goal ends at once."""
        return RuntimeFeedback(goal_id, "cancelled")

    def stop(self) -> None:
        """Refuse every goal from here on."""
        self.stopped = True

    def _walk(self, timed: TimedGoal) -> str:
        if timed.samples is None:
            return ""
        problem = _shape(timed, timed.samples)
        if problem:
            return problem
        for joint, start in zip(timed.joints, timed.samples.positions[0], strict=True):
            at = self.joints.get(joint)
            if at is None or abs(at - start) > START_TOLERANCE:
                where = "nowhere known" if at is None else f"at {at:.4f}"
                return f"`{joint}` is {where} and the trajectory starts at {start:.4f}"
        problem = _jump(timed, timed.samples)
        if not problem:
            self.joints.update(zip(timed.joints, timed.samples.positions[-1], strict=True))
        return problem

    def _act(self, goal: MotionGoal, timed: TimedGoal) -> str:
        match goal.action:
            case Attach(object=name, arm=arm):
                if arm in self.holding:
                    return f"`{name}` cannot be taken: the {arm} hand is full"
                self.holding[arm] = name
            case Detach(object=name, arm=arm):
                if self.holding.pop(arm, None) != name:
                    return f"`{name}` is not in the {arm} hand"
            case SetDo(output=output, value=value):
                if not output:
                    return "an output without a name cannot be set"
                self.outputs[output] = value
            case Instrument() as action:
                return self.clocks.act(action, timed)
            case _:
                pass
        return ""


def _shape(timed: TimedGoal, samples: Samples) -> str:
    rows = (samples.positions, samples.velocities, samples.accelerations)
    times = samples.times_s
    if not times or any(len(part) != len(times) for part in rows):
        return "the trajectory has not one row for each time"
    if any(len(row) != len(timed.joints) for part in rows for row in part):
        return "a row of the trajectory has not one value for each joint"
    if any(after <= before for before, after in pairwise(times)):
        return "the times of the trajectory do not grow"
    if abs(times[0] - timed.start_s) > TIME_TOLERANCE_S or abs(times[-1] - timed.end_s) > TIME_TOLERANCE_S:
        return "the trajectory does not fill the time of its goal"
    return ""


def _jump(timed: TimedGoal, samples: Samples) -> str:
    for index in range(len(samples.times_s) - 1):
        dt = samples.times_s[index + 1] - samples.times_s[index]
        for column, joint in enumerate(timed.joints):
            moved = samples.positions[index + 1][column] - samples.positions[index][column]
            mean = (samples.velocities[index][column] + samples.velocities[index + 1][column]) / 2
            jump = moved - mean * dt
            if not abs(jump) <= TRACKING_TOLERANCE:
                return f"`{joint}` would have to jump by {jump:.4f} at {samples.times_s[index + 1]:.2f} s"
    return ""


def _failed(goal: MotionGoal, message: str) -> RuntimeFeedback:
    return RuntimeFeedback(goal.id, "failed", message, "hardware_execution")
