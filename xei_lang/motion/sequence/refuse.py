"""What no planning could mend, told before any: a height or a configuration out of range, a path that has no
start or cannot be followed.
"""

from __future__ import annotations

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.goals import JointTarget, MotionGoal, MotionGoalGraph, MoveTo, SlideMove
from xei_lang.ir.verify_tool_paths import path_faults
from xei_lang.motion.sequence.blame_way import mm, who
from xei_lang.motion.sequence.context import Context


def refuse(context: Context, graph: MotionGoalGraph) -> Diagnostic | None:
    """The first goal that no planning could do; else the first path that none could."""
    before: MotionGoal | None = None
    for goal in graph.goals:
        problem = _refuse_goal(context, goal, before)
        if problem is not None:
            return problem
        before = goal
    unsound = next(path_faults(graph), None)
    return None if unsound is None else _refuse_path(*unsound)


def _refuse_path(goal: MotionGoal, fault: str) -> Diagnostic:
    return Diagnostic(
        "XEI0806",
        f"the way of {who(goal)} cannot be planned: {fault}",
        goal.span,
        "this step needs it",
        notes=("the template of the skill decides this, in the development profile",),
    )


def _refuse_goal(context: Context, goal: MotionGoal, before: MotionGoal | None) -> Diagnostic | None:
    action = goal.action
    if isinstance(action, SlideMove):
        return _out_of_range(context, goal, ((context.slide_joint, action.height_m),))
    if not isinstance(action, MoveTo):
        return None
    if isinstance(action.target, JointTarget):
        return _out_of_range(context, goal, action.target.joints)
    if action.path != "free" and not _follows(before, action):
        return Diagnostic(
            "XEI0806",
            f"a {action.path} move has nothing to start from",
            goal.span,
            "expected a free move of the same arm to the same object or place before it",
            notes=("the template of the skill decides this, in the development profile",),
        )
    return None


def _follows(before: MotionGoal | None, move: MoveTo) -> bool:
    """Whether the goal before leaves the arm where a linear move may begin: a tool move, or what the hand
    does after one.
    """
    if before is None or not isinstance(move.target, ToolTarget):
        return False
    action = before.action
    if isinstance(action, MoveTo):
        return action.arm == move.arm and isinstance(action.target, ToolTarget)
    return before.kind in (
        "open_gripper",
        "close_gripper",
        "attach",
        "detach",
        "wait",
        "set_do",
        "confirm",
        "instrument",
    )


def _out_of_range(
    context: Context, goal: MotionGoal, joints: tuple[tuple[str, float], ...]
) -> Diagnostic | None:
    for joint, value in joints:
        limit = context.limits[joint]
        if limit.lower - 1e-9 <= value <= limit.upper + 1e-9:
            continue
        if joint == context.slide_joint:
            return Diagnostic(
                "XEI0805",
                f"the slide cannot stand at {mm(value)}",
                goal.span,
                f"expected {mm(limit.lower)} .. {mm(limit.upper)}",
                notes=(f"the stroke of `{joint}` is a planning limit of the calibration profile",),
            )
        return Diagnostic(
            "XEI0807",
            f"`{joint}` cannot stand at {value:.3f} rad",
            goal.span,
            f"expected {limit.lower:.3f} .. {limit.upper:.3f} rad",
            notes=("range: planning limits of the calibration profile",),
        )
    return None
