"""A rosbag2 with MCAP storage of a timed plan, for ROS 2 Humble.

Topics: `/xei/plan` (std_msgs/String, the skill plan as JSON), `/joint_states` (sensor_msgs/JointState,
100 Hz, every joint of the plan) and, for each goal and each controller that it needs, a
trajectory_msgs/JointTrajectory on `/<controller>/joint_trajectory`. Stamps count from a fixed instant, so
that a plan always gives the same bytes.
"""

from __future__ import annotations

import math
import re
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from xei_lang.ir.timed import Samples, TimedGoal, TimedPlan

START_NS = 1_577_836_800 * 10**9
"""Time zero of the plan in the bag: 2020-01-01 UTC, whenever it was written."""

RATE_HZ = 100
BAG_VERSION = 8

_ARM = re.compile(r"openarm_(left|right)_joint[1-7]")
_FINGER = re.compile(r"openarm_(left|right)_finger_joint1")

Message = tuple[int, str, str, Any]
"""Time stamp in ns, topic, message type, message."""


def write_rosbag(path: Path, timed: TimedPlan, plan_json: str) -> None:
    """Write the folder `path`, which must not exist. Raises OSError where the disk refuses."""
    store: Any = get_typestore(Stores.ROS2_HUMBLE)
    messages = [
        _plan(store, plan_json),
        *(message for goal in timed.goals for message in _trajectories(store, goal)),
        *_joint_states(store, timed),
    ]
    messages.sort(key=lambda message: message[0])
    with Writer(path, version=BAG_VERSION, storage_plugin=StoragePlugin.MCAP) as bag:
        topics = sorted({(topic, kind) for _, topic, kind, _ in messages})
        opened = {topic: bag.add_connection(topic, kind, typestore=store) for topic, kind in topics}
        for stamp, topic, kind, message in messages:
            bag.write(opened[topic], stamp, store.serialize_cdr(message, kind))


def controller(joint: str) -> str:
    """The controller of a joint: as in openarm_bringup for arms and grippers, by its name elsewhere."""
    arm, finger = _ARM.fullmatch(joint), _FINGER.fullmatch(joint)
    if arm:
        return f"{arm[1]}_joint_trajectory_controller"
    if finger:
        return f"{finger[1]}_gripper_controller"
    return f"{joint.removesuffix('_joint')}_joint_trajectory_controller"


def _plan(store: Any, plan_json: str) -> Message:
    kind = "std_msgs/msg/String"
    return START_NS, "/xei/plan", kind, store.types[kind](data=plan_json)


def _trajectories(store: Any, goal: TimedGoal) -> Iterator[Message]:
    if goal.samples is None:
        return
    kind = "trajectory_msgs/msg/JointTrajectory"
    columns: dict[str, list[int]] = {}
    for column, joint in enumerate(goal.joints):
        columns.setdefault(controller(joint), []).append(column)
    for name, chosen in columns.items():
        message = store.types[kind](
            header=_header(store, goal.start_s),
            joint_names=[goal.joints[column] for column in chosen],
            points=[_point(store, goal, index, chosen) for index in range(len(goal.samples.times_s))],
        )
        yield _stamp_ns(goal.start_s), f"/{name}/joint_trajectory", kind, message


def _point(store: Any, goal: TimedGoal, index: int, columns: list[int]) -> Any:
    samples = goal.samples
    assert samples is not None
    ns = round((samples.times_s[index] - goal.start_s) * 1e9)
    duration = store.types["builtin_interfaces/msg/Duration"]
    return store.types["trajectory_msgs/msg/JointTrajectoryPoint"](
        positions=_row(samples.positions[index], columns),
        velocities=_row(samples.velocities[index], columns),
        accelerations=_row(samples.accelerations[index], columns),
        effort=np.zeros(0),
        time_from_start=duration(sec=ns // 10**9, nanosec=ns % 10**9),
    )


def _row(values: tuple[float, ...], columns: list[int]) -> Any:
    return np.array([values[column] for column in columns], dtype=np.float64)


def _joint_states(store: Any, timed: TimedPlan) -> Iterator[Message]:
    kind = "sensor_msgs/msg/JointState"
    start, motions = dict(timed.start), _motions(timed)
    for tick in range(math.ceil(timed.duration_s * RATE_HZ - 1e-9) + 1):
        t = min(tick / RATE_HZ, timed.duration_s)
        states = [_at(motions.get(joint, []), t, position) for joint, position in start.items()]
        message = store.types[kind](
            header=_header(store, t),
            name=list(start),
            position=np.array([position for position, _ in states], dtype=np.float64),
            velocity=np.array([velocity for _, velocity in states], dtype=np.float64),
            effort=np.zeros(0),
        )
        yield _stamp_ns(t), "/joint_states", kind, message


def _motions(timed: TimedPlan) -> dict[str, list[tuple[Samples, int]]]:
    """For each joint its trajectories in time, each with the joint's column."""
    motions: dict[str, list[tuple[Samples, int]]] = {}
    for goal in timed.goals:
        if goal.samples is not None:
            for column, joint in enumerate(goal.joints):
                motions.setdefault(joint, []).append((goal.samples, column))
    for parts in motions.values():
        parts.sort(key=lambda part: part[0].times_s[0])
    return motions


def _at(motions: list[tuple[Samples, int]], t: float, start: float) -> tuple[float, float]:
    """Position and velocity of a joint: exact at samples, cubic between two, at rest between goals."""
    latest = None
    for samples, column in motions:
        if samples.times_s[0] > t:
            break
        latest = samples, column
    if latest is None:
        return start, 0.0
    samples, column = latest
    index = bisect_right(samples.times_s, t) - 1
    p0, v0 = samples.positions[index][column], samples.velocities[index][column]
    if t == samples.times_s[index]:
        return p0, v0
    if index + 1 == len(samples.times_s):
        return p0, 0.0
    dt = samples.times_s[index + 1] - samples.times_s[index]
    u = (t - samples.times_s[index]) / dt
    p1, v1 = samples.positions[index + 1][column], samples.velocities[index + 1][column]
    a, b = 3 * (p1 - p0) - dt * (2 * v0 + v1), 2 * (p0 - p1) + dt * (v0 + v1)
    return p0 + u * (dt * v0 + u * (a + u * b)), v0 + (2 * a + 3 * b * u) * u / dt


def _header(store: Any, t_s: float) -> Any:
    ns = _stamp_ns(t_s)
    stamp = store.types["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
    return store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="")


def _stamp_ns(t_s: float) -> int:
    return START_NS + round(t_s * 1e9)
