"""The same drive as a rosbag2: the same scans at the same poses as from lines."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from tests.world.bench import bench
from tests.world.map.ranging import recorded
from xei_lang.diagnostics import Diagnostic, Source
from xei_lang.world.map.bag import read_bag
from xei_lang.world.map.build_map import build_map
from xei_lang.world.map.grid import OccupancyGrid
from xei_lang.world.map.recording import Scans, read_scans

STORE = get_typestore(Stores.ROS2_HUMBLE)
T = STORE.types
START_S = 1_763_596_800  # 2025-11-20
ODOM = (0.4, -0.2, 0.3)
"""The pose of `odom` in `map`."""


def stamp(seconds: float):
    whole = math.floor(seconds)
    return T["builtin_interfaces/msg/Time"](sec=START_S + whole, nanosec=round((seconds - whole) * 1e9))


def header(seconds: float, frame: str):
    return T["std_msgs/msg/Header"](stamp=stamp(seconds), frame_id=frame)


def tf(seconds: float, parent: str, child: str, pose):
    x, y, yaw = pose
    transform = T["geometry_msgs/msg/Transform"](
        translation=T["geometry_msgs/msg/Vector3"](x=x, y=y, z=0.0),
        rotation=T["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=math.sin(yaw / 2), w=math.cos(yaw / 2)),
    )
    stamped = T["geometry_msgs/msg/TransformStamped"](
        header=header(seconds, parent), child_frame_id=child, transform=transform
    )
    return T["tf2_msgs/msg/TFMessage"](transforms=[stamped])


def scan(line: dict, head: dict):
    ranges = [math.inf if one is None else one for one in line["ranges_m"]]
    return T["sensor_msgs/msg/LaserScan"](
        header=header(line["stamp_s"], "lidar"), angle_min=head["angle_min_rad"], angle_max=3.15,
        angle_increment=head["angle_increment_rad"], time_increment=0.0, scan_time=0.1,
        range_min=head["range_min_m"], range_max=head["range_max_m"],
        ranges=np.array(ranges, dtype=np.float32), intensities=np.zeros(0, dtype=np.float32),
    )  # fmt: skip


def in_odom(pose):
    """A pose of `map` in `odom`."""
    c, s = math.cos(ODOM[2]), math.sin(ODOM[2])
    dx, dy = pose[0] - ODOM[0], pose[1] - ODOM[1]
    return (c * dx + s * dy, -s * dx + c * dy, pose[2] - ODOM[2])


def written(folder: Path, text: str, *, topic: str = "/scan", with_tf: bool = True) -> Path:
    """A bag of the recording, with the base's tf at each scan."""
    head, *lines = (json.loads(line) for line in text.splitlines())
    with Writer(folder / "drive", version=8, storage_plugin=StoragePlugin.MCAP) as bag:
        tree = "tf2_msgs/msg/TFMessage"
        kinds = {topic: "sensor_msgs/msg/LaserScan", "/tf": tree, "/tf_static": tree}
        opened = {name: bag.add_connection(name, kind, typestore=STORE) for name, kind in kinds.items()}

        def put(name: str, seconds: float, message) -> None:
            at = START_S * 10**9 + round(seconds * 1e9)
            bag.write(opened[name], at, STORE.serialize_cdr(message, kinds[name]))

        if with_tf:
            put("/tf_static", 0.0, tf(0.0, "map", "odom", ODOM))
        for line in lines:
            put(topic, line["stamp_s"], scan(line, head))
            if with_tf:
                put("/tf", line["stamp_s"], tf(line["stamp_s"], "odom", "base_link", in_odom(line["base"])))
    return folder / "drive"


def of_lines(text: str) -> Scans:
    scans, said = read_scans(Source("drive.jsonl", text), bench())
    assert scans is not None, said
    return scans


def test_a_bag_gives_the_map_that_its_lines_give(tmp_path: Path) -> None:
    text = recorded(60, noise_m=0.01)
    found, same = read_bag(written(tmp_path, text), bench()), of_lines(text)
    assert isinstance(found, Scans), found
    assert found.recorded_on == "2025-11-20"
    assert np.allclose(found.poses[:, :2], same.poses[:, :2], atol=1e-9)
    assert np.allclose(np.cos(found.poses[:, 2] - same.poses[:, 2]), 1.0)
    assert np.allclose(found.ranges_m, same.ranges_m, atol=1e-6, equal_nan=True)
    a, b = build_map(found, 0.05), build_map(same, 0.05)
    assert isinstance(a, OccupancyGrid) and isinstance(b, OccupancyGrid)
    assert (a.cells != b.cells).mean() < 0.002  # ranges are floats of 32 bits


def test_poses_are_interpolated_to_the_stamps_of_the_scans(tmp_path: Path) -> None:
    head, *lines = (json.loads(line) for line in recorded(3).splitlines())
    poses = [(0.0, 0.0, 3.0), (0.2, 0.0, -3.0), (0.4, 0.2, -3.0)]
    path = tmp_path / "drive"
    with Writer(path, version=8, storage_plugin=StoragePlugin.MCAP) as bag:
        scans = bag.add_connection("/scan", "sensor_msgs/msg/LaserScan", typestore=STORE)
        moves = bag.add_connection("/tf", "tf2_msgs/msg/TFMessage", typestore=STORE)
        for k, pose in enumerate(poses):
            message = tf(0.1 * k, "map", "base_link", pose)
            bag.write(moves, k, STORE.serialize_cdr(message, "tf2_msgs/msg/TFMessage"))
            line = {**lines[k], "stamp_s": 0.1 * k + 0.05}
            bag.write(scans, k, STORE.serialize_cdr(scan(line, head), "sensor_msgs/msg/LaserScan"))
    found = read_bag(path, bench())
    assert isinstance(found, Scans), found
    # The last scan was taken after the last transform. Turning goes the short way, over 180 degrees.
    assert len(found.poses) == 2
    yaw = math.pi
    assert math.cos(found.poses[0, 2] - yaw) == pytest.approx(1.0)
    assert found.poses[0, :2] == pytest.approx([0.1 + 0.3 * math.cos(yaw), 0.3 * math.sin(yaw)], abs=1e-9)
    assert found.poses[1, :2] == pytest.approx([0.3 + 0.3 * math.cos(-3.0), 0.1 + 0.3 * math.sin(-3.0)])


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"topic": "/other"}, "no scans of a lidar"),
        ({"with_tf": False}, "does not say where `base_link` was"),
    ],
)
def test_a_bag_that_lacks_something_is_told(tmp_path: Path, changed: dict, says: str) -> None:
    found = read_bag(written(tmp_path, recorded(3), **changed), bench())
    assert isinstance(found, Diagnostic)
    assert found.code == "XEI0667" and says in found.message


def test_a_folder_that_is_no_bag_is_told(tmp_path: Path) -> None:
    (tmp_path / "drive").mkdir()
    found = read_bag(tmp_path / "drive", bench())
    assert isinstance(found, Diagnostic) and "rosbag2" in found.message
    (tmp_path / "drive" / "metadata.yaml").write_text("nonsense: [", encoding="utf-8")
    found = read_bag(tmp_path / "drive", bench())
    assert isinstance(found, Diagnostic) and "rosbag2" in found.message
    (tmp_path / "cut").mkdir()
    whole = written(tmp_path / "cut", recorded(3))
    [mcap] = whole.glob("*.mcap")
    mcap.write_bytes(mcap.read_bytes()[:200])
    found = read_bag(whole, bench())
    assert isinstance(found, Diagnostic) and "rosbag2" in found.message
