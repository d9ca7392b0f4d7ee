"""The plan does all goals of the graph and no others, as what they are, in an order and at times that the
graph allows."""

from __future__ import annotations

from xei_lang.ir.goals import Epoch, MotionGoal, NavToPose, Wait
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.report import Finding


def check_goals(context: Context) -> None:
    """Missing and extra goals; kind, step and resources of each as the graph has them; its epoch as drives
    have made it."""
    timed = {goal.id for goal in context.plan.goals}
    planned = {goal.id: goal for goal in context.graph.goals}
    for goal in context.graph.goals:
        if goal.id not in timed:
            text = f"goal `{goal.id}` is not in the plan"
            context.findings.append(Finding("goals", goal.id, goal.step_id, 0.0, goal.id, text))
    for goal in context.plan.goals:
        if goal.id not in planned:
            context.found(
                "goals", goal, goal.start_s, goal.id, f"goal `{goal.id}` is not in the motion goal graph"
            )
        else:
            _check_same(context, goal, planned[goal.id])


def _check_same(context: Context, goal: TimedGoal, planned: MotionGoal) -> None:
    for name, given, asked in (
        ("kind", goal.kind, planned.kind),
        ("step", goal.step_id, planned.step_id),
        ("epoch", goal.epoch, planned.epoch),
    ):
        if given != asked:
            text = f"its {name} is `{given}`, the graph says `{asked}`"
            context.found("goals", goal, goal.start_s, goal.id, text)
    for resource in planned.resources:
        if resource not in (goal.resource, *goal.resources):
            text = f"it does not occupy `{resource}`, as the graph says"
            context.found("goals", goal, goal.start_s, resource, text)
    epoch = context.timeline.starts[goal.id].scene.epoch
    if epoch != planned.epoch and not isinstance(planned.action, NavToPose):
        text = f"it runs in epoch {epoch} of the base and is planned for epoch {planned.epoch}"
        context.found("schedule", goal, goal.start_s, goal.id, text)


def check_schedule(context: Context) -> None:
    """Edges of the graph, durations, and drives that end where their epoch says that the base stands."""
    times = {goal.id: goal for goal in context.plan.goals}
    place = {goal.id: index for index, goal in enumerate(context.plan.goals)}
    slack = context.options.time_tolerance_s
    for before, after in context.graph.edges:
        first, second = times.get(before), times.get(after)
        if first is None or second is None:
            continue
        if second.start_s < first.end_s - slack or place[after] < place[before]:
            text = f"it starts at {second.start_s:.6g} s, before `{before}` has ended"
            context.found(
                "schedule",
                second,
                second.start_s,
                before,
                text,
                value=second.start_s,
                limit=first.end_s,
                unit="s",
            )
    epochs = {epoch.index: epoch for epoch in context.graph.epochs}
    for goal in context.plan.goals:
        planned = context.planned(goal)
        if planned is not None:
            _check_duration(context, goal, planned)
            _check_drive(context, goal, planned, epochs)


def _check_duration(context: Context, goal: TimedGoal, planned: MotionGoal) -> None:
    shortest = planned.min_duration_s
    if isinstance(planned.action, Wait):
        shortest = max(shortest, planned.action.duration_s)
    lasts = goal.end_s - goal.start_s
    slack = context.options.time_tolerance_s
    if lasts < shortest - slack:
        context.found(
            "schedule", goal, goal.start_s, goal.id, "it is too short", value=lasts, limit=shortest, unit="s"
        )
    if lasts > planned.max_duration_s + slack:
        context.found(
            "schedule",
            goal,
            goal.start_s,
            goal.id,
            "it is too long",
            value=lasts,
            limit=planned.max_duration_s,
            unit="s",
        )


def _check_drive(context: Context, goal: TimedGoal, planned: MotionGoal, epochs: dict[int, Epoch]) -> None:
    if not isinstance(planned.action, NavToPose):
        return
    arrived = epochs.get(context.timeline.ends[goal.id].scene.epoch)
    if arrived is not None and arrived.T_world_base != planned.action.T_world_base:
        text = f"the drive does not end where epoch {arrived.index} stands"
        context.found("goals", goal, goal.end_s, goal.id, text)
    moving = [
        other
        for other in context.plan.goals
        if other.joints and other.start_s < goal.end_s and other.end_s > goal.start_s
    ]
    for other in moving:
        text = f"joints move during the drive `{goal.id}`"
        context.found("schedule", other, max(other.start_s, goal.start_s), goal.id, text)
