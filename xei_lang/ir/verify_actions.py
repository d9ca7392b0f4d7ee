"""What must hold of a goal by itself: an action of its kind, and numbers within their ranges."""

from __future__ import annotations

import math
from collections.abc import Iterator, Set

from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.goals import (
    Attach,
    Confirm,
    Detach,
    Grip,
    Instrument,
    JointTarget,
    MotionGoal,
    MoveTo,
    NavToPose,
    Perceive,
    SetDo,
    SlideMove,
    Wait,
)

_UNIT = 1e-6
_ACTION_OF_KIND: dict[str, type] = {
    "move_to": MoveTo,
    "open_gripper": Grip,
    "close_gripper": Grip,
    "set_do": SetDo,
    "slide_move": SlideMove,
    "nav_to_pose": NavToPose,
    "wait": Wait,
    "perceive": Perceive,
    "confirm": Confirm,
    "instrument": Instrument,
    "attach": Attach,
    "detach": Detach,
}


def action_faults(goal: MotionGoal, families: Set[str]) -> Iterator[str]:
    """What is wrong with the action and the durations of a goal, in words that follow its name.

    `families` are the ids of what it may aim and hold by.
    """
    if not isinstance(goal.action, _ACTION_OF_KIND.get(goal.kind, ())):
        yield f"its action does not fit the kind `{goal.kind}`"
    if not 0.0 <= goal.min_duration_s <= goal.max_duration_s:
        yield f"its durations {goal.min_duration_s:g} .. {goal.max_duration_s:g} s are no range"
    if isinstance(goal.action, MoveTo):
        yield from _move(goal.action, families)
    elif isinstance(goal.action, Attach):
        if goal.action.family not in families:
            yield f"there is no family `{goal.action.family}`"
    else:
        yield from _numbers(goal.action)


def pose_fault(pose: Pose) -> str:
    """What is wrong with the numbers of a pose, in words that follow its name; empty for a sound one."""
    if not _finite(pose.position_m) or not all(math.isfinite(value) for value in pose.quaternion):
        return "is not finite"
    norm = math.sqrt(sum(value * value for value in pose.quaternion))
    return "" if abs(norm - 1.0) <= _UNIT else "has no unit quaternion"


def _move(action: MoveTo, families: Set[str]) -> Iterator[str]:
    if not 0.0 < action.speed_fraction <= 1.0:
        yield f"its speed fraction {action.speed_fraction:g} is not in (0, 1]"
    target = action.target
    if isinstance(target, JointTarget):
        if not target.joints or not all(math.isfinite(value) for _, value in target.joints):
            yield f"its configuration `{target.name}` has no finite joints"
        return
    if target.family not in families:
        yield f"there is no family `{target.family}`"
    if action.arm is None:
        yield "it aims a tool without an arm"
    fault = pose_fault(target.T_base_reference)
    if fault:
        yield f"its reference {fault}"
    if not _finite(target.offset_base_m) or not _finite(target.offset_tool_m):
        yield "its offsets are not finite"


def _numbers(action: object) -> Iterator[str]:
    if isinstance(action, Grip) and not (math.isfinite(action.opening_m) and action.opening_m >= 0.0):
        yield f"its opening {action.opening_m:g} m is no gap"
    if isinstance(action, SlideMove) and not math.isfinite(action.height_m):
        yield "its height is not finite"
    if isinstance(action, Wait) and not (math.isfinite(action.duration_s) and action.duration_s >= 0.0):
        yield "its wait is no duration"
    if isinstance(action, NavToPose):
        fault = pose_fault(action.T_world_base)
        if fault:
            yield f"its base pose {fault}"
    if isinstance(action, Detach):
        fault = pose_fault(action.T_base_object)
        if fault:
            yield f"its object's pose {fault}"


def _finite(vector: Vec3) -> bool:
    return all(math.isfinite(value) for value in vector)
