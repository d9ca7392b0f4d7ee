"""A rosbag2 of a drive as scans: sensor_msgs/LaserScan, and tf from the map's frame to the base.

The base's pose at the stamp of a scan is interpolated between the transforms before and after it, link by
link along the tree of tf (geometry_msgs/TransformStamped, planar part). Frames have the names that the
profile gives them: the map's frame, and the robot's link that `robot_base` rides on.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader, AnyReaderError
from rosbags.typesys import Stores, get_typestore

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Pose
from xei_lang.profiles.model import Lidar, Profile
from xei_lang.world.map.grid import yaw_of
from xei_lang.world.map.recording import CODE, Scans, mounted_lidar, scans_at

MAX_GAP_NS = 500_000_000
"""Between two transforms farther apart than this nothing is interpolated."""

Planar = tuple[float, float, float]


@dataclass(slots=True)
class _Link:
    """The transforms of one frame in its parent, in the order of their stamps; one that is static holds
    always.
    """

    parent: str
    static: bool
    stamps: list[int] = field(default_factory=list[int])
    poses: list[Planar] = field(default_factory=list[Planar])

    def at(self, stamp_ns: int) -> Planar | None:
        after = bisect_left(self.stamps, stamp_ns)
        if self.static or (after < len(self.stamps) and self.stamps[after] == stamp_ns):
            return self.poses[0 if self.static else after]
        if after in (0, len(self.stamps)):
            return None
        t0, t1 = self.stamps[after - 1], self.stamps[after]
        if t1 - t0 > MAX_GAP_NS:
            return None
        (x0, y0, a0), (x1, y1, a1) = self.poses[after - 1], self.poses[after]
        part = (stamp_ns - t0) / (t1 - t0)
        turn = math.remainder(a1 - a0, math.tau)
        return (x0 + part * (x1 - x0), y0 + part * (y1 - y0), a0 + part * turn)


def read_bag(folder: Path, profile: Profile) -> Scans | Diagnostic:
    """The scans of a bag with their poses; scans before the first and behind the last transform are left out.

    The lidar is the first of the profile whose topic `scan` the bag has.
    """
    store: Any = get_typestore(Stores.ROS2_HUMBLE)
    try:
        with AnyReader([folder], default_typestore=store) as reader:
            return _read(reader, folder.name, profile)
    except (AnyReaderError, OSError, ValueError, KeyError, AssertionError) as error:
        reason = str(error).strip().splitlines()
        message = f"`{folder}` cannot be read as a rosbag2: {reason[0] if reason else type(error).__name__}"
        return Diagnostic(CODE, message, help=("name the folder with the bag's `metadata.yaml`",))


def _read(reader: AnyReader, name: str, profile: Profile) -> Scans | Diagnostic:
    lidar, links = _lidar(reader, profile), _links(reader)
    if lidar is None:
        wanted = ", ".join(f"`{dict(one.topics).get('scan', '')}`" for one in profile.calibration.lidars)
        message = f"`{name}` has no scans of a lidar of the profile"
        return Diagnostic(CODE, message, help=(f"record the topics {wanted or 'of `lidars`'}",))
    mounted = mounted_lidar(profile, lidar)
    if isinstance(mounted, Diagnostic):
        return mounted
    calibration = profile.calibration
    base = dict(calibration.robot_frames).get("robot_base", profile.robot.root)
    found = list(_scans(reader, dict(lidar.topics)["scan"]))
    posed = [(scan, pose) for scan in found if (pose := _pose(links, calibration.map_frame, base, scan[0]))]
    if not posed:
        message = f"`{name}` does not say where `{base}` was in `{calibration.map_frame}` at any scan"
        help_ = "record /tf and /tf_static while the robot is localised"
        return Diagnostic(CODE, message, help=(help_,))
    angles = posed[0][0][1]
    if any(len(scan[1]) != len(angles) or not np.allclose(scan[1], angles) for scan, _ in posed):
        return Diagnostic(CODE, f"the rays of the scans in `{name}` differ from scan to scan")
    ranges = np.stack([scan[2] for scan, _ in posed])
    day = datetime.fromtimestamp(posed[0][0][0] / 1e9, tz=UTC).date().isoformat()
    return scans_at(day, lidar.name, np.array([pose for _, pose in posed]), mounted, angles, ranges)


def _lidar(reader: AnyReader, profile: Profile) -> Lidar | None:
    kinds = {one.topic: one.msgtype for one in reader.connections}
    lidars = profile.calibration.lidars
    scan = "sensor_msgs/msg/LaserScan"
    return next((one for one in lidars if kinds.get(dict(one.topics).get("scan", "")) == scan), None)


def _scans(reader: AnyReader, topic: str) -> Iterator[tuple[int, Any, Any]]:
    """Stamp (ns), directions of the rays, and ranges with NaN where they say nothing."""
    connections = [one for one in reader.connections if one.topic == topic]
    for connection, _, data in reader.messages(connections=connections):
        scan: Any = reader.deserialize(data, connection.msgtype)
        ranges = np.array(scan.ranges, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            ranges[~((ranges >= scan.range_min) & (ranges <= scan.range_max))] = np.nan
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges), dtype=np.float64)
        yield _stamp(scan.header), angles, ranges


def _links(reader: AnyReader) -> dict[str, _Link]:
    """The tree of tf by child frame; stamps in order."""
    links: dict[str, _Link] = {}
    connections = [one for one in reader.connections if one.topic in ("/tf", "/tf_static")]
    for connection, _, data in reader.messages(connections=connections):
        message: Any = reader.deserialize(data, connection.msgtype)
        for one in message.transforms:
            child, parent = one.child_frame_id.lstrip("/"), one.header.frame_id.lstrip("/")
            link = links.setdefault(child, _Link(parent, connection.topic == "/tf_static"))
            t, q = one.transform.translation, one.transform.rotation
            stamp = _stamp(one.header)
            if link.parent == parent and (not link.stamps or stamp > link.stamps[-1]):
                link.stamps.append(stamp)
                link.poses.append((t.x, t.y, yaw_of(Pose((0.0, 0.0, 0.0), (q.x, q.y, q.z, q.w)))))
    return links


def _pose(links: dict[str, _Link], root: str, frame: str, stamp_ns: int) -> Planar | None:
    """The planar pose of a frame in the root at a time; None where tf does not tell."""
    x = y = yaw = 0.0
    for _ in range(len(links) + 1):
        if frame == root:
            return (x, y, yaw)
        link = links.get(frame)
        step = link.at(stamp_ns) if link else None
        if link is None or step is None:
            return None
        c, s = math.cos(step[2]), math.sin(step[2])
        x, y, yaw = step[0] + c * x - s * y, step[1] + s * x + c * y, step[2] + yaw
        frame = link.parent
    return None


def _stamp(header: Any) -> int:
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)
