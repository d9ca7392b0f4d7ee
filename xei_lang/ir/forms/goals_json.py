"""MotionGoalGraph as JSON: `{"version", "epochs", "families", "goals", "edges"}` (schema:
`goals.schema.json`).

Spans count characters from 0 in their file, end excluded. A duration without a bound is `null`. Every
action carries what its dataclass in `ir/goals.py` says, under the same names; a move without a stated path
or bound of the tool has no such key, nor has a detach that fastens on nothing.
"""

from __future__ import annotations

import math

from xei_lang.diagnostics import Span
from xei_lang.ir.families import Family, ToolTarget
from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.forms.geometry_json import pose
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
from xei_lang.ir.tool_paths import ToolPath, Turn


def to_json(graph: MotionGoalGraph) -> dict[str, Json]:
    """The whole graph, goals in their topological order."""
    return {
        "version": 1,
        "epochs": [_epoch(item) for item in graph.epochs],
        "goals": [_goal(item) for item in graph.goals],
        "edges": [list(edge) for edge in graph.edges],
        "families": [_family(item) for item in graph.families],
    }


def _epoch(item: Epoch) -> dict[str, Json]:
    return {"index": item.index, "station": item.station, "T_world_base": pose(item.T_world_base)}


def _family(item: Family) -> dict[str, Json]:
    members: list[Json] = [
        {"name": member.name, "cost": member.cost, "T_reference_tool": pose(member.T_reference_tool)}
        for member in item.members
    ]
    return {
        "id": item.id,
        "reference": item.reference,
        "symmetric": item.symmetric,
        "members": members,
    }


def _goal(goal: MotionGoal) -> dict[str, Json]:
    longest = goal.max_duration_s
    return {
        "id": goal.id,
        "step_id": goal.step_id,
        "kind": goal.kind,
        "epoch": goal.epoch,
        "provisional": goal.provisional,
        "resources": list(goal.resources),
        "min_duration_s": goal.min_duration_s,
        "max_duration_s": None if math.isinf(longest) else longest,
        "action": _action(goal.action),
        "parameters": [_parameter(item) for item in goal.parameters],
        "allowed_contacts": [list(pair) for pair in goal.allowed_contacts],
        "span": _span(goal.span),
    }


def _parameter(item: Parameter) -> dict[str, Json]:
    value: dict[str, Json] = {
        "name": item.name,
        "value": item.value,
        "source": item.source,
        "rule": item.rule,
    }
    return {**value, "span": _span(item.span)} if item.span else value


def _span(span: Span) -> dict[str, Json]:
    return {"file": span.file, "start": span.start, "end": span.end}


def _action(action: Action) -> dict[str, Json]:
    if isinstance(action, MoveTo):
        return _move(action)
    if isinstance(action, Grip):
        return {"arm": action.arm, "opening_m": action.opening_m, "force_n": action.force_n}
    if isinstance(action, Attach):
        return {"object": action.object, "arm": action.arm, "family": action.family}
    if isinstance(action, Detach):
        return {
            "object": action.object,
            "arm": action.arm,
            "place": action.place,
            "T_base_object": pose(action.T_base_object),
            **({"fastened_to": action.fastened_to} if action.fastened_to else {}),
        }
    if isinstance(action, NavToPose):
        return {
            "station": action.station,
            "T_world_base": pose(action.T_world_base),
            "position_tolerance_m": action.position_tolerance_m,
            "rotation_tolerance_rad": action.rotation_tolerance_rad,
        }
    return _plain(action)


def _move(action: MoveTo) -> dict[str, Json]:
    value: dict[str, Json] = {
        "arm": action.arm,
        "path": action.path,
        "keep_upright": action.keep_upright,
        "speed_fraction": action.speed_fraction,
        "target": _target(action.target),
    }
    if action.along is not None:
        value["along"] = _tool_path(action.along)
    if action.tool_speed_m_s is not None:
        value["tool_speed_m_s"] = action.tool_speed_m_s
    if action.tool_turn_rad_s is not None:
        value["tool_turn_rad_s"] = action.tool_turn_rad_s
    return value


def _instrument(action: Instrument) -> dict[str, Json]:
    value: dict[str, Json] = {"instrument": action.instrument, "command": action.command}
    if action.event is not None:
        value.update(run=action.run, event=action.event, work_s=action.work_s)
    return value


def _tool_path(path: ToolPath) -> dict[str, Json]:
    if isinstance(path, Turn):
        return {
            "point_m": list(path.point_m),
            "direction": list(path.direction),
            "angle_rad": path.angle_rad,
            "lead_m": path.lead_m,
        }
    return {
        "corner_m": list(path.corner_m),
        "along_m": list(path.along_m),
        "across_m": list(path.across_m),
        "pitch_m": path.pitch_m,
    }


def _target(target: ToolTarget | JointTarget) -> dict[str, Json]:
    if isinstance(target, JointTarget):
        return {"configuration": target.name, "joints": dict(target.joints)}
    return {
        "family": target.family,
        "T_base_reference": pose(target.T_base_reference),
        "offset_base_m": list(target.offset_base_m),
        "offset_tool_m": list(target.offset_tool_m),
        "turn_reference": target.turn_reference,
        "position_tolerance_m": target.position_tolerance_m,
        "rotation_tolerance_rad": target.rotation_tolerance_rad,
    }


def _plain(
    action: SetDo | SlideMove | Perceive | Confirm | Instrument | Wait,
) -> dict[str, Json]:
    match action:
        case SetDo():
            return {"output": action.output, "value": action.value}
        case SlideMove():
            return {"height_m": action.height_m}
        case Perceive():
            return {"frame": action.frame}
        case Confirm():
            return {"text": action.text}
        case Instrument():
            return _instrument(action)
        case Wait():
            return {"duration_s": action.duration_s}
