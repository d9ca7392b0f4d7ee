"""An `await` ends no sooner than the instrument can have done its work."""

from __future__ import annotations

from xei_lang.ir.goals import Instrument
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.context import Context


def check_runs(context: Context) -> None:
    """For each run that is awaited: the time from its start to the end of the `await`, less its pauses, is at
    least its working time.
    """
    runs: dict[str, list[tuple[Instrument, TimedGoal]]] = {}
    for goal in context.plan.goals:
        planned = context.planned(goal)
        if planned is not None and isinstance(planned.action, Instrument) and planned.action.event:
            runs.setdefault(planned.action.run, []).append((planned.action, goal))
    for events in runs.values():
        _check_run(context, events)


def _check_run(context: Context, events: list[tuple[Instrument, TimedGoal]]) -> None:
    starts = [goal.end_s for action, goal in events if action.event == "start"]
    pauses = [goal.start_s for action, goal in events if action.event == "pause"]
    resumes = [goal.end_s for action, goal in events if action.event == "resume"]
    for action, goal in events:
        if action.event != "await":
            continue
        worked_s = goal.end_s - min(starts, default=goal.end_s)
        worked_s -= sum(resume - pause for pause, resume in zip(pauses, resumes, strict=False))
        if worked_s < action.work_s - context.options.time_tolerance_s:
            text = f"it ends before `{action.instrument}` has done its work"
            context.found(
                "schedule",
                goal,
                goal.end_s,
                action.instrument,
                text,
                value=worked_s,
                limit=action.work_s,
                unit="s",
            )
