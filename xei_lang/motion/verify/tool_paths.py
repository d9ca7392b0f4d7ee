"""The tool keeps to the path that its goal states (arc, screw, raster), from end to end, and to its speed.

Where the tool should be follows from where the motion begins and from the goal alone. On a turn the angle is
read off the tool's own rotation (its twist about the axis) and everything else is compared with what that
angle makes of the start. On a raster the way is the nearest point of the lanes that is not behind the last
one.
"""

from __future__ import annotations

import math

import numpy as np

from xei_lang.ir.goals import MoveTo
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.tool_paths import Raster, Turn
from xei_lang.motion.verify.context import Context
from xei_lang.motion.verify.evaluate import Array
from xei_lang.motion.verify.robot import Frames, turn

_FINE_M = 0.0005
_BACK_M = 0.002
_AHEAD_M = 0.02


def check_tool_path(
    context: Context, goal: TimedGoal, action: MoveTo, link: str, times: Array, tool: Frames
) -> None:
    """Where the tool `link` is at plan times (n,) against the goal's path and bounds."""
    rotation, origin = tool
    if isinstance(action.along, Turn):
        _check_turn(context, goal, action.along, link, times, rotation, origin)
    elif isinstance(action.along, Raster):
        _check_raster(context, goal, action.along, link, times, rotation, origin)
    _check_speed(context, goal, action, link, times, rotation, origin)


def _check_turn(
    context: Context, goal: TimedGoal, path: Turn, link: str, times: Array, rotation: Array, origin: Array
) -> None:
    axis, point = np.array(path.direction), np.array(path.point_m)
    turned = rotation @ rotation[0].T
    angle = np.unwrap(_twist(turned, axis))
    wanted = turn(axis, angle)
    along = np.outer(angle * path.lead_m / math.tau, axis)
    at_tool = point + (wanted @ (origin[0] - point)) + along
    at_axis = origin + (turned @ (point - origin[0]))
    off = np.maximum(
        np.linalg.norm(origin - at_tool, axis=1), np.linalg.norm(at_axis - point - along, axis=1)
    )
    _note_off(context, goal, link, times, off)
    _note_turned(context, goal, link, times, _angle(wanted.transpose(0, 2, 1) @ turned))
    progress = angle / path.angle_rad
    _note_progress(context, goal, link, times, progress, context.options.tool_path_rad / abs(path.angle_rad))


def _twist(turned: Array, axis: Array) -> Array:
    """The angle (n,) of rotations (n, 3, 3) about a unit axis, what they do beside it left aside.

    For a pure turn the skew part is 2 sin(angle) along the axis, and the trace 2 cos(angle) and what the axis
    keeps of itself.
    """
    skew = np.stack(
        [
            turned[:, 2, 1] - turned[:, 1, 2],
            turned[:, 0, 2] - turned[:, 2, 0],
            turned[:, 1, 0] - turned[:, 0, 1],
        ],
        axis=1,
    )
    kept = np.einsum("i,nij,j->n", axis, turned, axis)
    return np.arctan2(skew @ axis, np.trace(turned, axis1=1, axis2=2) - kept)


def _angle(turned: Array) -> Array:
    """The angle (n,) of rotations (n, 3, 3), from the chord between them and the identity."""
    chord = np.linalg.norm(turned - np.eye(3), axis=(1, 2))
    return 2.0 * np.arcsin(np.clip(chord / math.sqrt(8.0), 0.0, 1.0))


def _check_raster(
    context: Context, goal: TimedGoal, path: Raster, link: str, times: Array, rotation: Array, origin: Array
) -> None:
    points = raster_points(path)
    moved = origin - origin[0]
    reached, off = _followed(points - points[0], moved)
    _note_off(context, goal, link, times, off)
    _note_turned(context, goal, link, times, _angle(rotation @ rotation[0].T))
    length = _FINE_M * (len(points) - 1)
    _note_progress(context, goal, link, times, reached * _FINE_M / length, _BACK_M / length)


def raster_points(path: Raster) -> Array:
    """Points (m, 3) of the base frame on the raster's way, half a millimetre apart."""
    corner, along, across = (np.array(edge) for edge in (path.corner_m, path.along_m, path.across_m))
    length, width = float(np.linalg.norm(along)), float(np.linalg.norm(across))
    ahead, aside = along / length, across / max(width, 1e-12)
    gaps = path.lanes - 1
    radius = width / gaps / 2 if gaps else 0.0
    bends = np.linspace(0.0, math.pi, 181)
    flat: list[Array] = []
    for lane in range(path.lanes):
        y = 2 * radius * lane
        first = radius if lane else 0.0
        last = length - (radius if lane < gaps else 0.0)
        ends = np.array([[first, y], [last, y]])
        bend = np.stack([last + radius * np.sin(bends), y + radius - radius * np.cos(bends)], axis=1)
        part = np.concatenate([ends, bend]) if lane < gaps else ends
        if lane % 2:
            part[:, 0] = length - part[:, 0]
        flat.append(part)
    corners = np.concatenate(flat)
    measured = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    total = float(measured[-1])
    fine: Array = np.linspace(0.0, total, max(2, round(total / _FINE_M) + 1))
    x, y = (np.interp(fine, measured, corners[:, k]) for k in (0, 1))
    return corner + np.outer(x, ahead) + np.outer(y, aside)


def _followed(points: Array, moved: Array) -> tuple[Array, Array]:
    """How far along the points (m, 3) each place (n, 3) is, as an index, and how far off them (m)."""
    back, ahead = round(_BACK_M / _FINE_M), round(_AHEAD_M / _FINE_M)
    reached, off = np.zeros(len(moved)), np.zeros(len(moved))
    at = 0
    for row, place in enumerate(moved):
        first = max(0, at - back)
        distances = np.linalg.norm(points[first : at + ahead + 1] - place, axis=1)
        at = first + int(np.argmin(distances))
        reached[row], off[row] = at, float(distances.min())
    return reached, off


def _note_off(context: Context, goal: TimedGoal, link: str, times: Array, off: Array) -> None:
    worst, limit = int(np.argmax(off)), context.options.tool_path_m
    value, time = float(off[worst]), float(times[worst])
    context.margin("tool_path", value / limit, link, goal.id, time)
    if value > limit:
        text = f"the tool leaves its path by {value * 1e3:.3g} mm"
        context.found("tool_path", goal, time, link, text, value=value, limit=limit, unit="m")


def _note_turned(context: Context, goal: TimedGoal, link: str, times: Array, off: Array) -> None:
    worst, limit = int(np.argmax(off)), context.options.tool_path_rad
    value, time = float(off[worst]), float(times[worst])
    context.margin("tool_path_turn", value / limit, link, goal.id, time)
    if value > limit:
        text = f"the tool is turned by {math.degrees(value):.3g} deg from its path"
        context.found("tool_path", goal, time, link, text, value=value, limit=limit, unit="rad")


def _note_progress(
    context: Context, goal: TimedGoal, link: str, times: Array, share: Array, slack: float
) -> None:
    """The way (share, n) runs from start to end, never back by more than the slack."""
    behind = np.maximum.accumulate(share) - share
    row = int(np.argmax(behind))
    if behind[row] > slack:
        text = "the tool goes back on its path"
        context.found("tool_path", goal, float(times[row]), link, text, value=float(share[row]), limit=1.0)
    elif abs(float(share[-1]) - 1.0) > slack:
        text = f"the tool covers {float(share[-1]) * 100:.4g} % of its path"
        context.found("tool_path", goal, float(times[-1]), link, text, value=float(share[-1]), limit=1.0)


def _check_speed(
    context: Context, goal: TimedGoal, action: MoveTo, link: str, times: Array, rotation: Array, origin: Array
) -> None:
    steps = np.diff(times)
    if not len(steps) or not np.all(steps > 0.0):
        return
    speeds = np.linalg.norm(np.diff(origin, axis=0), axis=1) / steps
    turns = _angle(rotation[1:] @ rotation[:-1].transpose(0, 2, 1)) / steps
    for limit, values, unit in (
        (action.tool_speed_m_s, speeds, "m/s"),
        (action.tool_turn_rad_s, turns, "rad/s"),
    ):
        if limit is None:
            continue
        worst = int(np.argmax(values))
        value, time = float(values[worst]), float(times[worst])
        context.margin("tool_speed", value / limit, link, goal.id, time)
        if value > limit * context.options.tool_speed_ratio:
            text = "the tool is faster than it may be"
            context.found("tool_speed", goal, time, link, text, value=value, limit=limit, unit=unit)
