"""Faults of what a plan says: samples, held objects, places, the schedule, numbers and lengths."""

from __future__ import annotations

import math
from dataclasses import replace

from tests.motion.verify.fault_bench import Bench, Fault, carries, free_objects
from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import Attachment, TimedGoal


def false_samples(bench: Bench) -> Fault | None:
    """One sampled number is off by at least ten times what rounding or a knot's two sides could explain."""
    goal = bench.random.choice(bench.moving)
    samples, limits = goal.samples, bench.limit(goal.joints[0])
    assert samples is not None
    row, column = bench.random.randrange(len(samples.times_s)), bench.random.randrange(len(goal.joints))
    field, off = bench.random.choice(
        [("positions", 1e-3), ("velocities", 0.05), ("accelerations", 4 * limits.acceleration)]
    )
    rows = [list(values) for values in getattr(samples, field)]
    rows[row][column] += off * bench.random.choice([1, -1])
    changed = replace(samples, **{field: tuple(map(tuple, rows))})
    return bench.fault("false samples", "samples", bench.with_goal(replace(goal, samples=changed)))


def dropped_object(bench: Bench) -> Fault | None:
    """A goal whose joints carry the hand no longer says that the hand holds something."""
    goals = [g for g in bench.moving if g.attached and carries(bench, g)]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    return bench.fault("held object dropped", "attachment", bench.with_goal(replace(goal, attached=())))


def moved_in_hand(bench: Bench) -> Fault | None:
    """The plan has the object elsewhere in the hand, by at least 4 mm, than where the hand took it."""
    goals = [g for g in bench.moving if g.attached]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    item = goal.attached[0]
    shift = Pose(tuple(bench.random.choice([1, -1]) * bench.random.uniform(0.004, 0.05) for _ in range(3)))
    moved = replace(item, T_link_object=item.T_link_object @ shift)
    return bench.fault(
        "object moved in the hand",
        "attachment",
        bench.with_goal(replace(goal, attached=(moved, *goal.attached[1:]))),
    )


def held_from_nowhere(bench: Bench) -> Fault | None:
    """A goal says that it holds an object that no goal ever takes."""
    free = free_objects(bench)
    if not free:
        return None
    goal, item = bench.random.choice(bench.moving), bench.random.choice(free)
    example = next((a for g in bench.plan.goals for a in g.attached), None)
    link = example.link if example else bench.robot.tool_links[0][1]
    attached = (*goal.attached, Attachment(item.name, link, Pose()))
    return bench.fault("held from nowhere", "attachment", bench.with_goal(replace(goal, attached=attached)))


def wrong_place(bench: Bench) -> Fault | None:
    """A detach states a pose at least 4 mm from where the hand was (a good plan states that within its
    tolerance of 2 mm)."""
    goals = [goal for goal in bench.plan.goals if goal.placed]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    shift = Pose(tuple(bench.random.choice([1, -1]) * bench.random.uniform(0.004, 0.05) for _ in range(3)))
    placed = replace(goal.placed[0], T_base_object=shift @ goal.placed[0].T_base_object)
    return bench.fault(
        "left in a wrong place",
        "placement",
        bench.with_goal(replace(goal, placed=(placed, *goal.placed[1:]))),
    )


def too_early(bench: Bench) -> Fault | None:
    """A goal starts before one that the graph has before it has ended."""
    by_id = {goal.id: goal for goal in bench.plan.goals}
    edges = [(a, b) for a, b in bench.graph.edges if by_id[a].end_s - by_id[a].start_s > 0.01]
    if not edges:
        return None
    a, b = (by_id[name] for name in bench.random.choice(edges))
    start = a.end_s - bench.random.uniform(0.1, 1.0) * (a.end_s - a.start_s)
    return bench.fault("goal too early", "schedule", bench.with_goal(_at_time(b, start)))


def swapped(bench: Bench) -> Fault | None:
    """Two goals, one before the other in the graph, change places in time."""
    by_id = {goal.id: goal for goal in bench.plan.goals}
    edges = [(a, b) for a, b in bench.graph.edges if by_id[a].end_s - by_id[a].start_s > 0.01]
    if not edges:
        return None
    a, b = (by_id[name] for name in bench.random.choice(edges))
    later = replace(bench, plan=bench.with_goal(_at_time(b, a.start_s)))
    end = a.start_s + (b.end_s - b.start_s)
    return bench.fault("goals swapped", "schedule", later.with_goal(_at_time(a, end)))


def _at_time(goal: TimedGoal, start: float) -> TimedGoal:
    shift = start - goal.start_s
    samples = goal.samples
    if samples is not None:
        samples = replace(samples, times_s=tuple(t + shift for t in samples.times_s))
    return replace(goal, start_s=start, end_s=goal.end_s + shift, samples=samples)


def ends_first(bench: Bench) -> Fault | None:
    """A goal without a trajectory ends before it starts."""
    goals = [goal for goal in bench.plan.goals if goal.knots is None and goal.end_s < bench.plan.duration_s]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    changed = replace(goal, end_s=goal.start_s - bench.random.uniform(0.001, 1.0))
    return bench.fault("ends before it starts", "schedule", bench.with_goal(changed))


def missing_goal(bench: Bench) -> Fault | None:
    """One goal of the graph is not in the plan."""
    goal = bench.random.choice(bench.plan.goals)
    goals = tuple(item for item in bench.plan.goals if item.id != goal.id)
    duration = max((item.end_s for item in goals), default=0.0)
    return bench.fault("goal missing", "goals", replace(bench.plan, goals=goals, duration_s=duration))


def extra_goal(bench: Bench) -> Fault | None:
    """The plan has a goal that the graph does not know."""
    end = bench.plan.duration_s
    goal = replace(
        bench.plan.goals[-1],
        id="nobody_asked",
        joints=(),
        knots=None,
        samples=None,
        attached=(),
        placed=(),
        tool=None,
        start_s=end,
        end_s=end,
    )
    return bench.fault("goal extra", "goals", replace(bench.plan, goals=(*bench.plan.goals, goal)))


def not_a_number(bench: Bench) -> Fault | None:
    """One number of a trajectory is NaN or infinite."""
    goal = bench.random.choice(bench.moving)
    bad = bench.random.choice([math.nan, math.inf, -math.inf])
    assert goal.knots is not None
    assert goal.samples is not None
    if bench.random.random() < 0.5:
        name = bench.random.choice(["breaks", "times_s", "s", "ds", "dds"])
        row = list(getattr(goal.knots, name))
        row[bench.random.randrange(len(row))] = bad
        changed = replace(goal, knots=replace(goal.knots, **{name: tuple(row)}))
    else:
        name = bench.random.choice(["positions", "velocities", "accelerations"])
        rows = [list(row) for row in getattr(goal.samples, name)]
        rows[bench.random.randrange(len(rows))][bench.random.randrange(len(goal.joints))] = bad
        changed = replace(goal, samples=replace(goal.samples, **{name: tuple(map(tuple, rows))}))
    return bench.fault("not a number", "non_finite", bench.with_goal(changed))


def short_rows(bench: Bench) -> Fault | None:
    """Samples or knots have a row too few."""
    goal = bench.random.choice(bench.moving)
    assert goal.knots is not None
    assert goal.samples is not None
    if bench.random.random() < 0.5:
        changed = replace(goal, knots=replace(goal.knots, ds=goal.knots.ds[:-1]))
    else:
        changed = replace(goal, samples=replace(goal.samples, velocities=goal.samples.velocities[:-1]))
    return bench.fault("a row too few", "structure", bench.with_goal(changed))
