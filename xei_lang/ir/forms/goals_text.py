"""MotionGoalGraph as text for people: a block a goal, lengths in mm, angles in degrees, families in one
line each.
"""

from __future__ import annotations

import math

from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.forms.pose_text import pose_text
from xei_lang.ir.geometry import Vec3
from xei_lang.ir.goals import (
    Action,
    Attach,
    Confirm,
    Detach,
    Epoch,
    Grip,
    Instrument,
    JointTarget,
    MotionGoal,
    MotionGoalGraph,
    MoveTo,
    NavToPose,
    Parameter,
    Perceive,
    SetDo,
    SlideMove,
    Wait,
)
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.tool_paths import Raster, ToolPath
from xei_lang.quantity.lengths import millimetres

_SHOWN_MEMBERS = 3


def to_text(graph: MotionGoalGraph) -> str:
    """The graph; of each family the cheapest members, of each goal what it does, why so, and what may
    touch.
    """
    before: dict[str, list[str]] = {}
    for earlier, later in graph.edges:
        before.setdefault(later, []).append(earlier)
    blocks = [
        "\n".join(_epoch(item) for item in graph.epochs),
        *(_family(item) for item in graph.families),
        *(_goal(goal, before.get(goal.id, [])) for goal in graph.goals),
    ]
    return "\n\n".join(blocks) + "\n"


def _epoch(item: Epoch) -> str:
    return f"epoch {item.index} at {item.station}: base {pose_text(item.T_world_base)}"


def _family(item: Family) -> str:
    lines = [f"family {item.id}: {len(item.members)} grasps{' (may be turned)' if item.symmetric else ''}"]
    lines.extend(f"  {member.cost:.3f} {member.name}" for member in item.members[:_SHOWN_MEMBERS])
    if len(item.members) > _SHOWN_MEMBERS:
        lines.append(f"  and {len(item.members) - _SHOWN_MEMBERS} more")
    return "\n".join(lines)


def _goal(goal: MotionGoal, before: list[str]) -> str:
    after = f" after {', '.join(before)}" if before else ""
    marks = f"{', provisional' if goal.provisional else ''}{_bounds(goal)}"
    lines = [f"{goal.id}: {_action(goal.kind, goal.action)}{after}"]
    lines.append(f"  epoch {goal.epoch}{marks}; uses {', '.join(goal.resources) or 'nothing'}")
    lines.extend(f"  {_parameter(item)}" for item in goal.parameters)
    if goal.allowed_contacts:
        lines.append(f"  may touch: {'; '.join(' '.join(pair) for pair in goal.allowed_contacts)}")
    return "\n".join(lines)


def _bounds(goal: MotionGoal) -> str:
    if math.isinf(goal.max_duration_s):
        return f", at least {goal.min_duration_s:g} s" if goal.min_duration_s else ""
    return f", {goal.min_duration_s:g} .. {goal.max_duration_s:g} s"


def _parameter(item: Parameter) -> str:
    source = "usage profile" if item.source == "usage_profile" else item.source
    return f"{item.name} = {item.value} ({source}{': ' + item.rule if item.rule else ''})"


def _action(kind: str, action: Action) -> str:
    if isinstance(action, MoveTo):
        return _move(action)
    if isinstance(action, Grip):
        return f"{kind} {action.arm} to {millimetres(action.opening_m)} mm"
    if isinstance(action, Attach):
        return f"attach {action.object} to {action.arm} by {action.family}"
    if isinstance(action, Detach):
        fastened = f", fastened to {action.fastened_to}" if action.fastened_to else ""
        where = f"{action.place}, {pose_text(action.T_base_object)}"
        return f"detach {action.object} from {action.arm} at {where}{fastened}"
    if isinstance(action, NavToPose):
        return f"nav_to_pose {action.station}, base {pose_text(action.T_world_base)}"
    return f"{kind} {_rest(action)}"


def _rest(action: Action) -> str:
    if isinstance(action, SetDo):
        return f"{action.output} = {str(action.value).lower()}"
    if isinstance(action, SlideMove):
        return f"{millimetres(action.height_m)} mm"
    if isinstance(action, Perceive):
        return action.frame
    if isinstance(action, Confirm):
        return f'"{action.text}"'
    if isinstance(action, Instrument):
        until = f" until {action.run} has worked {action.work_s:g} s" if action.event == "await" else ""
        return f"{action.instrument} {action.command}{until}"
    assert isinstance(action, Wait)
    return f"{action.duration_s:g} s"


def _move(action: MoveTo) -> str:
    upright = ", upright" if action.keep_upright else ""
    speed = f" at {action.speed_fraction * 100:g} %" if action.speed_fraction < 1.0 else ""
    how = f"{action.path}{_along(action.along)}{speed}{_bound(action)}{upright}"
    return f"move_to {_target(action.target, action.arm)} ({how})"


def _along(path: ToolPath | None) -> str:
    if path is None:
        return ""
    if isinstance(path, Raster):
        size = (math.hypot(*path.along_m), math.hypot(*path.across_m))
        area = " x ".join(millimetres(value) for value in size)
        return f" over {area} mm in {path.lanes} lanes from {_vector(path.corner_m)} mm"
    axis = ", ".join(f"{value:.3g}" for value in path.direction)
    lead = f", {millimetres(path.lead_m)} mm a turn" if path.lead_m else ""
    return f" by {math.degrees(path.angle_rad):.4g} deg about ({axis}) at {_vector(path.point_m)} mm{lead}"


def _bound(action: MoveTo) -> str:
    speed, turn = action.tool_speed_m_s, action.tool_turn_rad_s
    told = f", at most {millimetres(speed)} mm/s" if speed is not None else ""
    return told + (f", at most {math.degrees(turn):.4g} deg/s" if turn is not None else "")


def _vector(vector: Vec3) -> str:
    return f"({', '.join(millimetres(value) for value in vector)})"


def _target(target: ToolTarget | JointTarget, arm: Side | None) -> str:
    if isinstance(target, JointTarget):
        return f"{target.name}{' ' + arm if arm else ''} ({len(target.joints)} joints)"
    parts = [f"{arm} tool by {target.family} of {pose_text(target.T_base_reference)}"]
    if any(target.offset_base_m):
        parts.append(f"raised by ({', '.join(millimetres(value) for value in target.offset_base_m)}) mm")
    if any(target.offset_tool_m):
        parts.append(f"back by {millimetres(-target.offset_tool_m[2])} mm")
    if target.turn_reference:
        parts.append("turned as it likes")
    return ", ".join(parts)
