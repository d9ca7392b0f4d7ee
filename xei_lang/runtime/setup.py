"""What each stage of a run puts into the trace."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from xei_lang.ir.forms import world_json
from xei_lang.ir.forms.geometry_json import pose
from xei_lang.ir.timed import TimedGoal
from xei_lang.ir.trace import RuntimeFeedback
from xei_lang.runtime.handoffs import Handoffs
from xei_lang.runtime.safety import Passed
from xei_lang.runtime.state import RunState


def scene(given: Handoffs, executor: str, speed: float) -> dict[str, Any]:
    """The frames and bounds that the run uses, and how well they are known."""
    calibration, robot = given.profile.calibration, given.world.robot
    station = next((item for item in calibration.stations if item.name == robot.station), None)
    table = station.ground_frame if station else ""
    lower, upper = calibration.workspace_bounds_m
    return {
        "executor": executor,
        "speed": speed,
        "profile": given.profile.name,
        "station": {"name": robot.station, "T_world_base": pose(robot.T_world_base)},
        "map_frame": calibration.map_frame,
        "table_frame": _frame(given, table),
        "cameras": [
            {"name": camera.name, "status": camera.status, "frame": _frame(given, camera.frame)}
            for camera in calibration.cameras
        ],
        "workspace_bounds_m": {"frame": "robot_base", "lower": list(lower), "upper": list(upper)},
        "placeholders": [found.item for found in calibration.placeholders],
    }


def _frame(given: Handoffs, name: str) -> dict[str, Any] | None:
    frame = next((item for item in given.profile.calibration.frames if item.name == name), None)
    if frame is None:
        return None
    return {
        "name": frame.name,
        "parent": frame.parent,
        "T_parent_frame": pose(frame.T_parent_frame),
        "status": frame.status,
        "position_tolerance_m": frame.position_tolerance_m,
        "rotation_tolerance_rad": frame.rotation_tolerance_rad,
        "tolerance_as": frame.tolerance_as,
    }


def world_state(given: Handoffs) -> dict[str, Any]:
    """The world as it was grounded."""
    return {"world": world_json.to_json(given.world)}


def planning(given: Handoffs) -> dict[str, Any]:
    """The three plans in short; each hash is that of the file of the same name in a bundle."""
    plan, graph, timed = given.plan, given.graph, given.timed
    return {
        "skill_plan": {
            "protocol": plan.protocol,
            "steps": len(plan.steps),
            "skills": [step.skill for step in plan.steps if step.kind == "skill"],
            "unmapped_requests": [request.text for request in plan.unmapped_requests],
            "safety_notes": [note.text for note in plan.safety_notes],
            "sha256": given.sha256["plan.json"],
        },
        "motion_goals": {
            "goals": len(graph.goals),
            "edges": len(graph.edges),
            "epochs": [epoch.station for epoch in graph.epochs],
            "sha256": given.sha256["goals.json"],
        },
        "timed_plan": {
            "goals": len(timed.goals),
            "duration_s": timed.duration_s,
            "seed": timed.seed,
            "sha256": given.sha256["timed.json"],
        },
    }


def execution(timed: TimedGoal, executor: str, seen: Passed) -> dict[str, Any]:
    """The trajectory that an executor was given, in short, and what the safety gate saw of it."""
    return {
        "kind": timed.kind,
        "executor": executor,
        "resource": timed.resource,
        "epoch": timed.epoch,
        "start_s": timed.start_s,
        "end_s": timed.end_s,
        "joints": list(timed.joints),
        "attached": [item.object for item in timed.attached],
        "planner": timed.planner,
        "choice": timed.choice,
        "safety": seen.to_json(),
    }


def feedback(
    said: RuntimeFeedback, state: RunState | None, looked: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """What an executor said of a goal, the state after it where the goal succeeded, and of a goal that
    perceives what was seen.
    """
    value: dict[str, Any] = {"status": said.status}
    if said.message:
        value["message"] = said.message
    if said.failed_stage:
        value["failed_stage"] = said.failed_stage
    if said.representation:
        value["representation"] = said.representation
    if said.help:
        value["help"] = said.help
    if looked is not None:
        value["perception"] = dict(looked)
    if state:
        value["state"] = state.to_json()
    return value
