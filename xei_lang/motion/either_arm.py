"""Motion planning that may change its arms: where one cannot, the other is tried before anything is refused.

Lowering chooses an arm by distances alone. The step that took the object in hand is the one to change, since
every later step follows the hand that holds it.
"""

from __future__ import annotations

from dataclasses import replace

from xei_lang.diagnostics import Diagnostic, Diagnostics
from xei_lang.ir.goals import Attach, MotionGoalGraph, MoveTo
from xei_lang.ir.skill_plan import Side, SkillPlan
from xei_lang.ir.timed import TimedPlan
from xei_lang.ir.world import World
from xei_lang.lower import lower
from xei_lang.motion.plan import Progress, Refused, RobotDescription, attempt
from xei_lang.profiles.model import Profile

ARM_MAY_HELP = ("XEI0801", "XEI0802", "XEI0803", "XEI0804", "XEI0808")


def plan_with_either_arm(
    plan: SkillPlan,
    graph: MotionGoalGraph,
    world: World,
    profile: Profile,
    description: RobotDescription,
    seed: int,
    progress: Progress | None = None,
) -> tuple[MotionGoalGraph, TimedPlan | None, Diagnostics]:
    """`plan_motion` of a lowered plan; where an arm cannot that nobody asked for, with the other one.

    Returns the graph that was planned (with other arms than the given one, where that was needed), and what
    `plan_motion` returns. A refusal says what the other arm came to. Each step changes its arm once at most.
    """
    arms: dict[str, Side] = {}
    before: dict[str, Diagnostic] = {}
    found = attempt(graph, world, profile, description, seed, progress)
    while isinstance(found, Refused):
        taken = _taken(graph, found)
        if taken is None:
            return graph, None, (found.diagnostic,)
        step, other = taken
        if step in arms:
            return graph, None, (_with_note(found.diagnostic, other, before[step]),)
        tried: dict[str, Side] = {**arms, step: other}
        changed, problems = lower(plan, profile, world, tried)
        if changed is None:
            return graph, None, (_with_note(found.diagnostic, other, problems[0]),)
        again = attempt(changed, world, profile, description, seed, progress)
        if isinstance(again, Refused) and again.goal <= found.goal:
            return graph, None, (_with_note(found.diagnostic, other, again.diagnostic),)
        if not _is_free(graph, step):
            return graph, None, (_with_help(found.diagnostic, other),)
        before[step] = found.diagnostic
        arms, graph, found = tried, changed, again
    return graph, found, ()


def _taken(graph: MotionGoalGraph, refused: Refused) -> tuple[str, Side] | None:
    """The step that takes in hand what the failing goal is about, and the arm that it does not use."""
    failing = graph.goals[refused.goal]
    arm = failing.action.arm if isinstance(failing.action, MoveTo) else None
    if arm is None or refused.diagnostic.code not in ARM_MAY_HELP:
        return None
    last = max(i for i, goal in enumerate(graph.goals) if goal.step_id == failing.step_id)
    takes = [
        goal for goal in graph.goals[: last + 1] if isinstance(goal.action, Attach) and goal.action.arm == arm
    ]
    if not takes or _is_bound(graph, takes[-1].step_id):
        return None
    return takes[-1].step_id, "left" if arm == "right" else "right"


def _is_bound(graph: MotionGoalGraph, step: str) -> bool:
    """Whether a step takes things with both hands, one of which somebody asked for: then neither is free."""
    goals = [goal for goal in graph.goals if goal.step_id == step]
    hands = {goal.action.arm for goal in goals if isinstance(goal.action, Attach)}
    told = (item for goal in goals for item in goal.parameters)
    return len(hands) > 1 and any(item.source == "call" and item.value in ("left", "right") for item in told)


def _is_free(graph: MotionGoalGraph, step: str) -> bool:
    """Whether the arm of a step was left to the compiler."""
    told = (item for goal in graph.goals if goal.step_id == step for item in goal.parameters)
    return any(item.source == "computed" and item.value in ("left", "right") for item in told)


def _with_note(diagnostic: Diagnostic, other: Side, tried: Diagnostic) -> Diagnostic:
    note = f"the {other} arm was tried as well: {tried.message}"
    return replace(diagnostic, notes=(*diagnostic.notes, note))


def _with_help(diagnostic: Diagnostic, other: Side) -> Diagnostic:
    return replace(diagnostic, help=(f"the {other} arm can: say `arm={other}`", *diagnostic.help))
