from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from tests.runtime.small import handoffs
from xei_lang.export.rosbag import START_NS, controller, write_rosbag
from xei_lang.ir.timed import TimedPlan

PLAN = '{"version": 1, "protocol": "small"}\n'


def read(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Every message by topic, read by another library than the one that wrote it."""
    messages: dict[str, list[tuple[int, Any]]] = {}
    with (path / f"{path.name}.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, message, decoded in reader.iter_decoded_messages():
            messages.setdefault(channel.topic, []).append((message.log_time, decoded))
    return messages


@pytest.fixture(scope="module")
def timed() -> TimedPlan:
    return handoffs().timed


@pytest.fixture(scope="module")
def messages(timed: TimedPlan, tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[tuple[int, Any]]]:
    path = tmp_path_factory.mktemp("bag") / "rosbag"
    write_rosbag(path, timed, PLAN)
    return read(path)


def ns(seconds: float) -> int:
    return round(seconds * 1e9)


def test_the_plan_travels_with_the_motion(messages: dict[str, list[tuple[int, Any]]]) -> None:
    [(stamp, message)] = messages["/xei/plan"]
    assert (stamp, message.data) == (START_NS, PLAN)


def test_every_trajectory_reads_back_as_planned(
    timed: TimedPlan, messages: dict[str, list[tuple[int, Any]]]
) -> None:
    seen = 0
    for goal in timed.goals:
        if goal.samples is None:
            continue
        topic = f"/{controller(goal.joints[0])}/joint_trajectory"
        [message] = [item for stamp, item in messages[topic] if stamp == START_NS + ns(goal.start_s)]
        assert tuple(message.joint_names) == goal.joints
        assert [tuple(point.positions) for point in message.points] == list(goal.samples.positions)
        assert [tuple(point.velocities) for point in message.points] == list(goal.samples.velocities)
        assert [tuple(point.accelerations) for point in message.points] == list(goal.samples.accelerations)
        times = [
            point.time_from_start.sec * 10**9 + point.time_from_start.nanosec for point in message.points
        ]
        assert times == [ns(t - goal.start_s) for t in goal.samples.times_s]
        seen += 1
    assert seen == sum(len(items) for topic, items in messages.items() if topic.endswith("/joint_trajectory"))


def test_joint_states_follow_the_plan_at_100_hz(
    timed: TimedPlan, messages: dict[str, list[tuple[int, Any]]]
) -> None:
    states = messages["/joint_states"]
    assert [stamp for stamp, _ in states] == [START_NS + 10_000_000 * tick for tick in range(1801)]
    by_time = {stamp - START_NS: dict(zip(item.name, item.position, strict=True)) for stamp, item in states}
    assert by_time[0] == dict(timed.start)
    for goal in timed.goals:
        for index, t in enumerate(goal.samples.times_s if goal.samples else ()):
            assert goal.samples is not None
            expected = goal.samples.positions[index][0]
            assert by_time[10_000_000 * round(100 * t)][goal.joints[0]] == pytest.approx(expected, abs=1e-9)
    assert by_time[ns(18.0)]["slide_joint"] == 0.2


def test_between_samples_the_state_keeps_to_the_motion(timed: TimedPlan, tmp_path: Path) -> None:
    """Shifted by a third of a tick, no sample falls on a tick, and the curve is still the planned one."""
    goal = next(item for item in timed.goals if item.id == "approach")
    assert goal.samples is not None
    by = 0.01 / 3
    samples = replace(goal.samples, times_s=tuple(t + by for t in goal.samples.times_s))
    moved = replace(goal, samples=samples, start_s=goal.start_s + by, end_s=goal.end_s + by)
    write_rosbag(tmp_path / "bag", replace(timed, goals=(moved,), duration_s=3.0), PLAN)
    for stamp, item in read(tmp_path / "bag")["/joint_states"]:
        u = min(1.0, max(0.0, ((stamp - START_NS) / 1e9 - moved.start_s) / 1.5))
        at = dict(zip(item.name, item.position, strict=True))["openarm_left_joint4"]
        assert at == pytest.approx(1.2 + 0.45 * (3 * u * u - 2 * u**3), abs=1e-7)


def test_an_arm_and_the_slide_in_one_goal_go_to_two_controllers(timed: TimedPlan, tmp_path: Path) -> None:
    goal = next(item for item in timed.goals if item.id == "approach")
    assert goal.samples is not None
    samples = replace(
        goal.samples,
        positions=tuple((row[0], 0.15) for row in goal.samples.positions),
        velocities=tuple((row[0], 0.0) for row in goal.samples.velocities),
        accelerations=tuple((row[0], 0.0) for row in goal.samples.accelerations),
    )
    both = replace(goal, joints=("openarm_left_joint4", "slide_joint"), samples=samples)
    write_rosbag(tmp_path / "bag", replace(timed, goals=(both,)), PLAN)
    messages = read(tmp_path / "bag")
    [(_, arm)] = messages["/left_joint_trajectory_controller/joint_trajectory"]
    [(_, slide)] = messages["/slide_joint_trajectory_controller/joint_trajectory"]
    assert (arm.joint_names, slide.joint_names) == (["openarm_left_joint4"], ["slide_joint"])
    assert {tuple(point.positions) for point in slide.points} == {(0.15,)}


def test_controllers_have_the_names_of_the_robot() -> None:
    assert controller("openarm_right_joint7") == "right_joint_trajectory_controller"
    assert controller("openarm_left_finger_joint1") == "left_gripper_controller"
    assert controller("slide_joint") == "slide_joint_trajectory_controller"


def test_two_writes_give_the_same_bytes(timed: TimedPlan, tmp_path: Path) -> None:
    for name in ("one", "two"):
        write_rosbag(tmp_path / name / "rosbag", timed, PLAN)
    files = sorted(
        path.relative_to(tmp_path / "one") for path in (tmp_path / "one").rglob("*") if path.is_file()
    )
    assert [str(path) for path in files] == ["rosbag/metadata.yaml", "rosbag/rosbag.mcap"]
    for path in files:
        assert (tmp_path / "one" / path).read_bytes() == (tmp_path / "two" / path).read_bytes()
