"""Who carries out a goal. The protocol that every executor speaks, and the executors by name."""

from __future__ import annotations

from typing import Protocol

from xei_lang.diagnostics import did_you_mean
from xei_lang.ir.goals import GoalKind, MotionGoal
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.trace import RuntimeFeedback
from xei_lang.runtime.failure import Failure, failure
from xei_lang.runtime.handoffs import Handoffs

EXECUTORS = ("dry-run", "simulate", "ros2")
"""All executors that the language of plans knows."""

AVAILABLE = ("dry-run",)
"""Those that this version has."""


class Executor(Protocol):
    """Carries out goals one by one. A virtual executor moves nothing real and keeps a clock of its own."""

    @property
    def name(self) -> str:
        """The name that `--executor` takes."""
        ...

    @property
    def virtual(self) -> bool:
        """Whether nothing real moves."""
        ...

    @property
    def kinds(self) -> tuple[GoalKind, ...]:
        """The kinds of goals that it can carry out."""
        ...

    def execute(self, goal: MotionGoal, timed: TimedGoal) -> RuntimeFeedback:
        """Carry out one goal, and say how it went. Never raises for what the robot or the plan did wrong."""
        ...

    def cancel(self, goal_id: str) -> RuntimeFeedback:
        """Give up a goal that is running."""
        ...

    def stop(self) -> None:
        """Bring everything to rest; called once when a run ends early."""
        ...


def find_executor(name: str, given: Handoffs) -> Executor | Failure:
    """The executor of this name, ready at the state that the run starts from."""
    if name == "dry-run":
        from xei_lang.runtime.executors.dry_run import DryRun
        from xei_lang.runtime.state import initial_state

        return DryRun.starting_at(initial_state(given))
    if name in EXECUTORS:
        return failure(
            "executor_routing",
            "XEI0930",
            f"the executor `{name}` is not in this version",
            help="use `--executor dry-run`",
        )
    near = did_you_mean(name, EXECUTORS)
    known = ", ".join(f"`{item}`" for item in EXECUTORS)
    return failure(
        "executor_routing",
        "XEI0932",
        f"there is no executor `{name}`",
        note=f"the executors are {known}",
        help=f"did you mean `{near[0]}`?" if near else "",
    )
