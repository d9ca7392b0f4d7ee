"""One line for each handoff: what it produced, and how long that took."""

from __future__ import annotations

from xei_lang.pipeline import Handoffs, PassResult
from xei_lang.world.ground import observers


def handoff_line(result: PassResult) -> str:
    """`check    SkillPlan        2 steps, 0 unmapped requests          3 ms`."""
    name, content = _SEEN[result.pass_name](result.made)
    return line(result.pass_name, name, content, result.seconds)


def line(stage: str, name: str, content: str, seconds: float) -> str:
    """A line of the table that a compilation prints."""
    took = f"{seconds * 1000:.0f} ms" if seconds < 1.0 else f"{seconds:.2f} s"
    return f"{stage:<8} {name:<16} {content:<60} {took:>8}"


def _parsed(made: Handoffs) -> tuple[str, str]:
    assert made.module is not None
    return "Module", _count(len(made.module.items), "definition")


def _profile(made: Handoffs) -> tuple[str, str]:
    profile = made.profile
    assert profile is not None
    skills, objects = _count(len(profile.bank.skills), "skill"), _count(len(profile.objects), "object")
    return "Profile", f"{profile.name}: {skills}, {objects}"


def _plan(made: Handoffs) -> tuple[str, str]:
    plan = made.plan
    assert plan is not None
    parts = [_count(len(plan.steps), "step")]
    parts += [_count(len(plan.unmapped_requests), "unmapped request")] if plan.unmapped_requests else []
    parts += [_count(len(plan.safety_notes), "safety note")] if plan.safety_notes else []
    return "SkillPlan", ", ".join(parts)


def _world(made: Handoffs) -> tuple[str, str]:
    world = made.world
    assert world is not None
    objects, frames = _count(len(world.objects), "object"), _count(len(world.frames), "frame")
    seen = f", seen by {', '.join(asked)}" if (asked := observers(world)) else ""
    return "World", f"{objects} in {frames}, at {world.robot.station}{seen}"


def _graph(made: Handoffs) -> tuple[str, str]:
    graph = made.graph
    assert graph is not None
    grasps = sum(len(family.members) for family in graph.families)
    goals, epochs = _count(len(graph.goals), "goal"), _count(len(graph.epochs), "epoch")
    return "MotionGoalGraph", f"{goals}, {_count(grasps, 'grasp')} to choose from, {epochs}"


def _timed(made: Handoffs) -> tuple[str, str]:
    timed = made.timed
    assert timed is not None
    moving = sum(goal.knots is not None for goal in timed.goals)
    trajectories = f"{moving} trajectory" if moving == 1 else f"{moving} trajectories"
    return "TimedPlan", f"{timed.duration_s:.1f} s of motion in {trajectories}"


def _verified(made: Handoffs) -> tuple[str, str]:
    timed = made.timed
    assert timed is not None
    nearest = {margin.name: margin for margin in timed.margins}
    clearance = nearest.get("clearance")
    assert made.verified is not None
    said = f"{made.verified.configurations} configurations, no finding"
    if clearance is None:
        return "verified", said
    return "verified", f"{said}, nearest {clearance.value * 1000:.1f} mm ({clearance.where})"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


_SEEN = {
    "parse": _parsed,
    "profile": _profile,
    "check": _plan,
    "ground": _world,
    "lower": _graph,
    "motion": _timed,
    "verify": _verified,
}

SHOWN = frozenset(_SEEN)
"""The passes that make a handoff; the others only let it through."""
