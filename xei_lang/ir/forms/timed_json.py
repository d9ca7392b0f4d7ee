"""TimedPlan as JSON, both ways, so that a bundle on disk can be verified (schema: `timed.schema.json`).

Trajectories are exact: floats are written so that they read back as the same numbers, and `knots` stand
beside the samples. Margins are keyed by name; where a name stands twice, the later one is meant (the
verifier's word comes after the planner's).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from xei_lang.ir.forms.canonical import Json
from xei_lang.ir.forms.geometry_json import pose
from xei_lang.ir.geometry import Pose
from xei_lang.ir.timed import (
    Attachment,
    JointLimit,
    Knots,
    Margin,
    Placement,
    Row,
    Samples,
    TimedGoal,
    TimedPlan,
)


def to_json(plan: TimedPlan) -> dict[str, Json]:
    """The whole plan, goals in their order."""
    return {
        "version": 1,
        "seed": plan.seed,
        "rate_hz": plan.rate_hz,
        "duration_s": plan.duration_s,
        "solvers": dict(plan.solvers),
        "start": dict(plan.start),
        "limits": {limit.joint: _limit(limit) for limit in plan.limits},
        "margins": {margin.name: _margin(margin) for margin in plan.margins},
        "goals": [_goal(goal) for goal in plan.goals],
    }


def from_json(value: Mapping[str, Any]) -> TimedPlan:
    """The plan of a value that fits the schema. Raises KeyError, TypeError or ValueError for one that does
    not."""
    if value["version"] != 1:
        raise ValueError(f"version {value['version']!r} of a timed plan is not known")
    return TimedPlan(
        start=tuple((str(joint), float(position)) for joint, position in value["start"].items()),
        limits=tuple(JointLimit(joint=joint, **item) for joint, item in value["limits"].items()),
        goals=tuple(_read_goal(item) for item in value["goals"]),
        duration_s=value["duration_s"],
        margins=tuple(Margin(name=name, **item) for name, item in value["margins"].items()),
        seed=value["seed"],
        rate_hz=value["rate_hz"],
        solvers=tuple(value["solvers"].items()),
    )


def _limit(limit: JointLimit) -> dict[str, Json]:
    return {
        "lower": limit.lower,
        "upper": limit.upper,
        "velocity": limit.velocity,
        "acceleration": limit.acceleration,
        "torque": limit.torque,
    }


def _margin(margin: Margin) -> dict[str, Json]:
    return {
        "value": margin.value,
        "where": margin.where,
        "goal_id": margin.goal_id,
        "time_s": margin.time_s,
    }


def _goal(goal: TimedGoal) -> dict[str, Json]:
    samples = goal.samples or Samples((), (), (), ())
    attached: list[Json] = [
        {"object": item.object, "link": item.link, "T_link_object": pose(item.T_link_object)}
        for item in goal.attached
    ]
    placed: list[Json] = [
        {"object": item.object, "T_base_object": pose(item.T_base_object)} for item in goal.placed
    ]
    return {
        "id": goal.id,
        "step_id": goal.step_id,
        "kind": goal.kind,
        "resource": goal.resource,
        "resources": list(goal.resources),
        "epoch": goal.epoch,
        "start_s": goal.start_s,
        "end_s": goal.end_s,
        "arm": goal.arm,
        "tool": None if goal.tool is None else pose(goal.tool),
        "choice": goal.choice,
        "planner": goal.planner,
        "attached": attached,
        "allowed_contacts": [list(pair) for pair in goal.allowed_contacts],
        "placed": placed,
        "joints": list(goal.joints),
        "times_s": list(samples.times_s),
        "positions": _lists(samples.positions),
        "velocities": _lists(samples.velocities),
        "accelerations": _lists(samples.accelerations),
        "knots": None if goal.knots is None else _knots(goal.knots),
    }


def _lists(rows: tuple[Row, ...]) -> list[Json]:
    return [list(row) for row in rows]


def _knots(knots: Knots) -> dict[str, Json]:
    return {
        "breaks": list(knots.breaks),
        "coefficients": [_lists(piece) for piece in knots.coefficients],
        "times_s": list(knots.times_s),
        "s": list(knots.s),
        "ds": list(knots.ds),
        "dds": list(knots.dds),
    }


def _read_pose(value: Mapping[str, Any]) -> Pose:
    return Pose(_triple(value["position_m"]), tuple(value["quaternion"]))


def _triple(value: Any) -> tuple[float, float, float]:
    x, y, z = value
    return (x, y, z)


def _rows(value: Any) -> tuple[Row, ...]:
    return tuple(tuple(row) for row in value)


def _read_goal(value: Mapping[str, Any]) -> TimedGoal:
    samples = None
    if value["times_s"]:
        rows = (_rows(value[key]) for key in ("positions", "velocities", "accelerations"))
        samples = Samples(tuple(value["times_s"]), *rows)
    tool = value["tool"]
    return TimedGoal(
        id=value["id"],
        step_id=value["step_id"],
        kind=value["kind"],
        resource=value["resource"],
        resources=tuple(value["resources"]),
        epoch=value["epoch"],
        start_s=value["start_s"],
        end_s=value["end_s"],
        joints=tuple(value["joints"]),
        samples=samples,
        knots=None if value["knots"] is None else _read_knots(value["knots"]),
        attached=tuple(
            Attachment(item["object"], item["link"], _read_pose(item["T_link_object"]))
            for item in value["attached"]
        ),
        allowed_contacts=tuple((first, second) for first, second in value["allowed_contacts"]),
        placed=tuple(
            Placement(item["object"], _read_pose(item["T_base_object"])) for item in value["placed"]
        ),
        arm=value["arm"],
        tool=None if tool is None else _read_pose(tool),
        choice=value["choice"],
        planner=value["planner"],
    )


def _read_knots(value: Mapping[str, Any]) -> Knots:
    return Knots(
        breaks=tuple(value["breaks"]),
        coefficients=tuple(_rows(piece) for piece in value["coefficients"]),
        times_s=tuple(value["times_s"]),
        s=tuple(value["s"]),
        ds=tuple(value["ds"]),
        dds=tuple(value["dds"]),
    )
