"""A rosbag2 with MCAP storage of a timed plan, for ROS 2 Humble.

Topics: `/xei/plan` (std_msgs/String, the skill plan as JSON), `/joint_states` (sensor_msgs/JointState,
100 Hz, every joint of the plan) and, for each goal and each controller that it needs, a
trajectory_msgs/JointTrajectory on `/<controller>/joint_trajectory`. Stamps count from a fixed instant, so
that a plan always gives the same bytes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from xei_lang.export.resample import states_at
from xei_lang.ir.timed import Samples, TimedGoal, TimedPlan

START_NS = 1_577_836_800 * 10**9
"""Time zero of the plan in the bag: 2020-01-01 UTC, whenever it was written."""

RATE_HZ = 100
BAG_VERSION = 8

_ARM = re.compile(r"openarm_(left|right)_joint[1-7]")
_FINGER = re.compile(r"openarm_(left|right)_finger_joint1")

_NOTHING = np.zeros(0)

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
            points=_points(store, goal.samples, goal.start_s, chosen),
        )
        yield _stamp_ns(goal.start_s), f"/{name}/joint_trajectory", kind, message


def _points(store: Any, samples: Samples, start_s: float, columns: list[int]) -> list[Any]:
    point = store.types["trajectory_msgs/msg/JointTrajectoryPoint"]
    duration = store.types["builtin_interfaces/msg/Duration"]
    parts = (samples.positions, samples.velocities, samples.accelerations)
    rows = zip(samples.times_s, *(np.take(part, columns, axis=1) for part in parts), strict=True)
    points: list[Any] = []
    for t, position, velocity, acceleration in rows:
        sec, nanosec = divmod(round((t - start_s) * 1e9), 10**9)
        since = duration(sec=sec, nanosec=nanosec)
        points.append(point(position, velocity, acceleration, _NOTHING, since))
    return points


def _joint_states(store: Any, timed: TimedPlan) -> Iterator[Message]:
    kind = "sensor_msgs/msg/JointState"
    message, names = store.types[kind], [joint for joint, _ in timed.start]
    ticks = np.arange(math.ceil(timed.duration_s * RATE_HZ - 1e-9) + 1)
    times_s = np.minimum(ticks / RATE_HZ, timed.duration_s)
    positions, velocities = states_at(timed, times_s)
    for t, position, velocity in zip(times_s.tolist(), positions, velocities, strict=True):
        yield (
            _stamp_ns(t),
            "/joint_states",
            kind,
            message(_header(store, t), names, position, velocity, _NOTHING),
        )


def _header(store: Any, t_s: float) -> Any:
    ns = _stamp_ns(t_s)
    stamp = store.types["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
    return store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="")


def _stamp_ns(t_s: float) -> int:
    return START_NS + round(t_s * 1e9)
