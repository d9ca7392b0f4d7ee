"""A recording of lidar scans, from its lines to poses of the lidar and ranges."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from xei_lang.diagnostics import Diagnostic, Diagnostics, Source, Span, did_you_mean
from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World
from xei_lang.profiles.faults import explain
from xei_lang.profiles.model import Lidar, Profile
from xei_lang.profiles.schema.scans import ScanModel, ScansModel
from xei_lang.profiles.schema.values import Model
from xei_lang.profiles.yaml_reader import read_yaml
from xei_lang.world.frames import frame_tree, start_state
from xei_lang.world.map.footprint import fixed_links
from xei_lang.world.map.grid import yaw_of
from xei_lang.world.transforms import lookup

Array = NDArray[np.float64]
M = TypeVar("M", bound=Model)

CODE = "XEI0667"
MAX_FAULTS = 20
MAX_POSITION_M = 10_000.0
LEVEL_RAD = math.radians(3.0)


@dataclass(frozen=True, slots=True, eq=False)
class Scans:
    """What a map is built from: `poses` (n, 3) of the lidar in the map's frame (x, y, yaw; m, rad), the
    directions of its rays about that yaw (k,), and `ranges_m` (n, k), NaN where there is nothing to tell.
    """

    recorded_on: str
    lidar: str
    poses: Array
    angles_rad: Array
    ranges_m: Array


def read_scans(source: Source, profile: Profile) -> tuple[Scans | None, Diagnostics]:
    """The scans of a recording; None, with what is wrong with it, of which the first twenty are told."""
    found: list[Diagnostic] = []
    lines = list(_lines(source))
    if not lines:
        return None, (Diagnostic(CODE, f"`{source.file}` is empty"),)
    head = _parsed(source, *lines[0], ScansModel, found)
    scans: list[ScanModel] = []
    for start, text in lines[1:]:
        scan = _parsed(source, start, text, ScanModel, found) if head else None
        if scan is not None and not _is_odd(source, scan, scans, start, text, found):
            scans.append(scan)
        if len(found) >= MAX_FAULTS:
            break
    if head is None or found:
        return None, tuple(found)
    mounted = _mounted(head, profile, lambda key: _place(source, *lines[0], key))
    if isinstance(mounted, Diagnostic):
        return None, (mounted,)
    if not scans:
        end = Span(source.file, len(source.text), len(source.text))
        return None, (Diagnostic(CODE, f"`{source.file}` has no scan", end, "a line a scan is missing"),)
    return _scans(head, scans, mounted), ()


def _scans(head: ScansModel, scans: list[ScanModel], T_base_lidar: Pose) -> Scans:
    base = np.array([scan.base for scan in scans])
    ranges = np.array([scan.ranges_m for scan in scans], dtype=np.float64)
    ranges[(ranges < head.range_min_m) | (ranges > head.range_max_m)] = np.nan
    steps = np.arange(ranges.shape[1], dtype=np.float64)
    angles: Array = head.angle_min_rad + head.angle_increment_rad * steps
    return scans_at(head.recorded_on, head.lidar, base, T_base_lidar, angles, ranges)


def scans_at(
    recorded_on: str, lidar: str, base: Array, T_base_lidar: Pose, angles_rad: Array, ranges_m: Array
) -> Scans:
    """Scans of a lidar on the base, which stood at `base` (n, 3): x, y, yaw in the map's frame, m and rad."""
    dx, dy, _ = T_base_lidar.position_m
    x, y, yaw = base.T
    c, s = np.cos(yaw), np.sin(yaw)
    poses = np.stack([x + c * dx - s * dy, y + s * dx + c * dy, yaw + yaw_of(T_base_lidar)], axis=1)
    return Scans(recorded_on, lidar, poses, angles_rad, ranges_m)


def _lines(source: Source) -> Iterator[tuple[int, str]]:
    """Each line that is not blank, with where it begins."""
    start = 0
    for line in source.text.split("\n"):
        if line.strip():
            yield start, line
        start += len(line) + 1


def _parsed(source: Source, start: int, text: str, model: type[M], found: list[Diagnostic]) -> M | None:
    """The value of a line; what is wrong with it goes to `found`."""
    try:
        return model.model_validate_json(text)
    except ValidationError as error:
        root, faults = read_yaml(source.file, text)
        if error.errors(include_url=False)[0]["type"] == "json_invalid" or root is None or faults:
            span = Span(source.file, start, start + 1)
            number = source.line_number(start)
            help_ = "each line is an object of its own; JSON has no NaN: write null where no echo came back"
            found.append(Diagnostic(CODE, f"line {number} is no JSON object", span, help=(help_,)))
        else:
            found += [_moved(fault, start) for fault in explain(error, root, model)]
    return None


def _moved(fault: Diagnostic, start: int) -> Diagnostic:
    """A fault of a line, under the code of recordings and at its place in the file."""
    span = fault.span
    at = None if span is None else replace(span, start=span.start + start, end=span.end + start)
    return Diagnostic(CODE, fault.message, at, fault.label, (), fault.notes, fault.help)


def _is_odd(
    source: Source, scan: ScanModel, before: list[ScanModel], start: int, text: str, found: list[Diagnostic]
) -> bool:
    """Whether a scan cannot belong to those before it; says why."""
    number, key = source.line_number(start), "base"
    last = before[-1] if before else scan
    message, help_ = "", ""
    if len(scan.ranges_m) != len(last.ranges_m):
        message = f"the scan of line {number} has {len(scan.ranges_m)} ranges, not {len(last.ranges_m)}"
        key = "ranges_m"
    elif scan.stamp_s < last.stamp_s:
        key = "stamp_s"
        message = f"the scan of line {number} was taken before the one above it"
        help_ = "sort the scans by their stamps, and record one drive in a file"
    elif abs(scan.base[2]) > math.tau:
        message = f"the scan of line {number} has a yaw of {scan.base[2]:g}, which is more than a turn"
        help_ = f"write {math.radians(scan.base[2]):.6g}, if {scan.base[2]:g} deg was meant"
    elif max(abs(scan.base[0]), abs(scan.base[1])) > MAX_POSITION_M:
        message = f"the scan of line {number} was taken more than 10 km away from the map's frame"
        help_ = "positions are in metres"
    if message:
        place = _place(source, start, text, key)
        found.append(Diagnostic(CODE, message, place, help=(help_,) if help_ else ()))
    return bool(message)


def _place(source: Source, start: int, text: str, key: str) -> Span:
    """The key of a line, in its file."""
    root, _ = read_yaml(source.file, text)
    span = root.key_span(key) if root else Span(source.file, 0, 1)
    return replace(span, start=span.start + start, end=span.end + start)


def _mounted(head: ScansModel, profile: Profile, place: Callable[[str], Span]) -> Pose | Diagnostic:
    """The lidar's pose on the base, or why its scans are none of the floor plan."""
    if head.range_min_m >= head.range_max_m:
        return Diagnostic(CODE, "the rays of the recording have no range", place("range_min_m"))
    if head.angle_increment_rad == 0.0:
        return Diagnostic(CODE, "the rays of the recording have one direction", place("angle_increment_rad"))
    lidars = profile.calibration.lidars
    lidar = next((one for one in lidars if one.name == head.lidar), None)
    if lidar is None:
        near = did_you_mean(head.lidar, [one.name for one in lidars])
        known = ", ".join(f"`{one.name}`" for one in lidars) or "none"
        help_ = f"did you mean `{near[0]}`?" if near else f"the lidars of the profile are: {known}"
        return Diagnostic(CODE, f"the profile has no lidar `{head.lidar}`", place("lidar"), help=(help_,))
    return mounted_lidar(profile, lidar)


def mounted_lidar(profile: Profile, lidar: Lidar) -> Pose | Diagnostic:
    """The lidar's pose in `robot_base`, or why its scans are none of the floor plan."""
    T_base_lidar = _on_base(profile, lidar)
    if T_base_lidar is None:
        message = f"`{lidar.frame}`, the frame of the lidar `{lidar.name}`, is not fixed to the base"
        return Diagnostic(CODE, message, lidar.span, help=("hang it on `robot_base`",))
    tilt = math.acos(max(-1.0, min(1.0, T_base_lidar.axes()[2][2])))
    if tilt > LEVEL_RAD:
        message = (
            f"the lidar `{lidar.name}` is tilted by {math.degrees(tilt):.0f} deg: its scans are no floor plan"
        )
        return Diagnostic(CODE, message, lidar.span, help=("a map needs one that is level, its z axis up",))
    return T_base_lidar


def _on_base(profile: Profile, lidar: Lidar) -> Pose | None:
    """The lidar's pose in `robot_base`; None where something that moves lies between, or nothing holds it."""
    state = start_state(profile)
    way = lookup(World(frame_tree(profile, state), (), state), "robot_base", lidar.frame)
    links = dict(profile.calibration.robot_frames)
    fixed = fixed_links(profile.robot, links.get("robot_base", profile.robot.root))
    carried = all(name not in links or links[name] in fixed for name in way.path)
    return way.T_target_source if carried and "world" not in way.path else None
