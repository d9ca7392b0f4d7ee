"""What must hold of the tool's paths in a MotionGoalGraph: stated where they must be, of sound numbers, and
leading from where the move before ends to their own target.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose, Vec3
from xei_lang.ir.goals import JointTarget, MotionGoal, MotionGoalGraph, MoveTo, PathKind
from xei_lang.ir.tool_paths import Raster, ToolPath, Turn

STATED: tuple[PathKind, ...] = ("arc", "screw", "raster")
"""The kinds of path that `MoveTo.along` describes."""

_UNIT = 1e-6
_NARROWEST_M = 1e-3
_SAME_M = 1e-6
_SAME_RAD = 1e-6


def path_problems(graph: MotionGoalGraph) -> Iterator[str]:
    """Every problem of the paths, in the order of the goals."""
    return (f"goal `{goal.id}`: {text}" for goal, text in path_faults(graph))


def path_faults(graph: MotionGoalGraph) -> Iterator[tuple[MotionGoal, str]]:
    """The problems with the goals that have them."""
    last: dict[str, MotionGoal] = {}
    for goal in graph.goals:
        move = goal.action
        if not isinstance(move, MoveTo):
            continue
        problems = [*_stated(move), *_bounds(move)]
        if not problems and move.along is not None:
            problems = [*_leads(last.get(move.arm or ""), goal, move, move.along)]
        yield from ((goal, text) for text in problems)
        for arm in ("left", "right") if move.arm is None else (move.arm,):
            last[arm] = goal


def _stated(move: MoveTo) -> Iterator[str]:
    along = move.along
    if isinstance(move.target, JointTarget) and move.path in STATED:
        yield f"a configuration is not reached on `{move.path}`"
    if along is None:
        if move.path in STATED:
            yield f"its path `{move.path}` is not described"
        return
    if move.path not in STATED or isinstance(along, Raster) != (move.path == "raster"):
        yield f"it describes another path than `{move.path}`"
    elif isinstance(along, Turn):
        yield from _turn(along, move)
    else:
        yield from _raster(along)


def _turn(along: Turn, move: MoveTo) -> Iterator[str]:
    numbers = (*along.point_m, *along.direction, along.angle_rad, along.lead_m)
    if not all(math.isfinite(value) for value in numbers):
        yield "its turn is not finite"
    elif abs(math.hypot(*along.direction) - 1.0) > _UNIT:
        yield "the direction of its axis is no unit vector"
    elif along.angle_rad == 0.0:
        yield "it turns by no angle"
    elif move.path == "arc" and along.lead_m != 0.0:
        yield "an arc has no lead"
    elif move.path == "arc" and move.keep_upright:
        yield "an arc cannot be kept upright"


def _raster(along: Raster) -> Iterator[str]:
    edges = (*along.corner_m, *along.along_m, *along.across_m, along.pitch_m)
    if not all(math.isfinite(value) for value in edges):
        yield "its raster is not finite"
        return
    length, width = math.hypot(*along.along_m), math.hypot(*along.across_m)
    dot = sum(a * b for a, b in zip(along.along_m, along.across_m, strict=True))
    if along.pitch_m <= 0.0 or length <= 0.0:
        yield "its raster has no pitch or no length"
    elif abs(dot) > _UNIT * max(length * width, _UNIT):
        yield "the edges of its raster stand at no right angle"
    elif 0.0 < along.lane_distance_m < _NARROWEST_M:
        yield "its lanes lie less than a millimetre apart"
    elif length < along.lane_distance_m:
        yield "its lanes are shorter than the half circles that join them are wide"


def _bounds(move: MoveTo) -> Iterator[str]:
    for value in (move.tool_speed_m_s, move.tool_turn_rad_s):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            yield f"its tool's speed {value:g} is no bound"


def _leads(before: MotionGoal | None, goal: MotionGoal, move: MoveTo, along: ToolPath) -> Iterator[str]:
    """Whether the path leads from the target before to its own, whichever member of the family is chosen."""
    target, start = move.target, before.action if before is not None else None
    assert isinstance(target, ToolTarget)
    if before is None or not isinstance(start, MoveTo) or not isinstance(start.target, ToolTarget):
        yield "its path begins nowhere: no move of the same tool comes before it"
        return
    origin = start.target
    if before.epoch != goal.epoch or start.arm != move.arm or origin.family != target.family:
        yield "its path begins nowhere: the move before is of another hand, stand or family"
    elif origin.offset_tool_m != target.offset_tool_m:
        yield "its path ends at another distance from the reference than it begins"
    elif not _same(along.end() @ _reference(origin), _reference(target)):
        yield "its path does not lead from the move before to its target"
    elif isinstance(along, Raster) and not _near(_reference(origin).position_m, along.corner_m):
        yield "its raster does not begin at its corner"


def _reference(target: ToolTarget) -> Pose:
    return Pose(target.offset_base_m) @ target.T_base_reference


def _near(a: Vec3, b: Vec3) -> bool:
    return math.dist(a, b) <= _SAME_M


def _same(a: Pose, b: Pose) -> bool:
    opposite = tuple(-value for value in b.quaternion)
    chord = min(math.dist(a.quaternion, b.quaternion), math.dist(a.quaternion, opposite))
    return _near(a.position_m, b.position_m) and 2.0 * chord <= _SAME_RAD
