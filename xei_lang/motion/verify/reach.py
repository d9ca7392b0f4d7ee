"""Each goal reaches what it was asked for: tool pose, joint target, gap between jaws, slide height, straight
line, tilt."""

from __future__ import annotations

import math

import numpy as np

from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Grip, JointTarget, MotionGoal, MoveTo, SlideMove
from xei_lang.ir.timed import TimedGoal
from xei_lang.motion.verify.context import Context, pose_error
from xei_lang.motion.verify.evaluate import Array, grid
from xei_lang.motion.verify.timeline import Held
from xei_lang.motion.verify.tool_paths import check_tool_path


def check_reached(context: Context) -> None:
    """The configuration at each goal's end against its action."""
    for goal in context.plan.goals:
        planned = context.planned(goal)
        if planned is None:
            continue
        action = planned.action
        if isinstance(action, MoveTo):
            _check_move(context, goal, action)
        elif isinstance(action, Grip):
            _check_grip(context, goal, action)
        elif isinstance(action, SlideMove):
            _check_slide(context, goal, action)
        _check_stated_tool(context, goal, planned)


def _end(context: Context, goal: TimedGoal, joint: str) -> float:
    return float(context.timeline.ends[goal.id].q[context.robot.column[joint]])


def _check_move(context: Context, goal: TimedGoal, action: MoveTo) -> None:
    if isinstance(action.target, JointTarget):
        _check_joints(context, goal, action.target)
        return
    if action.arm is None:
        context.found("goals", goal, goal.start_s, goal.id, "a move of a tool names no arm")
        return
    tool = _tool(context, goal, action.arm)
    _check_tool(context, goal, action.target, tool)
    if goal.id in context.timeline.motions:
        _check_way(context, goal, action, _tool_link(context, action.arm))


def _check_way(context: Context, goal: TimedGoal, action: MoveTo, link: str) -> None:
    """What the goal asks of its whole way, looked at in one run through it."""
    stated = action.along is not None or bool(action.tool_speed_m_s or action.tool_turn_rad_s)
    tilt_rad = context.options.upright_tilt_rad if action.keep_upright else None
    if action.path != "linear" and not stated and tilt_rad is None:
        return
    held = _in_jaws(context, goal)
    times, q = _rows(context, goal)
    frames = context.robot.frames(q, tuple(dict.fromkeys((link, *(item.link for item in held)))))
    if action.path == "linear":
        _check_line(context, goal, link, times, frames[link][1])
    if stated:
        check_tool_path(context, goal, action, link, times, frames[link])
    if tilt_rad is not None:
        for item in held:
            _check_tilt(context, goal, item, times, frames[item.link][0], bound_rad=tilt_rad)


def _tool_link(context: Context, arm: str) -> str:
    return next(link for side, link in context.about.tool_links if side == arm)


def _tool(context: Context, goal: TimedGoal, arm: str) -> Pose:
    return context.robot.pose(context.timeline.ends[goal.id].q, _tool_link(context, arm))


def _check_joints(context: Context, goal: TimedGoal, target: JointTarget) -> None:
    for joint, asked in target.joints:
        if joint not in context.robot.column:
            context.found(
                "goals", goal, goal.end_s, joint, f"`{target.name}` names `{joint}`, which is no joint"
            )
            continue
        value = _end(context, goal, joint)
        if abs(value - asked) > context.options.joint_tolerance:
            text = f"`{joint}` does not reach `{target.name}`"
            context.found("wrong_goal", goal, goal.end_s, joint, text, value=value, limit=asked)


def expected_tools(family: Family, target: ToolTarget, tool: Pose) -> list[tuple[str, Pose]]:
    """The tool poses that would do, one a member; a reference that may turn is turned nearest to `tool`."""
    T_base_reference = Pose(target.offset_base_m) @ target.T_base_reference
    back = Pose(target.offset_tool_m)
    poses: list[tuple[str, Pose]] = []
    for member in family.members:
        turned = T_base_reference
        if family.symmetric and target.turn_reference:
            T_reference_tool = member.T_reference_tool @ back
            turned = turned @ _turn_towards(T_reference_tool, T_base_reference.inverse() @ tool)
        poses.append((member.name, turned @ member.T_reference_tool @ back))
    return poses


def _turn_towards(given: Pose, wanted: Pose) -> Pose:
    """The turn about z that brings the orientation of `given` nearest to that of `wanted` (largest trace)."""
    columns = (np.array(pose.axes()).T for pose in (wanted, given))
    rotation = next(columns) @ next(columns).T
    angle = math.atan2(rotation[1, 0] - rotation[0, 1], rotation[0, 0] + rotation[1, 1])
    return Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, angle))


def _check_tool(context: Context, goal: TimedGoal, target: ToolTarget, tool: Pose) -> None:
    family = next((item for item in context.graph.families if item.id == target.family), None)
    if family is None:
        context.found("goals", goal, goal.start_s, target.family, f"no family `{target.family}` in the graph")
        return
    poses = expected_tools(family, target, tool)
    chosen = [pose for name, pose in poses if name == goal.choice] if goal.choice else [p for _, p in poses]
    if not chosen:
        text = f"the chosen `{goal.choice}` is no member of `{family.id}`"
        context.found("wrong_goal", goal, goal.end_s, family.id, text)
        return
    errors = [pose_error(pose, tool) for pose in chosen]
    distance, angle = min(
        errors, key=lambda e: max(e[0] / target.position_tolerance_m, e[1] / target.rotation_tolerance_rad)
    )
    context.margin("goal_position", distance / target.position_tolerance_m, family.id, goal.id, goal.end_s)
    context.margin("goal_rotation", angle / target.rotation_tolerance_rad, family.id, goal.id, goal.end_s)
    if distance > target.position_tolerance_m:
        text = f"the tool ends {distance * 1e3:.3g} mm from its target"
        context.found(
            "wrong_goal",
            goal,
            goal.end_s,
            family.id,
            text,
            value=distance,
            limit=target.position_tolerance_m,
            unit="m",
        )
    if angle > target.rotation_tolerance_rad:
        text = f"the tool ends turned by {math.degrees(angle):.3g} deg from its target"
        context.found(
            "wrong_goal",
            goal,
            goal.end_s,
            family.id,
            text,
            value=angle,
            limit=target.rotation_tolerance_rad,
            unit="rad",
        )


def _check_stated_tool(context: Context, goal: TimedGoal, planned: MotionGoal) -> None:
    arm = goal.arm or getattr(planned.action, "arm", None)
    if goal.tool is None or arm is None:
        return
    distance, angle = pose_error(goal.tool, _tool(context, goal, arm))
    if distance > context.options.stated_tool_m or angle > context.options.stated_tool_rad:
        text = "the plan states another tool pose than its joints reach"
        limit = context.options.stated_tool_m
        context.found(
            "wrong_goal", goal, goal.end_s, f"{arm} tool", text, value=distance, limit=limit, unit="m"
        )


def _check_grip(context: Context, goal: TimedGoal, action: Grip) -> None:
    joints = next(joints for side, joints in context.about.finger_joints if side == action.arm)
    gap = sum(_end(context, goal, joint) for joint in joints)
    if abs(gap - action.opening_m) > context.options.opening_tolerance_m:
        text = f"the jaws of the {action.arm} gripper end {gap * 1e3:.3g} mm apart"
        context.found(
            "wrong_goal",
            goal,
            goal.end_s,
            f"{action.arm} gap",
            text,
            value=gap,
            limit=action.opening_m,
            unit="m",
        )


def _check_slide(context: Context, goal: TimedGoal, action: SlideMove) -> None:
    joint = context.about.slide_joint
    height = _end(context, goal, joint) - context.robot.joints[joint].lower
    if abs(height - action.height_m) > context.options.slide_tolerance_m:
        text = f"the slide ends at {height * 1e3:.4g} mm"
        context.found(
            "wrong_goal", goal, goal.end_s, joint, text, value=height, limit=action.height_m, unit="m"
        )


def _rows(context: Context, goal: TimedGoal) -> tuple[Array, Array]:
    motion = context.timeline.motions[goal.id]
    times = grid(0.0, motion.duration_s, context.options.rate_hz)
    q = np.tile(context.timeline.starts[goal.id].q, (len(times), 1))
    known = [k for k, joint in enumerate(goal.joints) if joint in context.robot.column]
    q[:, [context.robot.column[goal.joints[k]] for k in known]] = motion.at(times)[0][:, known]
    return goal.start_s + times, q


def _check_line(context: Context, goal: TimedGoal, link: str, times: Array, points: Array) -> None:
    along = points[-1] - points[0]
    length = float(np.linalg.norm(along))
    direction = along / length if length > 1e-9 else np.zeros(3)
    travelled = np.clip((points - points[0]) @ direction, 0.0, length)
    offsets = np.linalg.norm(points - points[0] - travelled[:, None] * direction, axis=1)
    worst = int(np.argmax(offsets))
    value, time = float(offsets[worst]), float(times[worst])
    limit = context.options.linear_tolerance_m
    context.margin("linear_path", value / limit, link, goal.id, time)
    if value > limit:
        text = f"the tool leaves its straight line by {value * 1e3:.3g} mm"
        context.found("linear_path", goal, time, link, text, value=value, limit=limit, unit="m")


def _in_jaws(context: Context, goal: TimedGoal) -> list[Held]:
    """What the goal's hand holds; what rides on that moves and tilts as it does."""
    held = context.timeline.starts[goal.id].scene.held
    return [item for item in held if item.side == goal.arm and not item.rides_on]


def _check_tilt(
    context: Context, goal: TimedGoal, held: Held, times: Array, rotation: Array, *, bound_rad: float
) -> None:
    upright = np.array(held.T_link_object.axes()[2])
    tilt = np.arccos(np.clip((rotation @ upright)[:, 2], -1.0, 1.0))
    worst = int(np.argmax(tilt))
    value, time = float(tilt[worst]), float(times[worst])
    context.margin("tilt", value / bound_rad, held.object, goal.id, time)
    if value > bound_rad:
        text = f"`{held.object}` tilts"
        context.found("tilt", goal, time, held.object, text, value=value, limit=bound_rad, unit="rad")
