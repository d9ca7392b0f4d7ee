"""TimedPlan as text for people: one line a goal, then the narrowest margins."""

from __future__ import annotations

from xei_lang.ir.timed import Margin, TimedGoal, TimedPlan


def to_text(plan: TimedPlan) -> str:
    """The schedule: seconds from its start, what runs on which resource, what is held, how it was planned."""
    moving = sum(goal.knots is not None for goal in plan.goals)
    head = f"timed plan: {plan.duration_s:.2f} s, {len(plan.goals)} goals, {moving} trajectories"
    head += f", seed {plan.seed}"
    solvers = [f"  {name}: {solver}" for name, solver in plan.solvers]
    epochs: list[str] = []
    epoch = -1
    for goal in plan.goals:
        if goal.epoch != epoch:
            epoch = goal.epoch
            epochs += ["", f"epoch {epoch}"]
        epochs.append(_goal(goal))
    margins = ["", "margins", *(_margin(margin) for margin in plan.margins)] if plan.margins else []
    return "\n".join([head, *solvers, *epochs, *margins]) + "\n"


def _goal(goal: TimedGoal) -> str:
    parts = [f"{goal.start_s:8.3f} .. {goal.end_s:8.3f}  {goal.id}  {goal.kind:<13}  {goal.resource:<13}"]
    if goal.choice:
        parts.append(goal.choice)
    if goal.attached:
        parts.append("holding " + ", ".join(item.object for item in goal.attached))
    if goal.placed:
        parts.append("leaves " + ", ".join(item.object for item in goal.placed))
    if goal.planner:
        parts.append(f"({goal.planner})")
    return "  ".join(parts).rstrip()


def _margin(margin: Margin) -> str:
    where = f"{margin.where}  in {margin.goal_id} at {margin.time_s:.3f} s"
    return f"  {margin.name:<14} {margin.value:8.4f}  {where}"
