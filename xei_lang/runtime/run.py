"""One run: every handoff is checked and recorded; then, goal by goal, precheck, safety gate, execution."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from xei_lang.diagnostics import Diagnostics
from xei_lang.ir.goals import Confirm, MotionGoal, Perceive
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.trace import FailedStage, RuntimeFeedback, TraceEvent
from xei_lang.runtime import consistency, setup
from xei_lang.runtime.answers import Answers
from xei_lang.runtime.executors import Executor, find_executor
from xei_lang.runtime.failure import Failure, diagnostic_json, failure
from xei_lang.runtime.grounding import NOT_GROUNDED, ground_again
from xei_lang.runtime.handoffs import TIME_TOLERANCE_S, Handoffs, check_grounding, check_scene
from xei_lang.runtime.perception import Perception
from xei_lang.runtime.prechecks import Moment, first_failure
from xei_lang.runtime.record import Recorder
from xei_lang.runtime.safety import Gate
from xei_lang.runtime.state import RunState, after, initial_state
from xei_lang.runtime.tool import Tools

Status = Literal["succeeded", "failed", "cancelled"]


@dataclass(frozen=True, slots=True)
class RunResult:
    """How a run ended. `cancelled` is a person's no to a question, and blames no handoff."""

    status: Status
    failed_stage: FailedStage | None = None
    goal_id: str = ""
    diagnostics: Diagnostics = ()
    duration_s: float = 0.0
    goals_done: int = 0


@dataclass(frozen=True, slots=True)
class _Stop:
    """Why a run ends before its plan does."""

    failure: Failure
    goal_id: str = ""
    step_id: str = ""
    declined: bool = False


def run(
    given: Handoffs,
    executor: str | Executor,
    answers: Answers,
    emit: Callable[[TraceEvent], None],
    speed: float = 1.0,
    perception: Perception | None = None,
) -> RunResult:
    """Carry the plan out and hand every event to `emit` as it happens; the last one is always of stage `end`.

    `executor` is a name of `EXECUTORS`, or one that is ready. `speed`, in (0, 1], stretches the plan's clock.
    `perception` is asked at each goal that perceives; without one the trace says that nobody was.
    A keyboard interrupt stops the executor, ends the trace as cancelled, and goes on to the caller.
    """
    course = _Course(given, answers, Recorder(emit), speed, perception)
    try:
        stop = course.prepare(executor) or course.carry_out()
    except KeyboardInterrupt:
        course.interrupt()
        raise
    return course.end(stop)


@dataclass(slots=True)
class _Course:
    """A run under way."""

    given: Handoffs
    answers: Answers
    record: Recorder
    speed: float
    perception: Perception | None = None
    executor: Executor | None = None
    running: list[TimedGoal] = field(default_factory=list[TimedGoal])
    done: int = 0
    looked: dict[str, Mapping[str, Any]] = field(default_factory=dict[str, Mapping[str, Any]])

    def prepare(self, wanted: str | Executor) -> _Stop | None:
        """Record and check the handoffs, in the order in which they were made."""
        given, name = self.given, wanted if isinstance(wanted, str) else wanted.name
        self.record.add("scene_setup", setup.scene(given, name, self.speed))
        found = check_scene(given)
        if found is None:
            self.record.add("world_state", setup.world_state(given))
            found = check_grounding(given)
        if found is None:
            self.record.add("planning", setup.planning(given))
            found = (
                consistency.check_plans(given) or consistency.check_parameters(given) or self._route(wanted)
            )
        return _Stop(found) if found else None

    def _route(self, wanted: str | Executor) -> Failure | None:
        executor = find_executor(wanted, self.given) if isinstance(wanted, str) else wanted
        if isinstance(executor, Failure):
            return executor
        self.executor = executor
        for goal in self.given.graph.goals:
            if goal.kind not in executor.kinds:
                return failure(
                    "executor_routing",
                    "XEI0931",
                    f"the executor `{executor.name}` cannot carry out `{goal.kind}` of step `{goal.step_id}`",
                    goal.span,
                )
        if not 0.0 < self.speed <= 1.0:
            return failure(
                "safety_validation",
                "XEI0921",
                f"the speed {self.speed:g} is not above 0 and at most 1",
                note="a run may be slower than its plan, never faster",
            )
        return consistency.check_coverage(self.given, executor.virtual)

    def carry_out(self) -> _Stop | None:
        """Goal by goal in the order of their starts; what has ended is fed back before the next starts."""
        given = self.given
        order = {goal.id: index for index, goal in enumerate(given.graph.goals)}
        goals = {goal.id: goal for goal in given.graph.goals}
        gate = Gate(given.profile, given.world, Tools(given.urdf, given.profile.bank.arms), self.speed)
        state = initial_state(given)
        for timed in sorted(given.timed.goals, key=lambda item: (item.start_s, order[item.id])):
            state = self._finish_until(timed.start_s + TIME_TOLERANCE_S, state, goals)
            self.record.advance(timed.start_s / self.speed)
            stop = self._start(goals[timed.id], timed, state, gate)
            if stop:
                return stop
            self.running.append(timed)
        self._finish_until(float("inf"), state, goals)
        self.record.advance(given.timed.duration_s / self.speed)
        return None

    def _start(self, goal: MotionGoal, timed: TimedGoal, state: RunState, gate: Gate) -> _Stop | None:
        executor = self.executor
        assert executor is not None
        running = tuple(self.running)
        passed, found = first_failure(
            Moment(goal, timed, state, running, self.given.profile, self.given.graph)
        )
        declined = False
        if found is None and isinstance(goal.action, Confirm):
            found, declined = self._confirm(goal, goal.action)
        checked: dict[str, Any] = {"kind": goal.kind, "passed": passed}
        if found:
            checked["failed"] = diagnostic_json(found.diagnostic)
        self.record.add("precheck", checked, goal.step_id, goal.id)
        if found:
            return _Stop(found, goal.id, goal.step_id, declined)
        seen = gate.check(goal, timed, state, running)
        if isinstance(seen, Failure):
            refused = {"kind": goal.kind, "refused": diagnostic_json(seen.diagnostic)}
            self.record.add("execution", refused, goal.step_id, goal.id)
            return _Stop(seen, goal.id, goal.step_id)
        self.record.add("execution", setup.execution(timed, executor.name, seen), goal.step_id, goal.id)
        stop = self._judge(goal, executor.execute(goal, timed))
        if stop is None and isinstance(goal.action, Perceive):
            stop = self._perceive(goal, state)
        return stop

    def _perceive(self, goal: MotionGoal, state: RunState) -> _Stop | None:
        if self.perception is None:
            self.looked[goal.id] = NOT_GROUNDED
            return None
        found = ground_again(self.given, state, goal, self.perception)
        self.looked[goal.id] = found.record
        if found.failure is None or found.feedback is None:
            return None
        self._feedback(goal, found.feedback)
        return _Stop(found.failure, goal.id, goal.step_id)

    def _confirm(self, goal: MotionGoal, question: Confirm) -> tuple[Failure | None, bool]:
        answer = self.answers.answer(goal.step_id, question.text)
        if answer is None:
            help = f"answer it in the file of `--answers`, under `{goal.step_id}`, or run at a terminal"
            message = f"nobody can answer `{question.text}`"
            return failure("runtime_precheck", "XEI0913", message, goal.span, help=help), False
        if not answer:
            return failure(
                "runtime_precheck", "XEI0914", f"`{question.text}` was answered no", goal.span
            ), True
        return None, False

    def _judge(self, goal: MotionGoal, feedback: RuntimeFeedback) -> _Stop | None:
        if feedback.status == "succeeded":
            return None
        self._feedback(goal, feedback)
        message = f"goal `{goal.id}` {feedback.status}: {feedback.message}"
        stage = feedback.failed_stage or "hardware_execution"
        return _Stop(failure(stage, "XEI0940", message, goal.span), goal.id, goal.step_id)

    def _finish_until(self, t_s: float, state: RunState, goals: dict[str, MotionGoal]) -> RunState:
        ended = sorted((item for item in self.running if item.end_s <= t_s), key=lambda item: item.end_s)
        for timed in ended:
            self.running.remove(timed)
            self.record.advance(timed.end_s / self.speed)
            state = after(state, goals[timed.id], timed)
            self._feedback(goals[timed.id], RuntimeFeedback(timed.id, "succeeded"), state)
            self.done += 1
        return state

    def _feedback(self, goal: MotionGoal, feedback: RuntimeFeedback, state: RunState | None = None) -> None:
        said = setup.feedback(feedback, state, self.looked.get(goal.id))
        self.record.add("feedback", said, goal.step_id, goal.id)

    def interrupt(self) -> None:
        """Stop everything and close the trace."""
        self._give_up()
        self.record.add("end", {"status": "cancelled", "interrupted": True, "goals_done": self.done})

    def end(self, stop: _Stop | None) -> RunResult:
        """The last event, and what the caller is told."""
        if stop is None:
            self.record.add("end", {"status": "succeeded", "goals_done": self.done})
            return RunResult("succeeded", duration_s=self.record.t, goals_done=self.done)
        self._give_up()
        said = {"goals_done": self.done, "diagnostic": diagnostic_json(stop.failure.diagnostic)}
        stage = None if stop.declined else stop.failure.stage
        blame = {"status": "failed", "failed_stage": stage} if stage else {"status": "cancelled"}
        self.record.add("end", {**blame, **said}, stop.step_id, stop.goal_id)
        return RunResult(
            status="failed" if stage else "cancelled",
            failed_stage=stage,
            goal_id=stop.goal_id,
            diagnostics=(stop.failure.diagnostic,),
            duration_s=self.record.t,
            goals_done=self.done,
        )

    def _give_up(self) -> None:
        if self.executor is None:
            return
        steps = {goal.id: goal for goal in self.given.graph.goals}
        for timed in self.running:
            self._feedback(steps[timed.id], self.executor.cancel(timed.id))
        self.executor.stop()
