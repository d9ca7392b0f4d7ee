"""Faults of what rides on a held object: forgotten, elsewhere, left behind, loose, or led into something."""

from __future__ import annotations

from dataclasses import replace

from tests.motion.verify.fault_bench import Bench, Fault, base_of, carries, free_objects
from tests.motion.verify.maker import evaluate
from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import Attachment, TimedGoal


def forgotten_rider(bench: Bench) -> Fault | None:
    """A goal that moves a hand does not list one of the things that ride on what it holds."""
    found = _carried(bench)
    if found is None:
        return None
    goal, item = found
    attached = tuple(other for other in goal.attached if other != item)
    return bench.fault("rider forgotten", "attachment", bench.with_goal(replace(goal, attached=attached)))


def shifted_rider(bench: Bench) -> Fault | None:
    """A rider is said to sit some millimetres from where it is fastened."""
    found = _carried(bench)
    if found is None:
        return None
    goal, item = found
    moved = replace(item, T_link_object=item.T_link_object @ _shift(bench))
    attached = tuple(moved if other == item else other for other in goal.attached)
    return bench.fault("rider elsewhere", "attachment", bench.with_goal(replace(goal, attached=attached)))


def rider_left_behind(bench: Bench) -> Fault | None:
    """Where a hand lets go, a rider is said to stand elsewhere, or nothing is said of it."""
    goals = [goal for goal in bench.plan.goals if any(item.object in _riders(bench) for item in goal.placed)]
    if not goals:
        return None
    goal = bench.random.choice(goals)
    item = bench.random.choice([item for item in goal.placed if item.object in _riders(bench)])
    others = tuple(other for other in goal.placed if other != item)
    stale = replace(item, T_base_object=item.T_base_object @ _shift(bench))
    placed = (*others, stale) if bench.random.random() < 0.5 else others
    return bench.fault("rider left behind", "placement", bench.with_goal(replace(goal, placed=placed)))


def loose_rider(bench: Bench) -> Fault | None:
    """What the plan takes to ride on something just stands there."""
    attached = {item.object for goal in bench.plan.goals for item in goal.attached}
    carried = [name for name in _riders(bench) if name in attached]
    if not carried:
        return None
    name = bench.random.choice(carried)
    objects = tuple(
        replace(item, fastened_to="") if item.name == name else item for item in bench.world.objects
    )
    return bench.fault("rider loose", "attachment", world=replace(bench.world, objects=objects))


def object_in_riders_path(bench: Bench) -> Fault | None:
    """An object that nobody holds is put where a rider passes, centre on centre: two convex shapes that share
    a point overlap."""
    found, free = _carried(bench), free_objects(bench)
    if found is None or not free:
        return None
    (goal, item), other = found, bench.random.choice(free)
    assert goal.knots is not None
    time = goal.start_s + bench.random.uniform(0.2, 0.8) * goal.knots.times_s[-1]
    rider = bench.world.find(item.object)
    assert rider is not None
    T_base_rider = bench.arm.tool(bench.joints_at(time), item.link) @ item.T_link_object
    T_world_shape = base_of(bench, goal) @ T_base_rider @ rider.geometry[0].T_object_shape
    T_world_object = Pose(T_world_shape.position_m) @ other.geometry[0].T_object_shape.inverse()
    T_frame_object = bench.world.T_world_frame(other.frame_id).inverse() @ T_world_object
    objects = tuple(
        replace(o, T_frame_object=T_frame_object) if o.name == other.name else o for o in bench.world.objects
    )
    return bench.fault("object in a rider's path", "collision", world=replace(bench.world, objects=objects))


def _riders(bench: Bench) -> list[str]:
    return [item.name for item in bench.world.objects if item.fastened_to]


def _carried(bench: Bench) -> tuple[TimedGoal, Attachment] | None:
    """A goal whose joints carry a rider, and that rider."""
    found = [
        (goal, item)
        for goal in bench.moving
        if carries(bench, goal) and _moves(goal)
        for item in goal.attached
        if item.object in _riders(bench)
    ]
    return bench.random.choice(found) if found else None


def _moves(goal: TimedGoal) -> bool:
    """Whether the joints go anywhere at all."""
    assert goal.knots is not None
    start, end = (evaluate(goal.knots, share * goal.knots.times_s[-1])[0] for share in (0.0, 1.0))
    return bool(abs(start - end).max() > 1e-6)


def _shift(bench: Bench) -> Pose:
    """5 to 20 mm along the rider's axis."""
    return Pose((0.0, 0.0, bench.random.choice((-1.0, 1.0)) * bench.random.uniform(0.005, 0.02)))
